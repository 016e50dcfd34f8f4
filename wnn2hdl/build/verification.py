"""Checking a build again, from its files alone."""

from pathlib import Path
from typing import Any

from wnn2hdl.build.checking import Checked, check
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import Files, render
from wnn2hdl.build.folder import REPORT_FILE, failure, require_build
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import ModelFileError, ToolError
from wnn2hdl.files import read_json
from wnn2hdl.progress import Progress
from wnn2hdl.report import check_report


def open_build(folder: Path) -> tuple[Design, Files, dict[str, Any]]:
    """A build's design, files and report.

    Raises:
        InputError: the folder is no build.
        ModelFileError: one of its files is missing or damaged.
    """
    require_build(folder)
    design = Design.load(folder)
    path = folder / REPORT_FILE
    report = read_json(path, "a report")
    check_report(report, path)
    return design, Files.of(design, folder), report


def verify_build(folder: Path, progress: Progress) -> tuple[list[str], Checked | None]:
    """Hashes, simulation, proof and count of a build, all done again.

    Args:
        folder: the build folder.
        progress: told of every stage.

    Returns:
        What is wrong, one line each, empty if nothing is; and what the checks found, None where files are
        missing, or changed so that nothing can be checked.

    Raises:
        InputError: the folder is no build.
        ToolError: an outside program is missing or failed.
    """
    require_build(folder)
    progress("checking hashes", 0, 1)
    problems = check_manifest(folder)
    progress("checking hashes", 1, 1)
    if any("missing" in problem for problem in problems):
        return problems, None
    try:
        design, files, report = open_build(folder)
    except ModelFileError as error:
        return [*problems, error.line()], None
    reason = failure(folder)
    if reason is not None:
        problems.append(f"the build is marked as failed: {reason}")
    problems += _foreign_text(design, report, folder)
    if report["hashes"].get("model") != design.model.digest():
        problems.append(f"{REPORT_FILE} belongs to a build of another model")
    try:
        checked = check(design, files, progress, afresh=True)
    except ToolError as error:
        if not problems:
            raise
        # A changed file may well be one that no tool can read.
        return [*problems, error.line()], None
    if checked.failure is not None:
        problems.append(checked.failure)
    for part, result in checked.syntheses.items():
        stated = report["parts"].get(part, {}).get("luts")
        if stated != result.resources.luts:
            problems.append(
                f"{REPORT_FILE} says that {part} takes {stated} LUTs; it takes {result.resources.luts}"
            )
    return problems, checked


def _foreign_text(design: Design, report: dict[str, Any], folder: Path) -> list[str]:
    """Emitted files that are not what the compiler writes for this design, one line each.

    The proof reads a text as Yosys reads it; simulators and other synthesisers may read another circuit in
    the same text, by macros, pragmas, delays and the like. So the text has to be the compiler's own, byte for
    byte.
    """
    problems = []
    threshold = report["options"]["sobel_threshold"]
    for name, wanted in render(design, sobel_threshold=threshold).items():
        found = (folder / name).read_text(encoding="utf-8", errors="replace").splitlines()
        lines = wanted.splitlines()
        if found != lines:
            place = next(
                (i for i, (x, y) in enumerate(zip(found, lines, strict=False)) if x != y),
                min(len(found), len(lines)),
            )
            line = found[place].strip()[:80] if place < len(found) else "the end of the file"
            problems.append(f"{name} is not what the compiler writes, from line {place + 1}: {line}")
    return problems
