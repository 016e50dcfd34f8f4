"""The baseline of the gate: what builds cost and how often they were right, in a file beside the code."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.errors import CheckError
from wnn2hdl.files import read_json, write_json
from wnn2hdl.report.schemas import check

FORMAT = "wnn2hdl-baseline"
VERSION = 1

RIVALS = frozenset({"sobel"})
"""Parts that a build is compared with and that do not belong to it."""


def shown_parts(parts: Mapping[str, Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    """The counted parts of a report that people are shown: rivals find edges, and most circuits do not.

    Args:
        parts: figures by part, as in ``report.json``.
    """
    return {
        part: figures
        for part, figures in parts.items()
        if figures["luts"] is not None and (part not in RIVALS or "edge" in parts)
    }


@dataclass(frozen=True)
class Recorded:
    """What a baseline holds of a build.

    Attributes:
        accuracy: of the circuit, 0 to 1; None if it was not measured.
        luts: of each part that was measured, rivals left out.
        mode: ``exact`` or ``domain``.
        target: of the build.
    """

    accuracy: float | None
    luts: Mapping[str, int]
    mode: str
    target: str


def recorded(report: Mapping[str, Any]) -> Recorded:
    """What a baseline holds of the build of a report."""
    luts = {
        part: figures["luts"]
        for part, figures in sorted(report["parts"].items())
        if figures["luts"] is not None and part not in RIVALS
    }
    return Recorded(report["accuracy"], luts, report["mode"], report["target"])


def write_baseline(
    path: Path, reports: Mapping[str, Mapping[str, Any]], changes: Mapping[str, Sequence[str]]
) -> None:
    """Record builds; the file is sorted, one figure per line, so that a change shows in a diff.

    Args:
        path: the file.
        reports: the objects of `report.json` by the name of the build.
        changes: for each build which of its files were changed after it was made.

    Raises:
        CheckError: a build is not proved, or not as it was when it was: its
            figures may be wrong, so others cannot be measured by them.
        InputError: the file cannot be written.
    """
    for name, report in reports.items():
        if report["proof"]["status"] != "proved":
            raise CheckError(
                "a build that is not proved cannot be a baseline", value=name, hint="compile it again"
            )
        if changes[name]:
            raise CheckError(
                "a build that was changed cannot be a baseline",
                value=f"{name} ({', '.join(changes[name])})",
                hint="compile it again",
            )
    builds = {name: asdict(recorded(report)) for name, report in sorted(reports.items())}
    write_json(path, {"format": FORMAT, "version": VERSION, "builds": builds})


def read_baseline(path: Path) -> dict[str, Recorded]:
    """Read what `write_baseline` wrote, by the name of the build.

    Raises:
        ModelFileError: the file is missing, damaged, of another version or no baseline.
    """
    data = read_json(path, "a baseline")
    check(data, "baseline", path, "write it again with --write-baseline")
    return {name: Recorded(**build) for name, build in data["builds"].items()}
