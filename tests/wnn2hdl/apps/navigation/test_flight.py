"""A whole run over a small rendered flight, and over the real one."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import pytest

from wnn2hdl.apps.navigation.flight import FlightRun, calibrated, run_flight
from wnn2hdl.apps.navigation.poses import Pose, frame_files, read_poses
from wnn2hdl.apps.navigation.recording import Recording, split
from wnn2hdl.errors import InputError


def test_the_unknown_tilt_is_found_and_frames_are_located(run: FlightRun) -> None:
    assert run.learned is not None
    assert run.learned.calibration.cameras[0].tilt_deg == pytest.approx(7, abs=1)
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


def test_where_scored_frames_were_makes_no_difference_on_the_whole_map(run: FlightRun, flying: Any) -> None:
    elsewhere = flying({"map": None}, aside_deg=0.5)
    assert elsewhere.learned is not None
    assert run.learned is not None
    assert elsewhere.learned.calibration == run.learned.calibration
    for lost, known in zip(elsewhere.result.searches[0].methods, run.result.searches[1].methods, strict=True):
        for one, other in zip(lost.fixes, known.fixes, strict=True):
            assert one.error_m is not None
            assert one.error_m > 50_000
            assert (one.latitude, one.longitude) == (other.latitude, other.longitude)
            assert (one.confidence, one.fixed) == (other.confidence, other.fixed)


def test_a_position_that_is_not_known_is_not_needed_on_the_whole_map(run: FlightRun, flying: Any) -> None:
    unknown = flying({"map": None}, aside_deg=math.nan)
    for method, known in zip(unknown.result.searches[0].methods, run.result.searches[1].methods, strict=True):
        assert method.mean_m is None
        for one, other in zip(method.fixes, known.fixes, strict=True):
            assert (one.truth_latitude, one.error_m, one.geodesic_error_m) == (None, None, None)
            assert (one.latitude, one.longitude, one.fixed) == (other.latitude, other.longitude, other.fixed)
    with pytest.raises(InputError, match="a window lies around a known position"):
        flying({"window": 40.0}, aside_deg=math.nan)


def test_a_flight_beside_the_map_is_refused(flying: Any) -> None:
    with pytest.raises(InputError, match="no frame shows anything of the map: rendered"):
        flying({"window": 40.0}, aside_deg=1)


def test_what_was_learned_before_gives_the_same_fixes(run: FlightRun, flying: Any) -> None:
    again = flying({"window": 40.0}, known=run.learned, keys=["grey", "perspective-weightless"])
    assert again.learned == run.learned
    assert again.result.calibrated_on == run.result.calibrated_on
    assert (run.result.read_back, again.result.read_back) == (False, True)
    before, now = run.rows(run.result.searches[0]), again.rows(again.result.searches[0])
    assert list(now) == [
        "perspective-weightless",
        "grey",
        "perspective-weightless-track",
        "grey-track",
    ]
    for key, row in now.items():
        for one, other in zip(row.fixes, before[key].fixes, strict=True):
            assert replace(one, seconds=0) == replace(other, seconds=0)


def test_progress_is_told(run: FlightRun, flying: Any) -> None:
    steps = ["map", "conventions", "calibration", "thresholds", "frames"]
    assert list(dict.fromkeys(step for step, _, _ in flying.steps)) == steps
    assert flying.steps[-1] == ("frames", 3, 3)


def test_a_frame_s_processor_time_is_all_in_its_own_thread(flying: Any) -> None:
    before = cv2.getNumThreads()
    cv2.setNumThreads(2)
    try:
        flying({"window": 40.0})
        assert cv2.getNumThreads() == 2
    finally:
        cv2.setNumThreads(before)
    assert flying.threads[-3:] == [1, 1, 1]


@pytest.mark.slow
@pytest.mark.realdata
def test_weightless_edges_locate_the_real_flight(realdata: Path) -> None:
    """Half the best published mean over the whole map, on frames that nothing was fitted on."""
    folder = realdata / "flight_fengyuan"
    calibrating, scored = split(read_poses(folder / "poses.csv"), 10)
    recording = Recording.of_files(
        folder / "map.tif", frame_files((*scored[::2], *calibrating), folder / "frames"), 750.0
    ).scoring(scored[::2])
    found = run_flight(recording, calibrating, {"map": None}, lambda *_: None)
    row = found.rows(found.result.searches[0])["perspective-weightless"]
    assert row.mean_m is not None
    assert row.mean_m <= 18
    assert row.false_positive_percent == 0


def place(pose: Pose) -> tuple[str, float, float, float]:
    """All of a pose but its angles."""
    return pose.frame, pose.latitude_deg, pose.longitude_deg, pose.height_m


@pytest.mark.slow
@pytest.mark.realdata
@pytest.mark.parametrize(
    ("log", "named"),
    [
        (lambda pose: replace(pose, height_m=pose.height_m + 210), "is above sea level"),
        (lambda pose: replace(pose, height_m=pose.height_m / 0.3048), "is in feet"),
        (lambda pose: replace(pose, yaw_deg=-pose.yaw_deg), "counter-clockwise from north"),
        (lambda pose: replace(pose, yaw_deg=pose.yaw_deg - 180), "twist_deg = 180"),
        (lambda pose: Pose(*place(pose), math.radians(pose.yaw_deg)), "in radians"),
    ],
    ids=["sea level", "feet", "counter-clockwise", "backwards", "radians"],
)
def test_the_real_flight_in_another_convention_is_refused_by_name(
    realdata: Path, log: Callable[[Pose], Pose], named: str
) -> None:
    folder = realdata / "flight_fengyuan"
    calibrating, _ = split([log(pose) for pose in read_poses(folder / "poses.csv")], 10)
    files = frame_files(calibrating, folder / "frames")
    with pytest.raises(InputError, match=named):
        calibrated(Recording.of_files(folder / "map.tif", files, 750.0), calibrating, lambda *_: None)
