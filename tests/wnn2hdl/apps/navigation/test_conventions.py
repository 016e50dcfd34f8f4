"""Logs of a generated flight in others' conventions, recognised by their numbers alone."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.apps.navigation.conventions import (
    COUNTER_CLOCKWISE,
    FROM_EAST,
    RADIANS,
    Convention,
    may_be_radians,
    require_aircraft_angles,
    require_over_map,
)
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.recording import poses_of
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.errors import InputError
from wnn2hdl.samples.flight import Flight, make_flight


@pytest.fixture(scope="module")
def flight() -> Flight:
    return make_flight(0, (1600, 1600), frames=24, frame_size=(90, 160), height_m=50, spacing_m=40)


@pytest.fixture(scope="module")
def poses(flight: Flight) -> tuple[Pose, ...]:
    return poses_of(flight)


def logged_as(convention: Convention, poses: tuple[Pose, ...]) -> list[Pose]:
    """What a log in a convention holds, for those that are their own inverse."""
    return [convention.read(pose) for pose in poses]


def test_a_good_log_is_taken(poses: tuple[Pose, ...]) -> None:
    require_aircraft_angles(poses)
    require_aircraft_angles(poses[:1])


def test_a_log_without_positions_is_taken(poses: tuple[Pose, ...]) -> None:
    require_aircraft_angles(
        [
            replace(pose, yaw_deg=-pose.yaw_deg, latitude_deg=math.nan, longitude_deg=math.nan)
            for pose in poses
        ]
    )


def test_counter_clockwise_headings_are_named(poses: tuple[Pose, ...]) -> None:
    with pytest.raises(InputError, match="yaw_deg counts counter-clockwise from north, to judge by the pos"):
        require_aircraft_angles(logged_as(COUNTER_CLOCKWISE, poses))


def test_headings_from_east_are_named(poses: tuple[Pose, ...]) -> None:
    with pytest.raises(InputError, match="counter-clockwise from east"):
        require_aircraft_angles(logged_as(FROM_EAST, poses))


def test_radians_are_named(poses: tuple[Pose, ...]) -> None:
    logged = [
        replace(
            pose,
            yaw_deg=math.radians(pose.yaw_deg),
            pitch_deg=math.radians(pose.pitch_deg),
            roll_deg=math.radians(pose.roll_deg),
        )
        for pose in poses
    ]
    assert may_be_radians(logged)
    assert not may_be_radians(poses)
    assert RADIANS.read(logged[3]).yaw_deg == pytest.approx(poses[3].yaw_deg)
    with pytest.raises(InputError, match="in radians"):
        require_aircraft_angles(logged)


def test_an_aircraft_may_fly_in_any_direction_to_its_nose(poses: tuple[Pose, ...]) -> None:
    rng = np.random.default_rng(1)
    for headings in ([90.0] * len(poses), rng.uniform(-180, 180, len(poses))):
        require_aircraft_angles(
            [replace(pose, yaw_deg=yaw) for pose, yaw in zip(poses, headings, strict=True)]
        )
    require_aircraft_angles([replace(pose, yaw_deg=pose.yaw_deg % 360 - 180) for pose in poses])


def test_a_gimbal_s_angles_are_named(poses: tuple[Pose, ...]) -> None:
    for pitch in (-90.0, -80.0):
        with pytest.raises(InputError, match="a gimbal's, which is -90 where it looks straight down"):
            require_aircraft_angles([replace(pose, pitch_deg=pitch) for pose in poses])
    with pytest.raises(InputError, match="roll_deg is probably a gimbal's"):
        require_aircraft_angles([replace(pose, roll_deg=180.0) for pose in poses])


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        (lambda latitude, longitude: (longitude, latitude), "swapped"),
        (lambda latitude, longitude: (latitude, -longitude), "the longitude probably lacks its sign"),
        (lambda latitude, longitude: (-latitude, longitude), "the latitude probably lacks its sign"),
        (lambda latitude, longitude: (-latitude, -longitude), "both probably lack their signs"),
        (lambda latitude, longitude: (math.radians(latitude), math.radians(longitude)), "in radians"),
        (lambda latitude, longitude: (50.0, 7.0), "give the map of the country"),
    ],
)
def test_positions_beside_the_map_are_refused(
    flight: Flight, poses: tuple[Pose, ...], wrong: Callable[[float, float], tuple[float, float]], hint: str
) -> None:
    world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
    require_over_map(poses, world)
    require_over_map([Pose("a.jpg", math.nan, math.nan, 50, 0)], world)
    places = [wrong(pose.latitude_deg, pose.longitude_deg) for pose in poses]
    logged = [
        replace(pose, latitude_deg=latitude, longitude_deg=longitude)
        for pose, (latitude, longitude) in zip(poses, places, strict=True)
    ]
    with pytest.raises(InputError, match=f"no logged position is on the map.*{hint}"):
        require_over_map(logged, world)
