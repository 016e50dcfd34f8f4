import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import TruthTable
from wnn2hdl.minimise.draft import ONE, ZERO, Cell, Draft, composed, evaluate_cell, mux_pins, simplified

XOR = np.array([0, 1, 1, 0], dtype=np.uint8)
AND = np.array([0, 0, 0, 1], dtype=np.uint8)


def random_contents(width: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 2, 1 << width, dtype=np.uint8)


@given(
    fanins=st.lists(st.sampled_from([ZERO, ONE, 0, 1, 2]), min_size=1, max_size=5), seed=st.integers(0, 99)
)
def test_simplifying_keeps_the_function(fanins: list[int], seed: int) -> None:
    cell = Cell(tuple(fanins), random_contents(len(fanins), seed))
    codes = np.arange(8)
    values = {x: (codes >> x & 1).astype(np.uint8) for x in range(3)}
    values |= {ZERO: np.zeros(8, dtype=np.uint8), ONE: np.ones(8, dtype=np.uint8)}
    simple = simplified(cell)
    assert list(simple.fanins) == sorted(set(simple.fanins) - {ZERO, ONE})
    result = evaluate_cell(simple, values) if simple.fanins else np.repeat(simple.contents, 8)
    assert (result == evaluate_cell(cell, values)).all()


def test_wires_and_constants_are_no_cells() -> None:
    draft = Draft(2)
    assert draft.add((0, 1), np.array([0, 1, 0, 1], dtype=np.uint8)) == 0
    assert draft.add((0, 1), np.ones(4, dtype=np.uint8)) == ONE
    assert draft.cells == {}


def test_a_lut_is_absorbed_by_its_only_reader() -> None:
    draft = Draft(6)
    inner = draft.add((0, 1, 2), random_contents(3))
    draft.outputs = [draft.add((inner, 3, 4, 5), random_contents(4, 1))]
    bits = (np.arange(64) >> np.arange(6)[:, np.newaxis] & 1).astype(np.uint8)
    before = draft.evaluate(bits)[draft.outputs[0]]
    draft.sweep()
    assert len(draft.cells) == 1
    assert (draft.evaluate(bits)[draft.outputs[0]] == before).all()


def test_equal_cells_are_merged() -> None:
    draft = Draft(8)
    twins = [draft.add((0, 1), XOR) for _ in range(2)]
    draft.outputs = [draft.add((twin, 2, 3, 4, 5, 6 + x), random_contents(6)) for x, twin in enumerate(twins)]
    draft.sweep()
    assert len(draft.cells) == 3


def multiplexed(data: int) -> Draft:
    """A tree of multiplexers over random LUTs of the same six inputs, selected by further inputs."""
    draft = Draft(6 + data.bit_length() - 1)
    level = [draft.add(tuple(range(6)), random_contents(6, seed)) for seed in range(data)]
    select = 6
    while len(level) > 1:
        level = [draft.add_mux(level[x], level[x + 1], select) for x in range(0, len(level), 2)]
        select += 1
    draft.outputs = level
    return draft


@pytest.mark.parametrize(("data", "luts", "muxes"), [(2, 2, 1), (4, 4, 3), (8, 9, 6), (16, 17, 12)])
def test_multiplexers_of_two_levels_are_free(data: int, luts: int, muxes: int) -> None:
    draft = multiplexed(data)
    draft.sweep()
    assert draft.cost()[::2] == (luts, muxes)
    table = TruthTable.exact(
        tuple(f"x{i}" for i in range(draft.width)), ("y",), np.zeros((1 << draft.width, 1), dtype=bool)
    )
    network = draft.network(table.inputs, table.outputs)
    assert (len(network.luts), len(network.muxes)) == (luts, muxes)
    bits = (np.arange(1 << draft.width) >> np.arange(draft.width)[:, np.newaxis] & 1).astype(np.uint8)
    assert (
        network.evaluate(np.arange(1 << draft.width))[:, 0] == draft.evaluate(bits)[draft.outputs[0]]
    ).all()


def test_a_lut_feeds_one_dedicated_multiplexer_only() -> None:
    draft = Draft(9)
    shared, one, two = (draft.add(tuple(range(6)), random_contents(6, seed)) for seed in range(3))
    draft.outputs = [draft.add_mux(shared, one, 6), draft.add_mux(shared, two, 7)]
    assert len(draft.muxes()) == 1
    assert draft.cost()[0] == 4


def test_multiplexers_are_recognised_in_every_order_of_pins() -> None:
    draft = Draft(3)
    for low, high, select in [(0, 1, 2), (1, 0, 2), (0, 2, 1), (2, 0, 1), (1, 2, 0), (2, 1, 0)]:
        assert mux_pins(draft.cells[draft.add_mux(low, high, select)]) == (low, high, select)
    assert mux_pins(Cell((0, 1, 2), random_contents(3))) is None


def test_six_inputs_are_the_limit_of_composition() -> None:
    reader = Cell((0, 1, 9), random_contents(3))
    assert composed(reader, 9, Cell((2, 3, 4, 5), random_contents(4, 1)), 6) is not None
    assert composed(reader, 9, Cell((2, 3, 4, 5, 6), random_contents(5, 1)), 6) is None


def test_names_of_the_table_are_not_taken_by_cells() -> None:
    draft = Draft(2)
    draft.outputs = [draft.add((0, 1), AND)]
    table = TruthTable.exact(("t0", "b"), ("t1",), np.array([[False], [False], [False], [True]]))
    assert [lut.name for lut in draft.network(table.inputs, table.outputs).luts] == ["t2"]
