"""A whole run over a small rendered flight, and over the real one."""

from pathlib import Path

import pytest

from wnn2hdl.navigate.camera import Camera
from wnn2hdl.navigate.flight import FlightRun, run_flight
from wnn2hdl.navigate.poses import Pose, read_poses
from wnn2hdl.navigate.recording import Recording, split
from wnn2hdl.navigate.summary import FIGURES, summary, write_run
from wnn2hdl.navigate.world import WorldMap
from wnn2hdl.samples.flight import make_flight

STEPS: list[tuple[str, int, int]] = []


@pytest.fixture(scope="module")
def run() -> FlightRun:
    """Seven frames, of which four calibrate a camera whose tilt nobody told."""
    flight = make_flight(
        4, (600, 600), frames=7, frame_size=(150, 260), height_m=60, tilt_deg=7, spacing_m=20, gusts_deg=1.5
    )
    poses = tuple(
        Pose(at.frame, at.latitude_deg, at.longitude_deg, at.height_m, at.yaw_deg, at.pitch_deg, at.roll_deg)
        for at in flight.poses
    )
    calibrating, scored = split(poses, 4)
    recording = Recording(
        "rendered",
        WorldMap.of_gdal(flight.map_image, flight.transform, flight.epsg),
        Camera.of_focal(flight.camera.focal_px, 260, 150),
        scored,
        lambda pose: flight.frame(poses.index(pose)),
    )
    searches = {"window": 40.0, "map": None}
    return run_flight(recording, calibrating, searches, lambda *step: STEPS.append(step), jobs=2)  # type: ignore[arg-type]


def test_the_unknown_tilt_is_found_and_frames_are_located(run: FlightRun) -> None:
    assert run.calibration is not None
    assert run.calibration.cameras[0].tilt_deg == pytest.approx(7, abs=1)
    for search in run.result.searches:
        for key, row in run.rows(search).items():
            if key not in ("rotation-canny", "rotation-canny-track"):
                assert row.mean_m is not None
                assert row.mean_m < 5, (search.key, key)


def test_calibration_frames_are_not_scored(run: FlightRun) -> None:
    scored = {fix.frame for fix in run.result.searches[0].methods[0].fixes}
    assert len(scored) == 3
    assert len(run.result.calibrated_on) == 4
    assert not scored & set(run.result.calibrated_on)


def test_progress_is_told(run: FlightRun) -> None:
    assert {step for step, _, _ in STEPS} == {"map", "calibration", "thresholds", "frames"}
    assert STEPS[-1] == ("frames", 3, 3)


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


@pytest.mark.slow
@pytest.mark.realdata
def test_weightless_edges_locate_the_real_flight(realdata: Path) -> None:
    """Half the best published mean over the whole map, on frames that nothing was fitted on."""
    folder = realdata / "flight_fengyuan"
    calibrating, scored = split(read_poses(folder / "poses.csv"), 10)
    recording = Recording.of_files(folder / "map.tif", folder / "frames", scored[::2], 750.0)
    found = run_flight(recording, calibrating, {"map": None}, lambda *_: None)
    row = found.rows(found.result.searches[0])["perspective-weightless"]
    assert row.mean_m is not None
    assert row.mean_m <= 18
    assert row.false_positive_percent == 0
