"""The only door to outside programs: Yosys, ABC, the Verilog simulators, and place and route.

Each program is found, started with a time limit, and its output is scanned for errors even when it ends with
status 0. A failure is a `wnn2hdl.errors.ToolError` that carries the command and what it printed.
"""

from wnn2hdl.tools.abc import abc_version, find_abc, run_abc
from wnn2hdl.tools.placers import ECP5, GOWIN, ICE40, Placer
from wnn2hdl.tools.runner import Completed, cores, in_parallel, run
from wnn2hdl.tools.simulators import (
    Simulator,
    find_icarus,
    find_verilator,
    lint_icarus,
    lint_verilator,
    run_icarus,
    run_verilator,
)
from wnn2hdl.tools.yosys import Yosys, find_yosys

__all__ = [
    "ECP5",
    "GOWIN",
    "ICE40",
    "Completed",
    "Placer",
    "Simulator",
    "Yosys",
    "abc_version",
    "cores",
    "find_abc",
    "find_icarus",
    "find_verilator",
    "find_yosys",
    "in_parallel",
    "lint_icarus",
    "lint_verilator",
    "run",
    "run_abc",
    "run_icarus",
    "run_verilator",
]
