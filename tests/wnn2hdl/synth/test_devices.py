"""Shares of the reference design's device."""

from wnn2hdl.synth import XC7Z020, count_cells, utilisation


def test_shares_are_percent_of_each_resource() -> None:
    cells = {"LUT6": 500, "SRL16E": 32, "FDRE": 1064, "RAMB18E1": 14, "DSP48E1": 11}
    shares = utilisation(count_cells(cells, delay_ps=None))
    assert shares.device == "xc7z020clg484"
    assert (shares.luts, shares.ffs, shares.bram36, shares.dsp) == (1.0, 1.0, 5.0, 5.0)


def test_a_full_device_is_100_percent() -> None:
    cells = {
        "LUT6": XC7Z020.luts,
        "FDRE": XC7Z020.ffs,
        "RAMB36E1": XC7Z020.bram36,
        "DSP48E1": XC7Z020.dsp,
    }
    shares = utilisation(count_cells(cells, delay_ps=None))
    assert (shares.luts, shares.ffs, shares.bram36, shares.dsp) == (100.0, 100.0, 100.0, 100.0)
