import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.ir import TruthTable
from wnn2hdl.minimise import map_luts, portfolio
from wnn2hdl.minimise.draft import ONE, Draft


def names(letter: str, count: int) -> tuple[str, ...]:
    return tuple(f"{letter}{x}" for x in range(count))


def random_table(width: int, outputs: int, care: float, seed: int) -> TruthTable:
    rng = np.random.default_rng(seed)
    values = rng.random((1 << width, outputs)) < 0.5
    return TruthTable(names("x", width), names("y", outputs), values, rng.random(1 << width) < care)


def is_right(table: TruthTable, network: object) -> bool:
    every = np.arange(len(table.care))
    return table.mismatches(network.evaluate(every)).size == 0  # type: ignore[attr-defined]


@settings(max_examples=60, deadline=None)
@given(
    width=st.integers(1, 9),
    outputs=st.integers(1, 3),
    care=st.sampled_from([0.0, 0.05, 0.2, 1.0]),
    seed=st.integers(0, 999),
)
def test_networks_equal_their_table_on_every_cared_for_code(
    width: int, outputs: int, care: float, seed: int
) -> None:
    table = random_table(width, outputs, care, seed)
    assert is_right(table, map_luts(table, effort=0).network)


@pytest.mark.parametrize("effort", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_more_effort_is_right_and_never_worse(effort: int) -> None:
    for seed in range(2):
        table = random_table(8, 1, 0.6, seed)
        mapping = map_luts(table, effort=effort)
        assert is_right(table, mapping.network)
        assert len(mapping.network.luts) <= len(map_luts(table, effort=effort - 1).network.luts)
        assert len(mapping.network.luts) == min(x.luts for x in mapping.candidates if x.luts is not None)


@pytest.mark.parametrize(
    ("width", "luts", "muxes"), [(6, 1, 0), (7, 2, 1), (8, 4, 3), (9, 9, 6), (10, 17, 12)]
)
def test_any_function_costs_no_more_than_its_multiplexer_tree(width: int, luts: int, muxes: int) -> None:
    network = map_luts(random_table(width, 1, 1.0, seed=7), effort=0).network
    assert (len(network.luts), len(network.muxes)) == (luts, muxes)


def test_a_cascade_of_two_luts_is_found() -> None:
    codes = np.arange(1 << 11)
    inner = np.bitwise_count(codes & 0b111111) >= 3
    outer = np.bitwise_count(codes >> 6) % 3 == 1
    table = TruthTable.exact(names("x", 11), ("y",), (inner ^ outer).reshape(-1, 1))
    assert len(map_luts(table, effort=0).network.luts) == 2


def test_two_luts_that_share_inputs_are_found() -> None:
    codes = np.arange(1 << 8)
    contents = np.random.default_rng(0).integers(0, 2, (2, 64))
    inner = contents[0][codes & 63]
    outer = contents[1][inner | (codes & 7) << 1 | codes >> 6 << 4]
    table = TruthTable.exact(names("x", 8), ("y",), (outer == 1).reshape(-1, 1))
    mapping = map_luts(table, effort=1)
    assert len(mapping.network.luts) == 2
    assert mapping.method == "lutexact"


def test_wires_and_constants_cost_nothing() -> None:
    codes = np.arange(32)
    values = np.stack([codes >> 3 & 1, codes >= 0, codes < 0], axis=1).astype(bool)
    mapping = map_luts(TruthTable.exact(names("x", 5), names("y", 3), values), effort=0)
    assert mapping.network.cells == ()
    assert mapping.network.outputs == (("y0", "x3"), ("y1", "1"), ("y2", "0"))


def test_outputs_share_luts_that_no_single_one_shows() -> None:
    count = np.bitwise_count(np.arange(512))
    values = (count[:, np.newaxis] >> np.arange(4) & 1).astype(bool)
    mapping = map_luts(TruthTable.exact(names("x", 9), names("y", 4), values), effort=1)
    assert len(mapping.network.luts) == 7
    assert mapping.method == "resubstitution"


def test_equal_outputs_share_their_luts() -> None:
    table = random_table(6, 1, 1.0, seed=1)
    double = TruthTable.exact(table.inputs, names("y", 2), np.repeat(table.values, 2, axis=1))
    assert len(map_luts(double, effort=0).network.luts) == 1


def test_wide_tables_fall_back_to_a_multiplexer_tree() -> None:
    table = random_table(14, 1, 1.0, seed=0)
    mapping = map_luts(table, effort=0)
    assert is_right(table, mapping.network)
    assert mapping.method == "multiplexer tree"
    assert len(mapping.network.luts) < (1 << 8) * 1.1


def test_a_wrong_candidate_never_wins(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*_: object) -> list[tuple[str, Draft]]:
        return [("wrong", Draft(7, outputs=[ONE]))]

    table = random_table(7, 1, 1.0, seed=2)
    monkeypatch.setattr(portfolio, "truth_candidates", wrong)
    monkeypatch.setattr(portfolio, "fewest_luts", lambda *_: 0)
    mapping = map_luts(table, effort=1)
    assert portfolio.Candidate("wrong", None) in mapping.candidates
    assert is_right(table, mapping.network)

    monkeypatch.setattr(portfolio, "_decomposed", wrong)
    monkeypatch.setattr(portfolio, "care_candidates", wrong)
    with pytest.raises(CheckError, match="no way of mapping gave a right network"):
        map_luts(table, effort=1)


def test_the_same_table_gives_the_same_network() -> None:
    table = random_table(9, 2, 0.3, seed=5)
    assert map_luts(table, effort=1).network == map_luts(table, effort=1).network


def test_progress_tells_each_improvement() -> None:
    reported: list[tuple[str, int]] = []
    mapping = map_luts(random_table(8, 1, 0.5, 0), effort=1, progress=lambda *x: reported.append(x))
    assert reported[-1] == (mapping.method, len(mapping.network.luts))


def test_an_unknown_effort_is_refused() -> None:
    with pytest.raises(InputError, match="no such effort: 4; give 0, 1, 2 or 3"):
        map_luts(random_table(3, 1, 1.0, 0), effort=4)


@pytest.mark.parametrize("care", [1.0, 0.3])
def test_luts_of_four_inputs(care: float) -> None:
    table = random_table(7, 2, care, seed=4)
    network = map_luts(table, lut_inputs=4).network
    assert is_right(table, network)
    assert max(len(lut.inputs) for lut in network.luts) == 4
    assert not network.muxes
    # For each output a tree of eight LUTs and seven that select is always enough.
    assert len(network.luts) <= 2 * 15
