"""The results of a flight as files: tables for people and programs, and the fixes as GeoJSON."""

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.apps.navigation.results import FAR_M, FIGURES, FlightResult, MethodResult, SearchResult
from wnn2hdl.files import make_folder, write_json, write_text
from wnn2hdl.markdown import MISSING, Align, escaped, table
from wnn2hdl.spreadsheet import csv_lines

TABLE_VERSION = 1
"""Of the form of `flight.json`; it rises when a key changes its meaning or goes away."""


@dataclass(frozen=True)
class PublishedMethod:
    """A row of the reference's table: another flight, 35 frames, searched within ±95 m of the truth.

    Its frames are 219 pixels wide and its windows 599, at half a metre per pixel.
    """

    name: str
    mean_m: float
    std_m: float
    variance_m2: float
    false_positive_percent: float
    true_positive_percent: float


PUBLISHED = (
    PublishedMethod("perspective + Canny", 36.04, 20.27, 410.86, 0.0, 100.0),
    PublishedMethod("rotation + Canny", 50.01, 25.67, 660.44, 2.86, 97.14),
    PublishedMethod("perspective + weightless edge filter", 44.94, 17.50, 305.89, 0.0, 100.0),
)

_FRAME_COLUMNS = (
    "search",
    "method",
    "frame",
    "truth_latitude",
    "truth_longitude",
    "latitude",
    "longitude",
    "error_m",
    "geodesic_error_m",
    "confidence",
    "fixed",
    "seconds",
)

_STATISTICS = """\
Errors are great-circle distances over all frames with a position, confident or not; the standard deviation
and the variance are the population's (divided by the number of frames)."""

_PUBLISHED_NOTE = """\
The published rows were measured on a flight that is not at hand, searched within ±95 m of the truth: none of
their errors could exceed 134 m, and a blind guess would have been 73 m off on average."""

_UNCALIBRATED = """\
Nothing was calibrated, so the worth of a confidence is unknown: the best position of a single frame is always
given as a fix, right or wrong."""


_READ_BACK = """\
The calibration was read back from an earlier run. The map, the camera as given, the tolerances, the windows
and the methods are the same as they were then. Whether this log counts headings, heights and angles as the
earlier one did, and whether the camera is still mounted as it was, has not been checked: only frames to
calibrate on can show it."""


def write_results(folder: Path, result: FlightResult) -> tuple[Path, ...]:
    """Write ``flight.md``, ``flight.json``, ``table.csv``, ``frames.csv`` and one GeoJSON per search.

    Args:
        folder: made if it does not exist; files of these names are replaced.
        result: a whole run.

    Returns:
        the files written.

    Raises:
        InputError: the folder cannot be written.
    """
    make_folder(folder)
    texts = {
        "flight.md": flight_markdown(result),
        "table.csv": table_csv(result),
        "frames.csv": frames_csv(result),
    }
    for search in result.searches:
        # One feature per line: such files are read by programs and compared by lines.
        features = ",\n".join(json.dumps(feature, ensure_ascii=False) for feature in fix_features(search))
        texts[f"fixes_{search.key}.geojson"] = (
            f'{{"type": "FeatureCollection", "features": [\n{features}\n]}}\n'
        )
    for name, text in texts.items():
        write_text(folder / name, text)
    write_json(folder / "flight.json", flight_dict(result))
    return (*(folder / name for name in texts), folder / "flight.json")


def flight_dict(result: FlightResult) -> dict[str, Any]:
    """The JSON object of ``flight.json``: every figure and every frame; NaN and infinities become null."""
    return {
        "version": TABLE_VERSION,
        "map": result.map_name,
        "map_note": result.map_note,
        "map_share": result.map_share,
        "ground_sample_distance_m": result.ground_sample_distance_m,
        "camera": {"focal_px": result.focal_px, "tilts_deg": list(result.tilts_deg)},
        "calibrated_on": list(result.calibrated_on),
        "calibration_read_back": result.read_back,
        "largest_geodesic_difference_m": result.largest_geodesic_difference_m,
        "searches": [
            {
                "kind": search.kind,
                "half_width_m": search.half_width_m,
                "furthest_m": search.furthest_m,
                "blind_mean_m": search.blind_mean_m,
                "beaten": search.beaten,
                "methods": [
                    {"name": method.name}
                    | {figure: getattr(method, figure) for figure in FIGURES}
                    | {"frames": [_finite(asdict(fix)) for fix in method.fixes]}
                    for method in search.methods
                ],
            }
            for search in result.searches
        ],
        "published": [asdict(row) | {"measured_here": False} for row in PUBLISHED],
    }


def table_csv(result: FlightResult) -> str:
    """A line for each search and method, with all figures; empty where there is none."""
    return _joined(
        ("search", "method", *FIGURES),
        (
            (search.key, method.name, *(getattr(method, figure) for figure in FIGURES))
            for search in result.searches
            for method in search.methods
        ),
    )


def frames_csv(result: FlightResult) -> str:
    """A line for each search, method and frame; empty where there is no position."""
    return _joined(
        _FRAME_COLUMNS,
        (
            (search.key, method.name, *asdict(fix).values())
            for search in result.searches
            for method in search.methods
            for fix in method.fixes
        ),
    )


def fix_features(search: SearchResult) -> list[dict[str, Any]]:
    """The truth and every position as GeoJSON point features (RFC 7946: longitude first, WGS 84).

    Those not known are left out. Positions have eight decimals, about a millimetre. The truth's ``method`` is
    "truth".
    """
    features = [
        _point(fix.truth_longitude, fix.truth_latitude, {"method": "truth", "frame": fix.frame})
        for fix in (search.methods[0].fixes if search.methods else ())
        if fix.truth_latitude is not None and fix.truth_longitude is not None
    ]
    for method in search.methods:
        features += [
            _point(
                fix.longitude,
                fix.latitude,
                {"method": method.name, "frame": fix.frame}
                | _finite(
                    {
                        "error_m": fix.error_m,
                        "geodesic_error_m": fix.geodesic_error_m,
                        "confidence": fix.confidence,
                        "fixed": fix.fixed,
                        "seconds": fix.seconds,
                    }
                ),
            )
            for fix in method.fixes
            if fix.latitude is not None and fix.longitude is not None
        ]
    return features


def flight_markdown(result: FlightResult) -> str:
    """The page ``flight.md``: the reference's table for each search, with its published figures beside."""
    fitted = (
        f"fitted on {len(result.calibrated_on)} frames that are not scored"
        if result.calibrated_on
        else "given"
    )
    tilts = ", then ".join(f"{tilt:.2f}" for tilt in result.tilts_deg)
    difference = result.largest_geodesic_difference_m
    sections = [
        "# Positions from edges",
        f"Map {escaped(result.map_name)} at {result.ground_sample_distance_m:g} m per pixel; camera "
        f"{fitted}: "
        f"focal length {result.focal_px:.1f} px, forward tilt {tilts} degrees.",
        _left_out(result),
        _READ_BACK if result.read_back else "",
        _STATISTICS,
        f"They differ from geodesic distances by at most {difference:.2f} m."
        if difference is not None
        else "",
        *(
            section
            for search in result.searches
            for section in _search_sections(search, bool(result.calibrated_on))
        ),
    ]
    return "\n\n".join(section for section in sections if section) + "\n"


def notes(result: FlightResult) -> list[str]:
    """What a reader must know before believing the figures, a paragraph each."""
    told = [_left_out(result), _READ_BACK if result.read_back else ""]
    return [note for note in (*told, "" if result.calibrated_on else _UNCALIBRATED) if note]


def _left_out(result: FlightResult) -> str:
    """What of the map is not searched, and what was assumed about it."""
    note = f"{result.map_note[:1].upper()}{result.map_note[1:]}." if result.map_note else ""
    share = (
        f"{100 * (1 - result.map_share):.1f} % of its north-up grid shows no map (masked, without data, "
        "plain black or white at its edge, or outside a turned picture) and is left out."
        if result.map_share < 1
        else ""
    )
    return " ".join(filter(None, [note, share]))


def _search_sections(search: SearchResult, calibrated: bool) -> list[str]:
    if search.half_width_m is None:
        title, limits = "## Searched over the whole map", ""
    else:
        title = f"## Searched within ±{search.half_width_m:g} m of the truth"
        limits = (
            f"No error can exceed {search.furthest_m:.0f} m here, and a blind guess would be "
            f"{search.blind_mean_m:.0f} m off on average."
        )
    heads = ["method", "mean error m", "standard deviation m", "variance m²"]
    heads += [f"error ≥ {FAR_M:g} m", f"< {FAR_M:g} m"]
    rows = [_figures(method.name, method) for method in search.methods]
    published = [_figures(f"{row.name}: published, another flight", row) for row in PUBLISHED]
    confident = [
        [
            method.name,
            str(len(method.fixes)),
            _percent(method.fixed_percent),
            _percent(method.fixed_true_percent),
            _number(method.fixed_mean_m),
            _number(method.mean_seconds, 3),
        ]
        for method in search.methods
    ]
    return [
        title,
        limits,
        _table(heads, [*rows, *published]),
        search.beaten,
        _PUBLISHED_NOTE,
        "What the confidence is worth:",
        _table(
            ["method", "frames", "fixed", f"fixes < {FAR_M:g} m", "mean error of fixes m", "s per frame"],
            confident,
        ),
        _without_fix(search),
        "" if calibrated else _UNCALIBRATED,
    ]


def _without_fix(search: SearchResult) -> str:
    silent = [method.name for method in search.methods if not method.fixed_percent]
    if not silent:
        return ""
    return (
        f"No fix is given by {'; '.join(silent)}: judging by the calibration's frames, none of their "
        "positions is sure enough. Calibrating on more frames, ten or more, often helps."
    )


def _figures(name: str, row: MethodResult | PublishedMethod) -> list[str]:
    return [
        name,
        _number(row.mean_m),
        _number(row.std_m),
        _number(row.variance_m2),
        _percent(row.false_positive_percent),
        _percent(row.true_positive_percent),
    ]


def _number(value: float | None, decimals: int = 2) -> str:
    return MISSING if value is None else f"{value:.{decimals}f}"


def _percent(value: float | None) -> str:
    return MISSING if value is None else f"{value:.2f} %"


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    align: list[Align] = ["left"]
    return table(heads, rows, align + ["right"] * (len(heads) - 1))


def _joined(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    return "".join(csv_lines(heads, rows))


def _point(longitude: float, latitude: float, properties: dict[str, Any]) -> dict[str, Any]:
    # A map may count longitudes from 0 to 360; GeoJSON counts them from -180.
    longitude = (longitude + 180) % 360 - 180
    return {
        "type": "Feature",
        "geometry": {"type": "Point", "coordinates": [round(longitude, 8), round(latitude, 8)]},
        "properties": properties,
    }


def _finite(fields: dict[str, Any]) -> dict[str, Any]:
    """The fields with None for infinities and NaN, which JSON cannot express."""
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in fields.items()
    }
