"""Reports in the formats of several versions of Vivado."""

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.synth.vivado_reports import VivadoFigures, read_reports

UTILISATION_2014 = """\
Copyright 1986-2014 Xilinx, Inc. All Rights Reserved.
-------------------------------------------------------------------------------
| Tool Version : Vivado v.2014.4 (lin64) Build 1071353 Tue Nov 18 16:47:07 MST 2014
| Date         : Mon Jul 20 18:25:50 2015
| Command      : report_utilization -file utilization.rpt
| Design       : mine_registers
| Device       : xc7z020
| Design State : Routed
-------------------------------------------------------------------------------

Utilization Design Information

1. Slice Logic
--------------

+----------------------------+------+-------+-----------+-------+
|          Site Type         | Used | Fixed | Available | Util% |
+----------------------------+------+-------+-----------+-------+
| Slice LUTs                 |   19 |     0 |     53200 |  0.03 |
|   LUT as Logic             |   19 |     0 |     53200 |  0.03 |
|   LUT as Memory            |    0 |     0 |     17400 |  0.00 |
| Slice Registers            |  218 |     0 |    106400 |  0.20 |
|   Register as Flip Flop    |  218 |     0 |    106400 |  0.20 |
|   Register as Latch        |    0 |     0 |    106400 |  0.00 |
| F7 Muxes                   |    0 |     0 |     26600 |  0.00 |
| F8 Muxes                   |    0 |     0 |     13300 |  0.00 |
+----------------------------+------+-------+-----------+-------+

3. Memory
---------

+----------------+------+-------+-----------+-------+
|    Site Type   | Used | Fixed | Available | Util% |
+----------------+------+-------+-----------+-------+
| Block RAM Tile |    0 |     0 |       140 |  0.00 |
|   RAMB36/FIFO* |    0 |     0 |       140 |  0.00 |
|   RAMB18       |    0 |     0 |       280 |  0.00 |
+----------------+------+-------+-----------+-------+
* Note: Each Block RAM Tile only has one FIFO logic available

4. DSP
------

+-----------+------+-------+-----------+-------+
| Site Type | Used | Fixed | Available | Util% |
+-----------+------+-------+-----------+-------+
| DSPs      |    0 |     0 |       220 |  0.00 |
+-----------+------+-------+-----------+-------+
"""

UTILISATION_2023 = """\
Copyright 1986-2022 Xilinx, Inc. All Rights Reserved.
-----------------------------------------------------------------------------------
| Tool Version : Vivado v.2023.1 (win64) Build 3865809 Sun May  7 15:05:29 MDT 2023
| Date         : Wed Oct  2 12:35:08 2024
| Command      : report_utilization -file utilization.rpt
| Design       : mine_video
| Device       : xc7z020clg484-1
| Speed File   : -1
| Design State : Routed
-----------------------------------------------------------------------------------

1. Slice Logic
--------------

+-------------------------+------+-------+------------+-----------+-------+
|        Site Type        | Used | Fixed | Prohibited | Available | Util% |
+-------------------------+------+-------+------------+-----------+-------+
| Slice LUTs*             |   61 |     0 |          0 |     53200 |  0.11 |
|   LUT as Logic          |   60 |     0 |          0 |     53200 |  0.11 |
|   LUT as Memory         |    1 |     0 |          0 |     17400 | <0.01 |
|     LUT as Shift Register |  1 |     0 |            |           |       |
| Slice Registers         |   68 |     0 |          0 |    106400 |  0.06 |
| F7 Muxes                |    0 |     0 |          0 |     26600 |  0.00 |
+-------------------------+------+-------+------------+-----------+-------+
* Warning! LUT value is adjusted to account for LUT combining.

2. Memory
---------

+-------------------+------+-------+------------+-----------+-------+
|     Site Type     | Used | Fixed | Prohibited | Available | Util% |
+-------------------+------+-------+------------+-----------+-------+
| Block RAM Tile    |  0.5 |     0 |          0 |       140 |  0.36 |
|   RAMB36/FIFO*    |    0 |     0 |          0 |       140 |  0.00 |
|   RAMB18          |    1 |     0 |          0 |       280 |  0.36 |
|     RAMB18E1 only |    1 |       |            |           |       |
+-------------------+------+-------+------------+-----------+-------+

3. DSP
------

+-----------+------+-------+------------+-----------+-------+
| Site Type | Used | Fixed | Prohibited | Available | Util% |
+-----------+------+-------+------------+-----------+-------+
| DSPs      |    2 |     0 |          0 |       220 |  0.91 |
+-----------+------+-------+------------+-----------+-------+
"""

TIMING = """\
| Tool Version      : Vivado v.2023.1 (win64) Build 3865809 Sun May  7 15:05:29 MDT 2023
| Command           : report_timing_summary -delay_type min_max -file timing.rpt

------------------------------------------------------------------------------------------------
| Design Timing Summary
| ---------------------
------------------------------------------------------------------------------------------------

    WNS(ns)      TNS(ns)  TNS Failing Endpoints  TNS Total Endpoints      WHS(ns)      THS(ns)
    -------      -------  ---------------------  -------------------      -------      -------
      2.500        0.000                      0                  723        0.022        0.000


All user specified timing constraints are met.


------------------------------------------------------------------------------------------------
| Clock Summary
| -------------
------------------------------------------------------------------------------------------------

Clock  Waveform(ns)         Period(ns)      Frequency(MHz)
-----  ------------         ----------      --------------
clk    {0.000 2.500}        5.000           200.000


------------------------------------------------------------------------------------------------
| Intra Clock Table
| -----------------
------------------------------------------------------------------------------------------------

Clock             WNS(ns)      TNS(ns)  TNS Failing Endpoints  TNS Total Endpoints
-----             -------      -------  ---------------------  -------------------
clk                 2.500        0.000                      0                  723
"""


def test_tables_of_2014_are_read() -> None:
    found = read_reports(UTILISATION_2014, TIMING)
    assert found == VivadoFigures("2014.4", "xc7z020", 19, 218, 0.0, 0, 5.0, 2.5)
    assert found.fmax_mhz == 400


def test_tables_with_prohibited_sites_and_adjusted_counts_are_read() -> None:
    missed = TIMING.replace(
        "      2.500        0.000                      0", "     -1.250       -9.000                     11"
    )
    found = read_reports(UTILISATION_2023, missed)
    assert found == VivadoFigures("2023.1", "xc7z020clg484-1", 61, 68, 0.5, 2, 5.0, -1.25)
    assert found.fmax_mhz == pytest.approx(160)


@pytest.mark.parametrize(
    ("utilisation", "timing", "fault"),
    [
        (UTILISATION_2023.replace("| Slice LUTs*", "| ALMs      *"), TIMING, "lacks a row: Slice LUTs"),
        (
            UTILISATION_2023,
            TIMING.replace("2.500        0.000", "   NA           NA"),
            "no number for the worst slack: NA",
        ),
        (UTILISATION_2023, "", "does not have a clock"),
        ("", TIMING, "lacks a row"),
    ],
)
def test_what_is_missing_is_named(utilisation: str, timing: str, fault: str) -> None:
    with pytest.raises(ToolError, match=fault):
        read_reports(utilisation, timing)
