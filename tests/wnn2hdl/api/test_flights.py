"""A flight located from Python."""

from pathlib import Path

import pytest

from wnn2hdl.api import locate, recording
from wnn2hdl.errors import InputError
from wnn2hdl.samples.flight import make_flight, write_flight

pytest.importorskip("rasterio")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flight")
    flight = make_flight(3, (400, 400), frames=6, frame_size=(90, 160), height_m=50, tilt_deg=3, spacing_m=15)
    list(write_flight(path, flight))
    return path


def test_what_one_flight_learned_the_next_takes(folder: Path) -> None:
    flight = recording(folder / "map.tif", folder / "frames", str(folder / "poses.csv"), 120.0)
    found = locate(flight, calibrate=4, methods=["grey"], window_m=None)
    assert set(found.methods) == {"map"}
    row = found.methods["map"]["grey"]
    assert len(row.fixes) == 2
    assert f"{row.mean_m:.1f} m off on average" in repr(found)
    assert "2 frames located on map.tif" in found._repr_html_()
    written = found.write(folder / "out")
    assert folder / "out" / "calibration.json" in written
    again = locate(flight, calibrate=folder / "out" / "calibration.json", methods=["grey"], window_m=None)
    assert again.run.result.read_back
    assert [fix.error_m for fix in again.methods["map"]["grey"].fixes] == [fix.error_m for fix in row.fixes]


def test_a_match_engine_is_asked_for_with_its_sizes(folder: Path) -> None:
    flight = recording(folder / "map.tif", folder / "frames", folder / "poses.csv", 120.0)
    found = locate(flight, methods=["engine"], engine=((12, 12), (32, 32)), window_m=20.0, whole_map=False)
    assert [row.name for row in found.methods["window"].values()] == ["match engine", "match engine, track"]
    with pytest.raises(InputError, match="has a template and a segment"):
        locate(flight, methods=["engine"])


def test_a_flight_without_a_search_is_refused(folder: Path) -> None:
    with pytest.raises(InputError, match="nothing is to be searched"):
        locate(window_m=None, whole_map=False)


def test_a_method_that_does_not_exist_is_named(folder: Path) -> None:
    flight = recording(folder / "map.tif", folder / "frames", folder / "poses.csv", 120.0)
    with pytest.raises(InputError, match="there is no such method: gray; choose of perspective-canny"):
        locate(flight, methods=["gray"])
