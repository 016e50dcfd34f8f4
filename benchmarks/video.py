"""Video cores that send edges, beside Sobel's: what they take, and how fast they are simulated.

python benchmarks/video.py model.json
python benchmarks/video.py model.json --megapixels

Paths are those of Yosys's `sta` with an allowance for each wire, which is added to the delay of the LUT,
register, memory or carry chain that drives it; the wires inside a carry chain and from a LUT to the
multiplexer beside it are free.
"""

import argparse
import re
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pyosys

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.playback import play
from wnn2hdl.files import read_text
from wnn2hdl.images import write_png
from wnn2hdl.ir.models import AnyModel, load_model
from wnn2hdl.markdown import head, row
from wnn2hdl.samples import landscape
from wnn2hdl.synth import synthesise
from wnn2hdl.tools import find_yosys

WIRE = 300
"""Picoseconds for each wire, as `wnn2hdl.schedule` has it."""

WIDTHS = (640, 1920, 4096)
PIXELS_PER_CLOCK = (1, 2, 4)
CLOCK = 297.0

_DRIVERS = re.compile(r"LUT\d|FD\w+|RAMB\w+|CARRY4")
_ARC = re.compile(r"(=\s*\(?)(\d+)(\)?\s*;)")


def cells(wire: int) -> str:
    """Yosys's library of 7-series cells with the allowance in the delays of what drives wires."""
    (library,) = (Path(str(pyosys.__file__)).parent).rglob("xilinx/cells_sim.v")
    lines, module = [], ""
    for line in read_text(library, "cells").splitlines():
        if found := re.match(r"\s*module (\w+)", line):
            module = found[1]
        inside = module == "CARRY4" and re.search(r">\s*\(?CO", line)
        if re.search(r"[=*]>", line) and _DRIVERS.fullmatch(module) and not inside:
            line = _ARC.sub(lambda arc: f"{arc[1]}{int(arc[2]) + wire}{arc[3]}", line)
        lines.append(line)
    return "\n".join(lines)


def longest_path(netlist: str, top: str, wire: int) -> int:
    """The longest path of a mapped netlist with an allowance for each wire, in picoseconds."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cells.v").write_text(cells(wire), encoding="utf-8")
        (folder / "netlist.v").write_text(netlist, encoding="utf-8")
        script = f"read_verilog -lib -specify cells.v\nread_verilog netlist.v\nhierarchy -top {top}\nsta\n"
        log = find_yosys().run(script, cwd=folder, timeout=300)
    latest = re.search(r"^Latest arrival time in '.*' is (\d+):", log, re.MULTILINE)
    assert latest is not None
    return int(latest[1])


def _silent(step: str, done: int, total: int) -> None:
    pass


def sizes(model: AnyModel, folder: Path) -> Iterator[tuple[object, ...]]:
    """For each width and rate what the core and Sobel's take, and their paths."""
    for width in WIDTHS:
        for per_clock in PIXELS_PER_CLOCK:
            options = CompileOptions(
                target="video", max_width=width, pixels_per_clock=per_clock, answer="edge", clock=CLOCK
            )
            build = compile_model(model, folder / "core", options, _silent)
            assert build.failure is None
            for name, file, top in (
                ("core", "core.v", "core_video"),
                ("Sobel", "sobel.v", "core_sobel_video"),
            ):
                found = synthesise(read_text(build.folder / file, "Verilog"), top, baseline=name == "Sobel")
                cost = found.resources
                yield (
                    width,
                    per_clock,
                    name,
                    cost.luts,
                    cost.ffs,
                    cost.srl,
                    cost.carry4,
                    cost.bram36,
                    cost.delay_ps,
                    longest_path(found.netlist_verilog, top, WIRE),
                )


def megapixels(model: AnyModel, folder: Path) -> Iterator[tuple[object, ...]]:
    """For each rate how many million pixels Verilator simulates in a second, with pauses on both sides."""
    picture = folder / "picture.png"
    write_png(picture, np.asarray(landscape(1024, 1024, 0).image))
    for per_clock in PIXELS_PER_CLOCK:
        options = CompileOptions(target="video", pixels_per_clock=per_clock)
        assert compile_model(model, folder / "core", options, _silent).failure is None
        result = play(folder / "core", picture, "verilator", _silent)
        yield per_clock, f"{result.windows / result.seconds / 1e6:.2f}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("model", type=Path)
    parser.add_argument("--megapixels", action="store_true")
    arguments = parser.parse_args()
    model = load_model(arguments.model)
    columns, rows = (
        (["pixels per clock", "megapixels per second"], partial(megapixels, model))
        if arguments.megapixels
        else (
            [
                "width",
                "pixels per clock",
                "",
                "LUTs",
                "FFs",
                "SRLs",
                "CARRY4",
                "RAMB36",
                "logic, ps",
                "with wires, ps",
            ],
            partial(sizes, model),
        )
    )
    print(head(columns))
    with tempfile.TemporaryDirectory() as name:
        for values in rows(Path(name)):
            print(row([str(value) for value in values]), flush=True)


if __name__ == "__main__":
    main()
