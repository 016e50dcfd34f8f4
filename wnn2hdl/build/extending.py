"""Adding to the report of a build that other tools worked on, so that its manifest stays true."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from wnn2hdl.build.folder import REPORT_FILE, REPORT_HTML, REPORT_PAGE
from wnn2hdl.build.reporting import write_page
from wnn2hdl.build.verification import open_build
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.emit import renew_manifest
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.files import held, write_json, write_text
from wnn2hdl.report import report_markdown


def require_unchanged(folder: Path) -> None:
    """Raise CheckError if files of a build were changed: its manifest is about to be renewed."""
    changes = check_manifest(folder, besides={REPORT_HTML})
    if changes:
        raise CheckError(
            "the build was changed after it was compiled", value=changes[0], hint="compile the model again"
        )


def require_outside(folder: Path, output: Path) -> None:
    """Raise InputError if an output would lie in a build, which holds what the compiler writes alone."""
    if output.resolve().is_relative_to(folder.resolve()):
        raise InputError("the output lies in the build", value=output, hint="choose a folder beside it")


def add_to_report(folder: Path, figures: Mapping[str, Mapping[str, Any]]) -> None:
    """Add figures to the report of a build, and write its pages and its manifest again.

    Args:
        folder: the build.
        figures: objects by their keys in the report; their members join those that stand there.

    Raises:
        InputError: the folder cannot be written, or another process writes it.
    """
    with held(folder.resolve(), "build"):
        _, _, report = open_build(folder)
        for key, found in figures.items():
            report[key] = {**report.get(key, {}), **found}
        write_json(folder / REPORT_FILE, report)
        write_text(folder / REPORT_PAGE, report_markdown(report))
        write_page(folder)
        renew_manifest(folder, (REPORT_FILE, REPORT_PAGE, REPORT_HTML))
