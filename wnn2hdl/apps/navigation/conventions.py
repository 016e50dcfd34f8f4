"""Other conventions for the log of a flight, recognised by the numbers alone: refused by name, never adopted.

What only pictures show is in `wnn2hdl.apps.navigation.explain`.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.distance import course_deg, geodesic_m
from wnn2hdl.apps.navigation.geometry import MAX_OBLIQUE_DEG
from wnn2hdl.apps.navigation.poses import Pose, read_poses
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.errors import InputError

GIMBAL_PITCH_DEG = 40.0
"""Half of a flight's frames or more beyond it: no aircraft flies so, but a gimbal's pitch is -90 below it."""

GIMBAL_ROLL_DEG = 90.0
"""The same for roll: no aircraft flies on its back."""

LEG_M = 5.0
"""From frame to frame: shorter legs have no course that a receiver of positions could measure."""

LEGS = 8
"""Fewest that decide."""

ALONG_DEG = 30.0
"""A heading is along the course if it is less than this off, as wind and turns make it."""


FEW, MOST = 0.4, 0.75
"""Shares of the legs: few along the stated headings and most along those of another convention decide."""


@dataclass(frozen=True)
class Convention:
    """Another meaning of a log's numbers.

    Attributes:
        fault: what the numbers probably are: "yaw_deg counts counter-clockwise from north".
        hint: what to do about it.
        read: the pose as it is meant, of the pose as it is logged.
    """

    fault: str
    hint: str
    read: Callable[[Pose], Pose]


COUNTER_CLOCKWISE = Convention(
    "yaw_deg counts counter-clockwise from north",
    "give headings clockwise from north: 360 minus each",
    lambda pose: replace(pose, yaw_deg=-pose.yaw_deg),
)
FROM_EAST = Convention(
    "yaw_deg counts counter-clockwise from east",
    "give headings clockwise from north: 90 minus each",
    lambda pose: replace(pose, yaw_deg=90 - pose.yaw_deg),
)
RADIANS = Convention(
    "yaw_deg, pitch_deg and roll_deg are in radians",
    "give degrees",
    lambda pose: replace(
        pose,
        yaw_deg=math.degrees(pose.yaw_deg),
        pitch_deg=math.degrees(pose.pitch_deg),
        roll_deg=math.degrees(pose.roll_deg),
    ),
)


def may_be_radians(poses: Sequence[Pose]) -> bool:
    """Whether no angle is beyond a full turn in radians."""
    return all(
        abs(pose.yaw_deg) <= 2 * math.pi and max(abs(pose.pitch_deg), abs(pose.roll_deg)) <= math.pi
        for pose in poses
    )


def read_flight_poses(path: Path) -> tuple[Pose, ...]:
    """The poses of a log whose angles are an aircraft's.

    Raises:
        InputError: as `read_poses` and `require_aircraft_angles`.
    """
    poses = read_poses(path)
    require_aircraft_angles(poses)
    return poses


def require_aircraft_angles(poses: Sequence[Pose]) -> None:
    """Refuse angles of a gimbal, and headings along whose other meaning the aircraft flies.

    Args:
        poses: in the order of flight.

    Raises:
        ExtraMissingError: pyproj is not installed.
        InputError: so many pitch or roll angles are beyond an aircraft's that they must be a gimbal's; or the
            aircraft flies along few of its headings, and along most as another convention counts them.
    """
    pitch = float(np.median([abs(pose.pitch_deg) for pose in poses]))
    if pitch > GIMBAL_PITCH_DEG:
        raise InputError(
            "pitch_deg is probably a gimbal's, which is -90 where it looks straight down",
            value=f"{pitch:g} degrees in the median",
            hint="give the aircraft's, 0 for level flight, and the camera's tilt_deg from straight down",
        )
    roll = float(np.median([abs(pose.roll_deg) for pose in poses]))
    if roll > GIMBAL_ROLL_DEG:
        raise InputError(
            "roll_deg is probably a gimbal's",
            value=f"{roll:g} degrees in the median",
            hint="give the aircraft's, 0 for level flight",
        )
    legs = [
        (one, other)
        for one, other in pairwise(poses)
        if one.located and other.located and _length_m(one, other) >= LEG_M
    ]
    if len(legs) < LEGS:
        return
    courses = np.array([float(course_deg(*_place(one), *_place(other))) for one, other in legs])
    # Of a flight straight on, any heading may be meant: the camera may look anywhere.
    if abs(np.exp(1j * np.radians(courses)).mean()) > 0.9 or _share_along(courses, legs) > FEW:
        return
    others = [COUNTER_CLOCKWISE, FROM_EAST, *([RADIANS] if may_be_radians(poses) else [])]
    for other in others:
        share = _share_along(courses, [(other.read(one), other.read(two)) for one, two in legs])
        if share >= MOST:
            raise InputError(
                f"{other.fault}, to judge by the positions",
                value=f"{share:.0%} of the legs are flown along such headings, and "
                f"{_share_along(courses, legs):.0%} along the logged ones",
                hint=other.hint,
            )


def require_over_map(poses: Sequence[Pose], world: WorldMap) -> None:
    """Refuse positions none of which lies on the map; those that are not known are left out.

    Raises:
        InputError: none is so near to the map that its frame could show some of it.
    """
    known = [pose for pose in poses if pose.located]
    if not known:
        return
    reach = math.tan(math.radians(MAX_OBLIQUE_DEG)) * max(pose.height_m for pose in known) / world.gsd_m

    def near(latitude: float, longitude: float) -> bool:
        return all(
            -reach <= axis <= length + reach
            for axis, length in zip(world.to_pixel(latitude, longitude), world.shape, strict=True)
        )

    places = [(pose.latitude_deg, pose.longitude_deg) for pose in known]
    if any(near(*place) for place in places):
        return
    latitude, longitude = places[0]
    meanings = {
        "latitude and longitude are probably swapped": (longitude, latitude),
        "they are probably in radians": (math.degrees(latitude), math.degrees(longitude)),
        "the longitude probably lacks its sign: west is negative": (latitude, -longitude),
        "the latitude probably lacks its sign: south is negative": (-latitude, longitude),
        "both probably lack their signs: south and west are negative": (-latitude, -longitude),
    }
    meant = [meaning for meaning, (north, east) in meanings.items() if abs(north) <= 90 and near(north, east)]
    raise InputError(
        "no logged position is on the map",
        value=f"latitude {latitude:g}, longitude {longitude:g}",
        hint=meant[0] if meant else "give the map of the country flown over, or correct the positions",
    )


def _place(pose: Pose) -> tuple[float, float]:
    return pose.latitude_deg, pose.longitude_deg


def _length_m(one: Pose, other: Pose) -> float:
    return float(geodesic_m(*_place(one), *_place(other)))


def _share_along(courses: NDArray[np.float64], legs: Sequence[tuple[Pose, Pose]]) -> float:
    """Share of the legs along the heading at their start or at their end."""
    headings = np.array([[one.yaw_deg, other.yaw_deg] for one, other in legs])
    off = np.abs((courses[:, None] - headings + 180) % 360 - 180).min(axis=1)
    return float(np.mean(off < ALONG_DEG))
