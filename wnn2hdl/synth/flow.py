"""Synthesis of one or several designs with `synth_xilinx`."""

import json
import re
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.synth import cache
from wnn2hdl.synth.resources import Resources, count_cells
from wnn2hdl.tools import find_yosys, in_parallel

OPTIONS = "synth_xilinx -family xc7 -flatten -noiopad"
"""The one way in which everything is counted.

Exactly its passes run, in its order, except those that can change nothing: reading library cells that are
never counted, mapping the memories of a design without any, and the checks at the end. The count is that of
the whole command, which takes five times as long for a small design.
"""

_TIMEOUT = 1800.0

_MEMORIES = "memories.txt"

# A design with memories ends this script; `_MAP_ALL` is run on it instead.
_MAP_LOGIC = f"""\
{OPTIONS} -run prepare:map_memory
tee -q -o {_MEMORIES} select -list t:$mem*
select -assert-none t:$mem*
{OPTIONS} -run map_ffram:check
"""

_MAP_ALL = f"{OPTIONS} -run prepare:check\n"

# Modules that keep their hierarchy are dissolved once they are mapped: `sta` looks into one module only.
# synth_xilinx takes the timing arcs of CARRY4 and of flip-flops away, and `sta` then reports a path that ends
# before the carry chain (measured, Yosys 0.70), so the mapped module joins a fresh copy of the cells. There
# are no timing arcs for a LUT6_2, which is two tables.
_SCRIPT = """\
read_verilog -lib -specify +/xilinx/cells_sim.v
design -save cells
read_verilog design.v
hierarchy -check -top {top}
{mapping}\
tee -q -o stat.json stat -json
setattr -mod -unset keep_hierarchy *
flatten
write_verilog -noattr netlist.v
techmap -map pair.v
design -stash mapped
design -load cells
design -copy-from mapped -as {top} {top}
sta
"""

_PAIR = """\
module LUT6_2 #(parameter [63:0] INIT = 0) (output O6, O5, input I0, I1, I2, I3, I4, I5);
LUT6 #(.INIT(INIT)) upper (.O(O6), .I0(I0), .I1(I1), .I2(I2), .I3(I3), .I4(I4), .I5(I5));
LUT5 #(.INIT(INIT[31:0])) lower (.O(O5), .I0(I0), .I1(I1), .I2(I2), .I3(I3), .I4(I4));
endmodule
"""

_FLOW = cache.digest(_SCRIPT + _MAP_LOGIC + _MAP_ALL + _PAIR)


@dataclass(frozen=True)
class Job:
    """A design to synthesise.

    Attributes:
        verilog: its source, Verilog-2005, complete.
        top: the name of its top module.
        baseline: count it as a baseline: leftover inverters are free.
    """

    verilog: str
    top: str
    baseline: bool = False


@dataclass(frozen=True)
class Synthesis:
    """A synthesised design.

    Attributes:
        resources: what it costs.
        netlist_verilog: the mapped netlist: 7-series cells under the top module's name and ports.
        tool: which Yosys: ``pyosys``.
        version: its version.
        options: the command whose passes were run (see `OPTIONS`), without the name of the top module.
        seconds: how long it took when it was made, wall clock.
    """

    resources: Resources
    netlist_verilog: str
    tool: str
    version: str
    options: str
    seconds: float


def synthesise(verilog: str, top: str, *, baseline: bool = False) -> Synthesis:
    """Map a design to 7-series cells with Yosys, count them and find the longest path.

    The result is kept in a cache on disk: the same design, Yosys and options give it again at once.

    Args:
        verilog: the source, Verilog-2005, complete.
        top: the name of the top module.
        baseline: count leftover inverters as free.

    Raises:
        InputError: `top` is not a Verilog identifier.
        ToolError: there is no Yosys, or it fails: its ``ERROR:`` line is the value.
        CheckError: the netlist has a cell that the count does not know.
    """
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_$]*", top):
        raise InputError("not a name of a Verilog module", value=repr(top))
    yosys = find_yosys()
    key = {
        "verilog": cache.digest(verilog),
        "top": top,
        "flow": _FLOW,
        "tool": yosys.name,
        "version": yosys.version,
    }
    kept = cache.load("synth", key)
    mapped = _Mapped.read(kept) if kept is not None else None
    if mapped is None:
        mapped = _map(verilog, top)
        cache.store("synth", key, asdict(mapped))
    return Synthesis(
        resources=count_cells(mapped.cells, delay_ps=mapped.delay_ps, baseline=baseline),
        netlist_verilog=mapped.netlist,
        tool=yosys.name,
        version=yosys.version,
        options=OPTIONS,
        seconds=mapped.seconds,
    )


def synthesise_all(
    jobs: Mapping[str, Job], *, done: Callable[[str], None] | None = None
) -> dict[str, Synthesis]:
    """Synthesise several designs at once, on all cores.

    Args:
        jobs: designs by name.
        done: called with the name of each design as it gets done.

    Returns:
        The results by name, in the order of `jobs`.

    Raises:
        Wnn2hdlError: as `synthesise`, for the first design that fails; the others are stopped.
    """
    find_yosys()
    names = list(jobs)
    results: dict[str, Synthesis] = {}
    for position, result in in_parallel(synthesise_job, jobs.values()):
        results[names[position]] = result
        if done is not None:
            done(names[position])
    return {name: results[name] for name in names}


def synthesise_job(job: Job) -> Synthesis:
    """`synthesise` for a job."""
    return synthesise(job.verilog, job.top, baseline=job.baseline)


@dataclass(frozen=True)
class _Mapped:
    """What one run of Yosys finds out: cells by type, delay in picoseconds, netlist, wall-clock seconds."""

    cells: dict[str, int]
    delay_ps: int | None
    netlist: str
    seconds: float

    @classmethod
    def read(cls, kept: Mapping[str, Any]) -> "_Mapped | None":
        """What the cache holds; None where another version of this program wrote something else."""
        match kept:
            case {
                "cells": dict(cells),
                "delay_ps": int() | None as delay_ps,
                "netlist": str(netlist),
                "seconds": float(seconds),
            } if all(isinstance(number, int) for number in cells.values()):
                return cls(cells, delay_ps, netlist, seconds)
        return None


def _map(verilog: str, top: str) -> _Mapped:
    started = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-synth-") as name:
        folder = Path(name)
        (folder / "design.v").write_text(verilog, encoding="utf-8")
        (folder / "pair.v").write_text(_PAIR, encoding="utf-8")
        log = _run(folder, top)
        try:
            statistics = json.loads((folder / "stat.json").read_text(encoding="utf-8"))
            # Modules that keep their hierarchy are listed beside the cells inside them, which are counted.
            modules = {name.removeprefix("\\") for name in statistics["modules"]}
            totals = statistics["design"]["num_cells_by_type"]
            cells = {str(cell): int(n) for cell, n in totals.items() if cell not in modules}
            netlist = (folder / "netlist.v").read_text(encoding="utf-8")
        except (OSError, ValueError, LookupError, AttributeError) as error:
            raise ToolError("Yosys wrote no statistics that can be read", value=error, output=log) from error
    return _Mapped(cells, _delay_ps(log), netlist, time.perf_counter() - started)


def _run(folder: Path, top: str) -> str:
    """Map ``design.v`` in a folder by the shortest script that will do; return the log."""
    yosys = find_yosys()
    memories = folder / _MEMORIES
    try:
        return yosys.run(_SCRIPT.format(top=top, mapping=_MAP_LOGIC), cwd=folder, timeout=_TIMEOUT)
    except ToolError:
        if not memories.is_file() or not memories.read_text(encoding="utf-8").strip():
            raise
    return yosys.run(_SCRIPT.format(top=top, mapping=_MAP_ALL), cwd=folder, timeout=_TIMEOUT)


def _delay_ps(log: str) -> int | None:
    """The arrival time that `sta` reports; None when it found no path or does not know a cell's delay."""
    latest = re.search(r"^Latest arrival time in '.*' is (\d+):", log, re.MULTILINE)
    if latest is None or "has no timing arcs!" in log:
        return None
    return int(latest.group(1))
