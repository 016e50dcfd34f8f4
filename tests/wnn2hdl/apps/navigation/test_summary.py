"""A run as JSON and as files."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.navigation.flight import FlightRun
from wnn2hdl.apps.navigation.results import FIGURES
from wnn2hdl.apps.navigation.summary import summary, write_run


def test_the_summary_has_every_method_and_search(run: FlightRun) -> None:
    data = summary(run)
    assert data["methods"] == data["searches"]["window"]["methods"]
    names = {"perspective-canny", "rotation-canny", "perspective-weightless", "perspective-sobel", "grey"}
    assert set(data["methods"]) == names | {f"{name}-track" for name in names}
    for figures in data["methods"].values():
        assert set(figures) == {*FIGURES, "confidence_threshold"}
    assert data["searches"]["window"]["furthest_m"] == pytest.approx(56.6, abs=0.1)
    assert data["calibration"]["tilts"][0]["tilt_deg"] == pytest.approx(7, abs=1)


def test_files_are_written(run: FlightRun, tmp_path: Path) -> None:
    files = write_run(run, tmp_path)
    assert {path.name for path in files} >= {
        "flight.json",
        "flight.md",
        "flight.html",
        "table.csv",
        "errors.png",
        "tracks_map.png",
        "tracks_window_40m.png",
        "calibration.json",
    }
    assert all(path.is_file() for path in files)


def test_files_of_an_earlier_run_do_not_stay_beside_new_ones(run: FlightRun, tmp_path: Path) -> None:
    write_run(run, tmp_path)
    (tmp_path / "tracks_home.png").touch()
    window = replace(run.result, searches=run.result.searches[:1])
    files = write_run(replace(run, result=window, learned=None), tmp_path)
    assert {*tmp_path.iterdir()} == {*files, tmp_path / "tracks_home.png"}
    assert "tracks_map.png" not in {file.name for file in files}


def test_without_any_truth_there_are_no_errors_to_plot(flying: Any, tmp_path: Path) -> None:
    files = {path.name for path in write_run(flying({"map": None}, aside_deg=math.nan), tmp_path)}
    assert "errors.png" not in files
    assert "tracks_map.png" in files
    features = json.loads((tmp_path / "fixes_map.geojson").read_text())["features"]
    assert "truth" not in {feature["properties"]["method"] for feature in features}
    assert "| perspective + weightless | n/a |" in (tmp_path / "flight.md").read_text()


def test_what_was_learned_is_told(run: FlightRun, tmp_path: Path) -> None:
    write_run(run, tmp_path)
    learned = json.loads((tmp_path / "calibration.json").read_text())
    assert run.learned is not None
    assert learned["weightless"] == run.learned.weightless.to_json()
