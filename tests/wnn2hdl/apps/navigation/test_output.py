"""Results as files: every figure in every form, and GeoJSON that other programs read."""

import csv
import io
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.apps.navigation.output import (
    fix_features,
    flight_dict,
    flight_markdown,
    frames_csv,
    table_csv,
    write_results,
)
from wnn2hdl.apps.navigation.results import FlightResult, FrameFix, MethodResult, SearchResult
from wnn2hdl.errors import InputError


def fix(number: int, error_m: float | None, *, confidence: float = 1.5) -> FrameFix:
    known = error_m is not None
    return FrameFix(
        f"frame_{number}.jpg",
        -9.8 + number / 1000,
        -61.2,
        -9.8 if known else None,
        -61.25 if known else None,
        error_m,
        error_m + 0.25 if known and error_m is not None else None,
        confidence,
        known and confidence > 1,
        0.02,
    )


CANNY = MethodResult("perspective + Canny", (fix(1, 10.0), fix(2, 120.0, confidence=0.5), fix(3, None)))
EDGES = MethodResult("perspective + weightless", (fix(1, 4.0, confidence=math.inf), fix(2, 8.0), fix(3, 6.0)))
RESULT = FlightResult(
    "map.tif",
    0.5,
    751.25,
    (9.5, 0.75),
    ("frame_8.jpg", "frame_9.jpg"),
    (SearchResult("window", 95.0, (CANNY, EDGES)), SearchResult("map", None, (EDGES,))),
)


def test_markdown_has_a_row_for_each_method_and_the_published_ones_beside() -> None:
    page = flight_markdown(RESULT)
    assert "| perspective + Canny | 65.00 | 55.00 | 3025.00 | 50.00 % | 50.00 % |" in page
    assert page.count("| perspective + weightless | 6.00 | 1.63 | 2.67 | 0.00 % | 100.00 % |") == 2
    published = (
        "| perspective + Canny: published, another flight | 36.04 | 20.27 | 410.86 | 0.00 % | 100.00 % |"
    )
    assert page.count(published) == 2
    assert "| perspective + Canny | 3 | 33.33 % | 100.00 % | 10.00 | 0.020 |" in page


def test_markdown_says_what_window_camera_and_distance_mean() -> None:
    page = flight_markdown(RESULT)
    assert "No error can exceed 134 m here, and a blind guess would be 73 m off on average." in page
    assert (
        "fitted on 2 frames that are not scored: focal length 751.2 px, forward tilt 9.50, then 0.75 degrees"
        in page
    )
    assert "the population's" in page
    assert "at most 0.25 m" in page
    assert "searched over the whole map" in page.lower()


def test_markdown_names_the_methods_that_give_no_fix() -> None:
    unsure = [
        MethodResult(name, (fix(1, 4.0, confidence=0.1),)) for name in ("grey levels", "grey levels, track")
    ]
    page = flight_markdown(replace(RESULT, searches=(SearchResult("map", None, (EDGES, *unsure)),)))
    assert "No fix is given by grey levels; grey levels, track: " in page
    assert "No fix" not in flight_markdown(RESULT)


def test_markdown_says_what_is_not_calibrated_left_out_or_assumed() -> None:
    page = flight_markdown(replace(RESULT, calibrated_on=(), map_note="three bands", map_share=0.913))
    assert page.count("Nothing was calibrated") == 2
    assert "Three bands. 8.7 % of its north-up grid shows no map" in page
    plain = flight_markdown(RESULT)
    assert "Nothing was calibrated" not in plain
    assert "shows no map" not in plain


def test_markdown_says_what_of_a_calibration_that_was_read_back_is_not_checked() -> None:
    page = flight_markdown(replace(RESULT, read_back=True))
    assert "whether the camera is still mounted as it was, has not been checked" in page
    assert "has not been checked" not in flight_markdown(RESULT)


def test_markdown_says_what_is_nearer_than_the_weightless_edges() -> None:
    own, nearer = replace(EDGES, weightless=True), MethodResult("grey levels", (fix(1, 1.0),))
    page = flight_markdown(replace(RESULT, searches=(SearchResult("map", None, (own, nearer)),)))
    assert "On this flight grey levels (1.0 m) is nearer" in page


def test_a_method_without_positions_shows_no_figures() -> None:
    nothing = MethodResult("Sobel", (fix(1, None),))
    page = flight_markdown(FlightResult("m", 0.5, 1, (0.0,), (), (SearchResult("map", None, (nothing,)),)))
    assert "| Sobel | n/a | n/a | n/a | n/a | n/a |" in page
    assert "camera given" in page


def test_json_holds_every_frame_and_is_strict() -> None:
    data = json.loads(json.dumps(flight_dict(RESULT), allow_nan=False))
    assert data["calibrated_on"] == ["frame_8.jpg", "frame_9.jpg"]
    assert [search["kind"] for search in data["searches"]] == ["window", "map"]
    canny, edges = data["searches"][0]["methods"]
    assert canny["mean_m"] == 65
    assert [frame["error_m"] for frame in canny["frames"]] == [10, 120, None]
    assert edges["frames"][0]["confidence"] is None
    assert {row["measured_here"] for row in data["published"]} == {False}
    assert [row["mean_m"] for row in data["published"]] == [36.04, 50.01, 44.94]


def test_frames_csv_has_a_line_for_each_search_method_and_frame() -> None:
    rows = list(csv.DictReader(io.StringIO(frames_csv(RESULT))))
    assert len(rows) == 9
    assert (rows[1]["search"], rows[1]["method"]) == ("window_95m", "perspective + Canny")
    assert (float(rows[1]["error_m"]), rows[1]["fixed"]) == (120, "False")
    assert float(rows[1]["truth_latitude"]) == -9.798
    assert rows[2]["latitude"] == rows[2]["error_m"] == ""
    assert rows[-1]["search"] == "map"


def test_table_csv_has_all_figures_of_each_method() -> None:
    rows = list(csv.DictReader(io.StringIO(table_csv(RESULT))))
    assert [(row["search"], row["method"]) for row in rows] == [
        ("window_95m", "perspective + Canny"),
        ("window_95m", "perspective + weightless"),
        ("map", "perspective + weightless"),
    ]
    assert float(rows[0]["mean_m"]) == 65
    assert float(rows[0]["variance_m2"]) == 3025
    assert float(rows[0]["false_positive_percent"]) == 50


def test_features_are_points_with_longitude_first_and_the_truth_once() -> None:
    features = fix_features(RESULT.searches[0])
    assert [feature["properties"]["method"] for feature in features] == (
        ["truth"] * 3 + ["perspective + Canny"] * 2 + ["perspective + weightless"] * 3
    )
    assert features[1]["geometry"] == {"type": "Point", "coordinates": [-61.2, -9.798]}
    assert features[4]["geometry"]["coordinates"] == [-61.25, -9.8]
    assert features[4]["properties"]["error_m"] == 120
    assert features[4]["properties"]["fixed"] is False


def test_longitudes_of_a_map_to_360_are_brought_home() -> None:
    far = replace(fix(1, 4.0), longitude=300.5, truth_longitude=-60.0)
    points = fix_features(SearchResult("map", None, (replace(EDGES, fixes=(far,)),)))
    assert [point["geometry"]["coordinates"][0] for point in points] == [-60.0, -59.5]


def test_no_name_of_a_map_or_frame_changes_a_table() -> None:
    hostile = "=1|</script>\n#`\"',*_" + "x" * 5000
    method = replace(EDGES, fixes=(replace(fix(1, 4.0), frame=hostile),))
    result = replace(RESULT, map_name=hostile, searches=(SearchResult("map", None, (method,)),))
    _, row = csv.reader(frames_csv(result).splitlines())
    assert row[2] == "'" + hostile.replace("\n", " ")
    page, plain = (flight_markdown(x).splitlines() for x in (result, replace(result, map_name="map.tif")))
    assert len(page) == len(plain)
    assert "</script>" not in "".join(page)


def test_all_files_are_written_and_read_back(tmp_path: Path) -> None:
    written = write_results(tmp_path / "new" / "flight", RESULT)
    assert {path.name for path in written} == {
        "flight.md",
        "flight.json",
        "table.csv",
        "frames.csv",
        "fixes_window_95m.geojson",
        "fixes_map.geojson",
    }
    assert set((tmp_path / "new" / "flight").iterdir()) == set(written)
    collection = json.loads((tmp_path / "new" / "flight" / "fixes_map.geojson").read_text())
    assert collection["type"] == "FeatureCollection"
    assert len(collection["features"]) == 6


def test_gdal_reads_the_fixes(tmp_path: Path) -> None:
    pyogrio = pytest.importorskip("pyogrio")
    write_results(tmp_path, RESULT)
    info = pyogrio.read_info(tmp_path / "fixes_window_95m.geojson")
    assert (info["features"], info["geometry_type"], info["crs"]) == (8, "Point", "EPSG:4326")


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(InputError, match="cannot make the folder"):
        write_results(tmp_path / "taken", RESULT)
