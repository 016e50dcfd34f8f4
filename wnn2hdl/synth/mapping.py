"""Mapping a design to the cells of a `Fabric` with Yosys, before it is placed."""

import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.synth import cache
from wnn2hdl.synth.fabrics import FREE, Fabric, Family
from wnn2hdl.tools import find_yosys

_TIMEOUT = 1800.0

# LUT cells of up to four inputs that stand in the design are turned into the family's own by way of modules
# that no synthesis knows, so that none restructures them; their names are those of 7-series cells, which
# differ in their pins. What the family has no such cell for becomes logic.
_LUT = """\
module LUT{inputs} #(parameter [{last}:0] INIT = 0) (output O, input {pins});
KEEP #(.INIT({{{copies}{{INIT}}}})) kept (.O(O), {connections});
endmodule
"""
_WIDER = """\
module LUT5 #(parameter [31:0] INIT = 0) (output O, input I0, I1, I2, I3, I4);
assign O = INIT[{I4, I3, I2, I1, I0}];
endmodule
module LUT6 #(parameter [63:0] INIT = 0) (output O, input I0, I1, I2, I3, I4, I5);
assign O = INIT[{I5, I4, I3, I2, I1, I0}];
endmodule
module MUXF7 (output O, input I0, I1, S);
assign O = S ? I1 : I0;
endmodule
module MUXF8 (output O, input I0, I1, S);
assign O = S ? I1 : I0;
endmodule
"""
_KEEP = """\
module KEEP #(parameter [15:0] INIT = 0) (output O, input I0, I1, I2, I3);
{lut_cell}
endmodule
"""

_SCRIPT = """\
read_verilog design.v
hierarchy -top {top}
techmap -map luts.v
techmap -map keep.v
{synthesis} -top {top}
setattr -mod -unset keep_hierarchy *
flatten -noscopeinfo
opt_clean -purge
tee -q -o stat.json stat -json
write_verilog -noattr netlist.v
"""

# The netlist again, in the logic that Yosys's models of the cells stand for.
_LOGIC = """\
read_verilog netlist.v
read_verilog -overwrite +/{models}
hierarchy -top {top}
proc
flatten -noscopeinfo
opt_expr
opt_clean -purge
write_verilog -noattr logic.v
"""


@dataclass(frozen=True)
class Cells:
    """What a netlist takes of a fabric.

    Attributes:
        luts: LUTs of four inputs, those of carry chains and of small memories among them.
        ffs: flip-flops.
        rams: block RAMs.
        muxes: dedicated multiplexers behind LUTs.
        carries: carry cells that stand beside a LUT instead of in its place.
    """

    luts: int = 0
    ffs: int = 0
    rams: int = 0
    muxes: int = 0
    carries: int = 0


@dataclass(frozen=True)
class Mapped:
    """A design in the cells of a fabric.

    Attributes:
        cells: what it takes.
        netlist: Verilog of its cells, under the top module's name and ports.
        logic: the same for a proof, Yosys's models in the place of cells; empty if there are block RAMs.
        command: of Yosys, that made it.
    """

    cells: Cells
    netlist: str
    logic: str
    command: str


def map_to(fabric: Fabric, verilog: str, top: str) -> Mapped:
    """Map a design to the fewest LUTs that one of the family's commands gives.

    The results are kept in the cache on disk.

    Args:
        fabric: the FPGA.
        verilog: the source, Verilog-2005, complete but for LUT and MUXF cells of the 7 series: a LUT of up to
            four inputs stays one.
        top: the name of the top module.

    Raises:
        ToolError: there is no Yosys, or it fails.
        CheckError: the netlist has a cell that the count does not know.
    """
    found = [_map(fabric, verilog, top, command) for command in fabric.family.synthesis]
    return min(found, key=lambda mapped: (mapped.cells.luts, mapped.cells.muxes))


def _map(fabric: Fabric, verilog: str, top: str, command: str) -> Mapped:
    yosys = find_yosys()
    script = _SCRIPT.format(top=top, synthesis=command)
    modelled = _LOGIC.format(top=top, models=fabric.family.models)
    maps = {"luts.v": _luts(), "keep.v": _KEEP.format(lut_cell=fabric.family.lut_cell)}
    key = {
        "verilog": cache.digest(verilog),
        "flow": cache.digest(script + modelled + "".join(maps.values())),
        "tool": yosys.name,
        "version": yosys.version,
    }
    kept = cache.load("map", key)
    found = kept if kept is not None and kept.keys() == {"cells", "netlist", "logic"} else None
    if found is None:
        with tempfile.TemporaryDirectory(prefix="wnn2hdl-map-") as name:
            folder = Path(name)
            for file, text in {"design.v": verilog, **maps}.items():
                (folder / file).write_text(text, encoding="utf-8")
            log = yosys.run(script, cwd=folder, timeout=_TIMEOUT)
            found = {
                "cells": _statistics(folder / "stat.json", log),
                "netlist": (folder / "netlist.v").read_text(encoding="utf-8"),
                "logic": "",
            }
            if not _counted(fabric.family, found["cells"]).rams:
                yosys.run(modelled, cwd=folder, timeout=_TIMEOUT)
                found["logic"] = (folder / "logic.v").read_text(encoding="utf-8")
        cache.store("map", key, found)
    return Mapped(
        _counted(fabric.family, found["cells"]), str(found["netlist"]), str(found["logic"]), command
    )


def _luts() -> str:
    texts = [_WIDER]
    for inputs in range(1, 5):
        pins = ", ".join(f"I{pin}" for pin in range(inputs))
        connections = ", ".join(f".I{pin}(I{pin})" if pin < inputs else f".I{pin}(1'b0)" for pin in range(4))
        texts.append(
            _LUT.format(
                inputs=inputs,
                last=(1 << inputs) - 1,
                pins=pins,
                copies=16 >> inputs,
                connections=connections,
            )
        )
    return "".join(texts)


def _statistics(path: Path, log: str) -> dict[str, int]:
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["design"]["num_cells_by_type"]
        return {str(cell): int(count) for cell, count in cells.items()}
    except (OSError, ValueError, LookupError, AttributeError) as error:
        raise ToolError("Yosys wrote no statistics that can be read", value=error, output=log) from error


def _counted(family: Family, cells: Mapping[str, Any]) -> Cells:
    totals: dict[str, int] = {}
    for cell, count in cells.items():
        if cell in FREE:
            continue
        if cell not in family.counted:
            raise CheckError("the netlist has a cell that is not counted", value=cell)
        kind, each = family.counted[cell]
        totals[kind] = totals.get(kind, 0) + count * each
    return Cells(**totals)
