"""A flight as one HTML page that needs no other file."""

import base64
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from wnn2hdl.apps.navigation.flight import FlightRun
from wnn2hdl.apps.navigation.output import PUBLISHED, notes
from wnn2hdl.apps.navigation.plots import COLOURS, Extent
from wnn2hdl.apps.navigation.results import FAR_M, FrameFix, MethodResult, SearchResult
from wnn2hdl.images import jpeg_bytes
from wnn2hdl.report.drawing import inlined
from wnn2hdl.report.shell import environment

PAGE_FILE = "flight.html"

_WIDEST_PX = 1200
_RADIUS = 0.006
"""Of a mark, as a share of the picture's longer side."""


@dataclass(frozen=True)
class Place:
    """A mark on the map.

    Attributes:
        x: pixels from the left of the picture.
        y: pixels from its top.
        text: what it tells when it is pointed at.
        fixed: whether the position was given as a fix.
    """

    x: float
    y: float
    text: str
    fixed: bool = False


def flight_page(run: FlightRun, errors: Path | None) -> str:
    """The page of a flight; the same run gives the same bytes.

    Args:
        run: the flight.
        errors: the plot of errors, an SVG by `wnn2hdl.report.plots.save_plot`; None where no truth is known.
    """
    result = run.result
    methods = [method for method in result.searches[0].methods if not method.tracked]
    return (
        environment("wnn2hdl.apps.navigation")
        .get_template("flight.html")
        .render(
            run=result,
            frames=len(methods[0].fixes),
            methods=len(methods),
            far=f"{FAR_M:g}",
            notes=notes(result),
            searches=[_search(run, search) for search in result.searches],
            errors=inlined(errors.read_text(encoding="utf-8"), "Errors of each method", "errors", "plot")
            if errors
            else "",
            published=PUBLISHED,
        )
    )


def _search(run: FlightRun, search: SearchResult) -> dict[str, Any]:
    alone = tuple(method for method in search.methods if not method.tracked)
    own = next((method for method in alone if method.weightless), None)
    known = [method for method in alone if method.mean_m is not None]
    best = own or min(known, key=lambda method: method.mean_m or 0.0, default=alone[0])
    whole = search.half_width_m is None
    return {
        "key": search.key.replace(".", "-"),
        "title": "Searched over the whole map" if whole else f"Searched within ±{search.half_width_m:g} m",
        "where": "whole map" if whole else f"±{search.half_width_m:g} m",
        "limits": ""
        if whole
        else f"No error can exceed {search.furthest_m:.0f} m here, and a blind guess would be "
        f"{search.blind_mean_m:.0f} m off on average.",
        "methods": search.methods,
        "alone": alone,
        "best": best,
        "beaten": search.beaten,
        "track": _track(run, alone),
        "frames": [(fixes[0].frame, fixes) for fixes in zip(*(method.fixes for method in alone), strict=True)]
        if known
        else [],
    }


def _track(run: FlightRun, methods: tuple[MethodResult, ...]) -> dict[str, Any]:
    """The map around the flight, and where the truth and the methods' positions lie on its picture."""
    extent = Extent.around(methods, run.grid.image.shape[:2], run.grid.to_pixel, run.grid.gsd_m)
    picture = run.grid.image[extent.top : extent.bottom, extent.left : extent.right]
    scale = min(1.0, _WIDEST_PX / max(picture.shape[:2]))
    if scale < 1:
        smaller = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        picture = np.asarray(smaller, dtype=np.uint8)

    def place(latitude: float, longitude: float, text: str, fixed: bool = False) -> Place:
        row, column = (float(axis) for axis in run.grid.to_pixel(latitude, longitude))
        # Whole numbers are centres of pixels.
        x, y = (column - extent.left + 0.5) * scale, (row - extent.top + 0.5) * scale
        return Place(x, y, text, fixed)

    return {
        "picture": base64.b64encode(jpeg_bytes(picture)).decode(),
        "width": picture.shape[1],
        "height": picture.shape[0],
        "radius": round(max(picture.shape[:2]) * _RADIUS, 1),
        "truth": [
            place(fix.truth_latitude, fix.truth_longitude, f"{fix.frame}: truth")
            for fix in methods[0].fixes
            if fix.truth_latitude is not None and fix.truth_longitude is not None
        ],
        "lines": [
            {
                "name": method.name,
                "colour": COLOURS[number % len(COLOURS)],
                "places": [
                    place(fix.latitude, fix.longitude, _told(method, fix), fix.fixed)
                    for fix in method.fixes
                    if fix.latitude is not None and fix.longitude is not None
                ],
            }
            for number, method in enumerate(methods)
        ],
    }


def _told(method: MethodResult, fix: FrameFix) -> str:
    off = "" if fix.error_m is None else f", {fix.error_m:.1f} m off"
    return f"{fix.frame}, {method.name}{off}, {'a fix' if fix.fixed else 'no fix'}"
