"""All pictures of a folder, each scanned by itself; totals count ground once that several show."""

import shutil
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from wnn2hdl.apps.deforestation.areas import ClassArea, class_areas
from wnn2hdl.apps.deforestation.calibration import Calibration, require_comparable
from wnn2hdl.apps.deforestation.mapping import CLASSIFYING, Coverage
from wnn2hdl.apps.deforestation.output import CLASSES_FILE, WORK, discard
from wnn2hdl.apps.deforestation.overlap import later_ones
from wnn2hdl.apps.deforestation.summary import (
    Totals,
    class_figures,
    coverage_figures,
    overlap_figures,
    summed,
    warnings,
)
from wnn2hdl.errors import InputError
from wnn2hdl.progress import Progress, reported

_PARTS = 1000
"""Steps in which the progress over one picture of a folder is reported."""


Scan = Callable[[Path, Path, Progress], Mapping[str, Any]]
"""Scans a picture into a folder, unless that was done already; gives its summary."""


def scan_folder(
    pictures: Mapping[str, Path],
    output: Path,
    bands: tuple[int, ...] | None,
    names: tuple[str, ...],
    scan: Scan,
    progress: Progress,
) -> dict[str, Any]:
    """Scan the pictures of a folder that are not scanned yet.

    Args:
        pictures: by the name of each one's folder in ``output``.
        output: the folder to write into.
        bands: those that are read.
        names: class names by index.
        scan: scans one.
        progress: called with how far all of them are.

    Returns:
        the figures of all, for their summary.

    Raises:
        InputError: some cannot be scanned, or their samples mean other values than those of the first; all
            others are scanned before.
    """
    summaries: dict[Path, Mapping[str, Any]] = {}
    faults = []
    first: tuple[Path, Calibration] | None = None
    for number, (stem, path) in enumerate(pictures.items()):
        one = partial(_part, progress, number, len(pictures))
        one(CLASSIFYING, 0, 1)
        try:
            calibration = Calibration.read(path, bands)
            first = first or (path, calibration)
            require_comparable(
                *first, path, calibration, "scan them one by one, or from folders, each with its own --scale"
            )
            summaries[output / stem / CLASSES_FILE] = scan(path, output / stem, one)
        except InputError as error:
            faults.append(error.line())
        one(CLASSIFYING, 1, 1)
    if faults:
        raise InputError(
            f"{len(faults)} of {len(pictures)} pictures are not scanned",
            value=f"{faults[0]}{', …' if len(faults) > 1 else ''}",
            hint="correct or remove them and run the same command again; the others are kept",
        )
    discard(output)
    # Of a scan of one picture into this folder that was killed.
    shutil.rmtree(output / WORK, ignore_errors=True)
    return _figures([*summaries.values()], _totals(summaries, names, progress))


def _totals(
    summaries: Mapping[Path, Mapping[str, Any]], names: tuple[str, ...], progress: Progress
) -> Totals:
    """What all pictures show together: of ground that several show, the last one's classes are counted."""
    alone = {raster: _areas(summary) for raster, summary in summaries.items()}
    later = later_ones([*summaries])
    counted = dict(alone)
    for raster in reported(later, "counting ground once", len(later), progress):
        counted[raster] = class_areas(raster, names, later[raster])
    once = [summed(list(areas)) for areas in zip(*counted.values(), strict=True)]
    twice = summed([area for areas in alone.values() for area in areas])
    return Totals(once, twice, sum(counted[raster] != alone[raster] for raster in later))


def _areas(summary: Mapping[str, Any]) -> tuple[ClassArea, ...]:
    return tuple(ClassArea(x["class"], x["pixels"], x["hectares"]) for x in summary["classes"])


def _figures(summaries: Sequence[Mapping[str, Any]], totals: Totals) -> dict[str, Any]:
    coverage = Coverage(
        sum(x["classified_pixels"] for x in summaries), sum(x["coverage"]["pixels"] for x in summaries)
    )
    notes = sorted({x["note"] for x in summaries} - {""})
    warned = [*warnings("; ".join(notes), coverage), *totals.warnings(len(summaries))]
    foreign = sum(x["coverage"]["foreign"] for x in summaries)
    if foreign:
        warned.append(f"{foreign} of {len(summaries)} pictures are foreign to the model")
    return {
        "pixels": sum(x["pixels"] for x in summaries),
        **class_figures(totals.areas),
        "overlap": overlap_figures(totals),
        "coverage": coverage_figures(coverage),
        "warnings": warned,
        "pictures": list(summaries),
    }


def _part(progress: Progress, number: int, count: int, step: str, done: int, total: int) -> None:
    """Report how far a picture of a folder is; a line for each step of each would be too many."""
    if step == CLASSIFYING:
        progress("scanning pictures", int((number + done / total) * _PARTS), count * _PARTS)
