"""Which look-up tables share a LUT6_2."""

from collections.abc import Sequence
from graphlib import TopologicalSorter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Lut, LutNetwork, Mux, packing
from wnn2hdl.ir.packing import Gate, packed_luts, pairs


@st.composite
def circuits(draw: st.DrawFn) -> list[Gate]:
    """Cells that read inputs and cells before them."""
    gates: list[Gate] = []
    for place in range(draw(st.integers(0, 14))):
        known = [f"i{x}" for x in range(6)] + [f"o{x}" for x in range(place)]
        reads = draw(st.frozensets(st.sampled_from(known), min_size=1, max_size=6))
        gates.append(Gate(reads, (f"o{place}",), draw(st.integers(0, 4)) > 0))
    return gates


def lut(reads: str, drives: str) -> Gate:
    return Gate(frozenset(reads), (drives,), True)


def joined(gates: Sequence[Gate], found: Sequence[tuple[int, int]]) -> dict[int, set[int]]:
    """What each cell reads once pairs are one cell."""
    cell = {i: i for i in range(len(gates))} | {other: one for one, other in found}
    driver = {signal: cell[i] for i, gate in enumerate(gates) for signal in gate.drives}
    graph: dict[int, set[int]] = {}
    for i, gate in enumerate(gates):
        graph.setdefault(cell[i], set()).update(driver[x] for x in gate.reads if x in driver)
    return graph


@pytest.mark.parametrize("many", [packing._MANY, 0])
@given(circuits())
def test_pairs_fit_a_cell_and_close_no_loop(many: int, gates: list[Gate]) -> None:
    """Of few tables, which a graph is searched for, and of many, which pair within their level."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(packing, "_MANY", many)
        found = pairs(gates)
    members = [i for pair in found for i in pair]
    assert len(set(members)) == len(members)
    for one, other in found:
        assert gates[one].is_lut
        assert gates[other].is_lut
        assert len(gates[one].reads | gates[other].reads) <= 5
    graph = joined(gates, found)
    assert len(list(TopologicalSorter(graph).static_order())) == len(graph) == len(gates) - len(found)


def test_tables_of_five_shared_signals_share_a_cell() -> None:
    assert pairs([lut("abcde", "x"), lut("abcde", "y")]) == [(0, 1)]
    assert pairs([lut("abcde", "x"), lut("abcdf", "y")]) == []


def test_of_many_tables_those_of_one_level_are_paired(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "_MANY", 0)
    gates = [lut("ab", "x"), lut("xc", "y"), lut("abcd", "z"), lut("de", "w")]
    assert pairs(gates) == [(0, 2)]


def test_the_table_with_one_partner_chooses_first() -> None:
    gates = [lut("ab", "x"), lut("abc", "y"), lut("cdefg", "z"), lut("cd", "w")]
    assert pairs(gates) == [(0, 1), (2, 3)]


def test_a_table_and_one_that_reads_it_through_another_cell_stay_apart() -> None:
    assert pairs([lut("ab", "x"), Gate(frozenset("xcdefg"), ("y",), True), lut("yb", "z")]) == []


def test_tables_before_a_multiplexer_are_not_packed() -> None:
    cells = (Lut("t0", ("a", "b"), 6), Lut("t1", ("a", "b"), 8), Mux("m", "t0", "t1", "c"))
    assert packed_luts(LutNetwork(("a", "b", "c"), cells, (("o", "m"),))) == 2
    outputs = (("o", "t0"), ("p", "t1"))
    assert packed_luts(LutNetwork(("a", "b", "c"), cells[:2], outputs)) == 1
