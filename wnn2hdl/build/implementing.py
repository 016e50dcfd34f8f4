"""A build in Vivado: its scripts written, the out-of-context one run, its figures in the build's report."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import outermost_part, ports
from wnn2hdl.build.extending import add_to_report, require_outside, require_unchanged
from wnn2hdl.build.verification import open_build
from wnn2hdl.emit.vivado import IMPLEMENT, PART, TIMING, UTILISATION, circuit_scripts, core_scripts
from wnn2hdl.files import make_folder, read_text, write_text
from wnn2hdl.progress import Progress
from wnn2hdl.synth.harness import harness
from wnn2hdl.synth.vivado_reports import read_reports
from wnn2hdl.tools.vivado import find_vivado, run_vivado

_MEGAHERTZ, _VIDEO_MEGAHERTZ = 200.0, 148.5
"""The clocks that are asked for where a design names none; the second one is that of 1080p60."""


def write_vivado(folder: Path, output: Path) -> tuple[Path, ...]:
    """Write the scripts of a build with the Verilog that they read.

    Args:
        folder: the build.
        output: the folder for them, outside of the build.

    Returns:
        The files.

    Raises:
        InputError: the folder is not a build, or the output lies in it or cannot be written.
        CheckError: files of the build were changed.
    """
    design, files, _ = open_build(folder)
    require_unchanged(folder)
    require_outside(folder, output)
    texts = {files.verilog.name: read_text(files.verilog, "Verilog"), **_scripts(design)}
    make_folder(output)
    for name, text in texts.items():
        write_text(output / name, text)
    return tuple(output / name for name in texts)


def implement(folder: Path, output: Path, progress: Progress) -> dict[str, Any]:
    """Synthesise and implement a build in Vivado, out of context, and add the figures to its report.

    Args:
        folder: the build.
        output: the folder for scripts, reports and the checkpoint, outside of the build.
        progress: reports before and after.

    Returns:
        The figures.

    Raises:
        InputError: as `write_vivado`.
        CheckError: files of the build were changed.
        ToolError: Vivado is missing or failed, or its reports cannot be read.
    """
    find_vivado()
    write_vivado(folder, output)
    for name in (UTILISATION, TIMING):
        (output / name).unlink(missing_ok=True)
    progress("implementing in Vivado", 0, 1)
    run_vivado(output / IMPLEMENT)
    progress("implementing in Vivado", 1, 1)
    found = read_reports(
        *(read_text(output / name, "the report of Vivado") for name in (UTILISATION, TIMING))
    )
    figures = {**asdict(found), "fmax_mhz": found.fmax_mhz, "part": PART}
    add_to_report(folder, {"vivado": figures})
    return figures


def _scripts(design: Design) -> Mapping[str, str]:
    top, widths, source = design.outermost, ports(outermost_part(design)), f"{design.name}.v"
    megahertz = _MEGAHERTZ if design.stages is None else 1e6 / design.stages.period
    if design.registers is not None:
        megahertz = _VIDEO_MEGAHERTZ if design.video is not None else megahertz
        return core_scripts(top, widths, design.registers, source=source, megahertz=megahertz)
    name = f"{design.name}_registers"
    around = harness(name, top, widths, pins=widths.pins, registered=True)
    scripts = circuit_scripts(top, source=source, harness=name, megahertz=megahertz)
    return {f"{name}.v": around.verilog, **scripts}
