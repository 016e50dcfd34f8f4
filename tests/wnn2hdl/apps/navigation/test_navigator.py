"""Frames of a rendered flight, found on its map."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.methods import compared_methods
from wnn2hdl.apps.navigation.navigator import HEADING_STEP_DEG, SCALE_STEP, Located, Navigator, PoseTolerance
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.weightless import GSD_M, by_rule
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.samples.flight import Flight, make_flight


@pytest.fixture(scope="module")
def flight() -> Flight:
    return make_flight(2, (500, 500), frames=2, frame_size=(180, 320), height_m=60, tilt_deg=6)


@pytest.fixture(scope="module")
def grids(flight: Flight) -> dict[float | None, MapGrid]:
    world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
    return {None: world.resampled(), GSD_M: world.resampled(GSD_M)}


@pytest.fixture(scope="module")
def navigator(grids: dict[float | None, MapGrid]) -> Navigator:
    return Navigator(grids, compared_methods(by_rule()))


def seen(flight: Flight, yaw_error: float = 0) -> tuple[NDArray[np.uint8], Pose, Camera]:
    at, lens = flight.poses[0], flight.camera
    pose = Pose(
        at.frame,
        at.latitude_deg,
        at.longitude_deg,
        at.height_m,
        at.yaw_deg + yaw_error,
        at.pitch_deg,
        at.roll_deg,
    )
    return flight.frame(0), pose, Camera.of_focal(lens.focal_px, lens.width, lens.height, lens.tilt_deg)


def miss_m(grid: MapGrid, pose: Pose, located: Located | None) -> float:
    assert located is not None
    truth = grid.to_metres(*grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
    return float(np.hypot(located.places[0][0] - truth[0], located.places[0][1] - truth[1]))


def test_every_method_with_perspective_is_right_on_both_searches(
    flight: Flight, grids: dict[float | None, MapGrid], navigator: Navigator
) -> None:
    frame, pose, camera = seen(flight)
    window = (pose.latitude_deg, pose.longitude_deg, 60.0)
    found = navigator.locate(frame, pose, (camera,), {"window": window, "map": None})
    assert len(found) == 10
    for (search, method), located in found.items():
        if method != "rotation-canny":
            assert miss_m(grids[None], pose, located) < 2.5, (search, method)
    # Six degrees of tilt at 60 m, and the wind's pitch and roll.
    assert 3 < miss_m(grids[None], pose, found["map", "rotation-canny"]) < 20


def test_a_window_bounds_the_error(
    flight: Flight, grids: dict[float | None, MapGrid], navigator: Navigator
) -> None:
    frame, pose, camera = seen(flight)
    aside = grids[None].to_pixel(pose.latitude_deg, pose.longitude_deg)
    latitude, longitude = grids[None].to_geographic(aside[0] + 60, aside[1])
    found = navigator.locate(frame, pose, (camera,), {"window": (float(latitude), float(longitude), 10.0)})
    for located in found.values():
        assert located is None or 30 - 10 - 2 <= miss_m(grids[None], pose, located) <= 30 * 2


def test_a_wrong_heading_is_searched_for(
    flight: Flight, grids: dict[float | None, MapGrid], navigator: Navigator
) -> None:
    frame, pose, camera = seen(flight, yaw_error=17)
    window = (pose.latitude_deg, pose.longitude_deg, 60.0)
    found = navigator.locate(frame, pose, (camera,), {"window": window}, PoseTolerance(heading_deg=18))
    for method in ("perspective-weightless", "grey"):
        assert miss_m(grids[None], pose, found["window", method]) < 4


def test_a_frame_beside_the_map_is_not_located(
    flight: Flight, grids: dict[float | None, MapGrid], navigator: Navigator
) -> None:
    frame, pose, camera = seen(flight)
    found = navigator.locate(
        frame, pose, (camera,), {"window": (pose.latitude_deg + 1, pose.longitude_deg, 60.0)}
    )
    assert set(found.values()) == {None}


def test_a_frame_that_shows_nothing_is_not_located(flight: Flight, navigator: Navigator) -> None:
    _, pose, camera = seen(flight)
    blank = np.full((180, 320, 3), 90, np.uint8)
    window = (pose.latitude_deg, pose.longitude_deg, 60.0)
    found = navigator.locate(blank, pose, (camera,), {"window": window, "map": None})
    assert set(found.values()) == {None}


def test_a_wrong_height_is_searched_for(
    flight: Flight, grids: dict[float | None, MapGrid], navigator: Navigator
) -> None:
    frame, pose, camera = seen(flight)
    high = replace(pose, height_m=pose.height_m * 1.15)
    window = (pose.latitude_deg, pose.longitude_deg, 60.0)
    scores = []
    for tolerance in (PoseTolerance(), PoseTolerance(scale=0.15)):
        located = navigator.locate(frame, high, (camera,), {"window": window}, tolerance)["window", "grey"]
        assert located is not None
        scores.append(located.match.score)
    assert scores[1] > scores[0] + 0.1
    assert miss_m(grids[None], pose, located) < 4


def test_poses_to_try() -> None:
    pose = Pose("a", 0, 0, 50, 100)
    assert PoseTolerance().poses(pose) == (pose,)
    turned = PoseTolerance(heading_deg=HEADING_STEP_DEG + 1).poses(pose)
    assert [one.yaw_deg for one in turned] == [88, 94, 100, 106, 112]
    scaled = PoseTolerance(scale=SCALE_STEP).poses(pose)
    assert [one.height_m for one in scaled] == [48, 50, 52]
    assert len(PoseTolerance(2 * HEADING_STEP_DEG, 3 * SCALE_STEP).poses(pose)) == 5 * 7
