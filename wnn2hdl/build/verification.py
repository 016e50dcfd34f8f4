"""Checking a build again, from its files alone."""

from pathlib import Path
from typing import Any

from wnn2hdl.build.checking import Checked, check
from wnn2hdl.build.circuits import Circuits, circuits_of
from wnn2hdl.build.design import Design
from wnn2hdl.build.folder import REPORT_FILE, failure, require_build
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import ModelFileError, ToolError
from wnn2hdl.files import read_json
from wnn2hdl.progress import Progress
from wnn2hdl.report import check_report


def open_build(folder: Path) -> tuple[Design, Circuits, dict[str, Any]]:
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
    return design, circuits_of(design, folder), report


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
        design, circuits, report = open_build(folder)
    except ModelFileError as error:
        return [*problems, error.line()], None
    reason = failure(folder)
    if reason is not None:
        problems.append(f"the build is marked as failed: {reason}")
    if report["hashes"].get("model") != design.model.digest():
        problems.append(f"{REPORT_FILE} belongs to a build of another model")
    try:
        checked = check(design, circuits, progress)
    except ToolError as error:
        if not problems:
            raise
        # A changed file may well be one that no tool can read.
        return [*problems, error.line()], None
    if checked.failure is not None:
        problems.append(checked.failure)
    for part, result in checked.syntheses.items():
        told = report["parts"].get(part, {}).get("luts")
        if told != result.resources.luts:
            problems.append(
                f"{REPORT_FILE} says that {part} takes {told} LUTs; it takes {result.resources.luts}"
            )
    return problems, checked
