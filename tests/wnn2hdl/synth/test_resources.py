"""The counting rule, cell by cell."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import CheckError
from wnn2hdl.synth import Resources, count_cells

NOTHING = Resources(luts=0, inv=0, muxf7=0, muxf8=0, carry4=0, srl=0, ffs=0, bram36=0.0, dsp=0, delay_ps=None)


def test_no_cells_cost_nothing_and_a_missing_delay_stays_missing() -> None:
    assert count_cells({}, delay_ps=None) == NOTHING


def test_every_kind_is_counted_on_its_own_line() -> None:
    cells = {
        "LUT1": 1, "LUT2": 2, "LUT3": 3, "LUT4": 4, "LUT5": 5, "LUT6": 6, "LUT6_2": 7,
        "MUXF7": 8, "MUXF8": 9, "CARRY4": 10, "SRL16E": 11, "SRLC32E": 12,
        "FDRE": 13, "FDSE_1": 14, "FDCE": 15, "FDPE": 16, "LDCE": 17, "DSP48E1": 18,
    }  # fmt: skip
    assert count_cells(cells, delay_ps=645) == Resources(
        luts=28, inv=0, muxf7=8, muxf8=9, carry4=10, srl=23, ffs=75, bram36=0.0, dsp=18, delay_ps=645
    )


def test_a_leftover_inverter_is_a_lut_except_in_a_baseline() -> None:
    cells = {"LUT6": 10, "INV": 3}
    ours = count_cells(cells, delay_ps=None)
    baseline = count_cells(cells, delay_ps=None, baseline=True)
    assert (ours.luts, ours.inv) == (13, 3)
    assert (baseline.luts, baseline.inv) == (10, 3)


def test_memories_in_luts_are_luts() -> None:
    assert count_cells({"RAM32M": 2, "RAM64X1D": 3, "LUT6": 1}, delay_ps=None).luts == 15


def test_a_block_ram_of_18_kb_is_half_of_one() -> None:
    assert count_cells({"RAMB36E1": 1, "RAMB18E1": 3}, delay_ps=None).bram36 == 2.5


def test_marks_and_clock_buffers_cost_nothing() -> None:
    assert count_cells({"$scopeinfo": 10, "BUFG": 1}, delay_ps=None) == NOTHING


@pytest.mark.parametrize("cell", ["RAM256X1S", "$lut", "$_AND_", "MUXF9", "my_black_box"])
def test_nothing_escapes_the_count(cell: str) -> None:
    with pytest.raises(CheckError, match=r"cells that the count does not know: 2 "):
        count_cells({"LUT6": 1, cell: 2}, delay_ps=None)


@given(st.dictionaries(st.sampled_from([f"LUT{n}" for n in range(1, 7)] + ["LUT6_2"]), st.integers(0, 10**6)))
def test_luts_are_the_sum_of_the_lut_cells(cells: dict[str, int]) -> None:
    assert count_cells(cells, delay_ps=None).luts == sum(cells.values())
