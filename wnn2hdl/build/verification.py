"""Checking a build again, from its files alone."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

from wnn2hdl.build.checking import Checked, check
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import Files
from wnn2hdl.build.folder import REPORT_FILE, failure, require_build
from wnn2hdl.build.statements import false_statements, foreign_circuit, foreign_files, foreign_text
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import CheckError, InputError, ModelFileError, ToolError
from wnn2hdl.progress import Progress
from wnn2hdl.report import load_report


def open_build(folder: Path) -> tuple[Design, Files, dict[str, Any]]:
    """A build's design, files and report.

    Raises:
        InputError: the folder is not a build.
        ModelFileError: one of its files is missing or damaged.
    """
    require_build(folder)
    design = Design.load(folder)
    report = load_report(folder / REPORT_FILE)
    return design, Files.of(design, folder), report


def verify_build(folder: Path, progress: Progress) -> tuple[list[str], Checked | None]:
    """Hashes, files, simulation, proof and count of a build, all done again.

    Args:
        folder: the build folder.
        progress: reports every stage.

    Returns:
        What is wrong, one line each, empty if nothing is; and what the checks found, None where files are
        missing, or changed so that nothing can be checked.

    Raises:
        InputError: the folder is not a build.
        ToolError: an outside program is missing or failed.
    """
    require_build(folder)
    progress("reading the files", 0, 1)
    problems, build = inspect_build(folder)
    progress("reading the files", 1, 1)
    if build is None:
        return problems, None
    design, files, report = build
    try:
        checked = check(design, files, progress, afresh=True)
    except (InputError, ToolError, CheckError) as error:
        if not problems and isinstance(error, ToolError):
            raise
        # A changed file may well be one that no tool can read.
        return [*problems, error.line()], None
    if checked.failure is not None:
        problems.append(checked.failure)
    proof = {
        "status": checked.status,
        "claims": list(map(asdict, checked.claims)),
        "unproved": list(checked.unproved),
    }
    return [*problems, *false_statements(design, report, checked.syntheses, proof)], checked


def inspect_build(folder: Path) -> tuple[list[str], tuple[Design, Files, dict[str, Any]] | None]:
    """What can be seen without simulation, proof and synthesis.

    The hashes notice changes by accident; somebody who wants to deceive rewrites them. So nothing in the
    folder is believed but the model and the design's choices: its text is written again here, its circuit is
    proved and the report's figures are found again in `verify_build`. What is not found again is what takes
    pictures: accuracy, coverage, and whether the care set is that of the imagery meant; report and Verilog
    say how large it is.

    Returns:
        What is wrong, one line each; and the build, None if it cannot be checked further.

    Raises:
        InputError: the folder is not a build.
        ToolError: Yosys is missing or failed.
    """
    require_build(folder)
    problems = check_manifest(folder)
    if any("missing" in problem for problem in problems):
        return problems, None
    try:
        design, files, report = open_build(folder)
    except ModelFileError as error:
        return [*problems, error.line()], None
    reason = failure(folder)
    if reason is not None:
        problems.append(f"the build is marked as failed: {reason}")
    foreign = [*foreign_files(design, folder), *foreign_circuit(design)]
    if foreign:
        return [*problems, *foreign], None
    return [*problems, *foreign_text(design, report, folder)], (design, files, report)
