"""A run as one JSON object, and as files."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from wnn2hdl.apps.navigation.fixes import UNCALIBRATED
from wnn2hdl.apps.navigation.flight import FlightRun
from wnn2hdl.apps.navigation.output import write_results
from wnn2hdl.apps.navigation.page import PAGE_FILE, flight_page
from wnn2hdl.apps.navigation.plots import plot_errors, plot_tracks
from wnn2hdl.apps.navigation.results import FIGURES, MethodResult, SearchResult
from wnn2hdl.files import write_text

_KINDS = (
    "errors.*",
    "calibration.json",
    *(f"{kind}_{search}.*" for kind in ("fixes", "tracks") for search in ("map", "window_*m")),
)
"""Files that not every run writes."""


def summary(run: FlightRun) -> dict[str, Any]:
    """What ``locate --json`` prints.

    ``methods`` are those of the window's search, or of the whole map's if nothing else was searched. Of each,
    ``confidence_threshold`` is null where no fix is ever given, and for tracks, whose filter judges itself.
    """
    searches = {search.kind: _search(run, search) for search in run.result.searches}
    first = searches.get("window") or searches["map"]
    return {
        "map": run.result.map_name,
        "ground_sample_distance_m": run.result.ground_sample_distance_m,
        "map_note": run.result.map_note,
        "map_share": run.result.map_share,
        "frames": len(run.result.searches[0].methods[0].fixes),
        "methods": first["methods"],
        "searches": searches,
        "calibration": run.learned.calibration.report() if run.learned else None,
        "calibration_read_back": run.result.read_back,
        "largest_geodesic_difference_m": run.result.largest_geodesic_difference_m,
    }


def write_run(run: FlightRun, folder: Path) -> tuple[Path, ...]:
    """Write tables, GeoJSON, plots, a page, and what was learned; an earlier run's are removed.

    Where no truth is known there are no errors to plot.

    Returns:
        the files written.

    Raises:
        InputError: the folder cannot be written.
    """
    files = [*write_results(folder, run.result)]
    errors = None
    if any(method.errors_m for search in run.result.searches for method in search.methods):
        files += plot_errors(run.result, folder / "errors")
        errors = folder / "errors.svg"
    for search in run.result.searches:
        raw = replace(search, methods=tuple(method for method in search.methods if not method.tracked))
        files += plot_tracks(
            raw, run.grid.image, run.grid.to_pixel, run.grid.gsd_m, folder / f"tracks_{search.key}"
        )
    write_text(folder / PAGE_FILE, flight_page(run, errors))
    files.append(folder / PAGE_FILE)
    if run.learned:
        run.learned.write(folder / "calibration.json")
        files.append(folder / "calibration.json")
    for pattern in _KINDS:
        for file in {*folder.glob(pattern)} - {*files}:
            file.unlink()
    return tuple(files)


def _search(run: FlightRun, search: SearchResult) -> dict[str, Any]:
    return {
        "half_width_m": search.half_width_m,
        "furthest_m": search.furthest_m,
        "blind_mean_m": search.blind_mean_m,
        "beaten": search.beaten,
        "methods": {key: _figures(run, search, key, row) for key, row in run.rows(search).items()},
    }


def _figures(run: FlightRun, search: SearchResult, key: str, row: MethodResult) -> dict[str, Any]:
    acceptance = run.learned.acceptances.get((search.kind, key)) if run.learned else UNCALIBRATED
    figures = {name: getattr(row, name) for name in FIGURES}
    threshold = acceptance.threshold if acceptance and math.isfinite(acceptance.threshold) else None
    return figures | {"confidence_threshold": threshold}
