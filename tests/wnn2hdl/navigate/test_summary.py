"""A run as JSON and as files."""

from pathlib import Path

import pytest

from wnn2hdl.navigate.flight import FlightRun
from wnn2hdl.navigate.results import FIGURES
from wnn2hdl.navigate.summary import summary, write_run


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
        "table.csv",
        "errors.png",
        "tracks_map.png",
        "tracks_window_40m.png",
        "calibration.json",
    }
    assert all(path.is_file() for path in files)
