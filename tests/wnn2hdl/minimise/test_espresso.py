import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyeda.boolalg.espresso import get_config, set_config

from wnn2hdl.errors import CheckError
from wnn2hdl.ir import Cube, TruthTable
from wnn2hdl.minimise import espresso as minimise


def names(letter: str, count: int) -> tuple[str, ...]:
    return tuple(f"{letter}{x}" for x in range(count))


def random_table(width: int, outputs: int, care: float, seed: int) -> TruthTable:
    rng = np.random.default_rng(seed)
    values = rng.random((1 << width, outputs)) < rng.random()
    return TruthTable(names("x", width), names("y", outputs), values, rng.random(1 << width) < care)


tables = st.builds(
    random_table,
    st.integers(1, 8),
    st.integers(1, 3),
    st.sampled_from([0.0, 0.1, 0.5, 1.0]),
    st.integers(0, 999),
)


@settings(max_examples=60, deadline=None)
@given(table=tables)
def test_covers_equal_their_table_on_every_cared_for_code(table: TruthTable) -> None:
    result = minimise(table)
    assert table.mismatches(result.cover.evaluate(np.arange(len(table.care)))).size == 0
    assert len(result.cover.cubes) <= result.cubes_before
    assert result.cover.literals <= result.literals_before


@settings(max_examples=40, deadline=None)
@given(table=tables)
def test_irredundant_covers_equal_their_table_too(table: TruthTable) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys.modules["wnn2hdl.minimise.espresso"], "MAX_CODES", -1)
        result = minimise(table)
    assert result.method == "irredundant"
    assert table.mismatches(result.cover.evaluate(np.arange(len(table.care)))).size == 0


def test_don_t_cares_shrink_the_cover() -> None:
    codes = np.arange(16)
    values = (np.bitwise_count(codes) % 2 == 1).reshape(-1, 1)
    exact = TruthTable.exact(names("x", 4), ("y",), values)
    result = minimise(exact)
    assert (result.cubes_before, result.literals_before, len(result.cover.cubes)) == (8, 32, 8)
    one_hot = exact.with_care(np.isin(codes, [0, 1, 2, 4, 8, 3]))
    assert len(minimise(one_hot).cover.cubes) < 8


@pytest.mark.parametrize(("value", "cubes"), [(False, ()), (True, (Cube(0, 0, 1),))])
@pytest.mark.parametrize("width", [1, 5])
def test_constants(value: bool, cubes: tuple[Cube, ...], width: int) -> None:
    table = TruthTable.exact(names("x", width), ("y",), np.full((1 << width, 1), value))
    assert minimise(table).cover.cubes == cubes


def test_the_same_table_gives_the_same_cover() -> None:
    for seed in range(10):
        table = random_table(8, 2, 0.5, seed)
        assert minimise(table) == minimise(table)


def test_the_library_s_options_are_neither_used_nor_changed() -> None:
    table = random_table(8, 2, 0.5, 0)
    cover = minimise(table).cover
    before = get_config()
    try:
        set_config(**{name: not value for name, value in before.items()})
        foreign = get_config()
        assert minimise(table).cover == cover
        assert get_config() == foreign
    finally:
        set_config(**before)


def test_threads_do_not_see_each_other_s_options() -> None:
    tables = [random_table(7, 2, 0.5, seed) for seed in range(8)]
    before = get_config()
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(minimise, tables)) == [minimise(table) for table in tables]
    assert get_config() == before


def test_a_wrong_cover_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["wnn2hdl.minimise.espresso"], "_espresso_cubes", lambda *_: [])
    table = TruthTable.exact(("a",), ("y",), np.array([[False], [True]]))
    with pytest.raises(CheckError, match="the espresso cover differs from its table"):
        minimise(table)
