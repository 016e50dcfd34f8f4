"""Where a UAV flies: a smooth way between random waypoints, and how wind shakes it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Track:
    """Places on a way, evenly spaced along it.

    Attributes:
        south: float64 ``[frames]``, metres from the room's north side.
        east: float64 ``[frames]``, metres from its west side.
        heading_deg: float64 ``[frames]``, the way's direction, clockwise from north.
    """

    south: NDArray[np.float64]
    east: NDArray[np.float64]
    heading_deg: NDArray[np.float64]


def fly_track(rng: np.random.Generator, room: NDArray[np.float64], frames: int, spacing_m: float) -> Track:
    """A way within a rectangle.

    Args:
        rng: where the waypoints come from.
        room: metres from north to south and from west to east.
        frames: places on it.
        spacing_m: metres along the way from one place to the next.
    """
    waypoints = [rng.uniform(0, 1, 2) * room, rng.uniform(0, 1, 2) * room]
    length = frames * spacing_m
    way = along = np.zeros(1)
    while along[-1] < length:
        candidates = rng.uniform(0, 1, (12, 2)) * room
        legs = candidates - waypoints[-1]
        far = np.linalg.norm(legs, axis=1)
        # The straightest way on, as far as the room lets one go.
        straight = legs @ (waypoints[-1] - waypoints[-2]) / np.maximum(far, 1e-9)
        waypoints.append(candidates[np.argmax(np.where(far > 0.35 * room.min(), straight, -np.inf))])
        way = _rounded(np.array(waypoints))
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    at = np.arange(frames) * spacing_m
    south, east = (np.interp(at, along, way[:, axis]) for axis in range(2))
    # A metre further on, or what is left of the last spacing.
    ahead = at + min(1.0, spacing_m / 2)
    southward, eastward = (
        np.interp(ahead, along, way[:, axis]) - here for axis, here in enumerate((south, east))
    )
    return Track(south, east, np.degrees(np.arctan2(eastward, -southward)))


def gusts(rng: np.random.Generator, frames: int) -> NDArray[np.float64]:
    """A number that wanders slowly around 0: float64 ``[frames]``, standard deviation 1, never beyond 2.5."""
    wander = np.empty(frames)
    last = rng.normal()
    for number in range(frames):
        last = 0.6 * last + 0.8 * rng.normal()
        wander[number] = last
    return wander.clip(-2.5, 2.5)


def _rounded(way: NDArray[np.float64]) -> NDArray[np.float64]:
    """A polygon's corners cut four times (Chaikin, 1974): a smooth curve in the limit."""
    for _ in range(4):
        way = np.stack([0.75 * way[:-1] + 0.25 * way[1:], 0.25 * way[:-1] + 0.75 * way[1:]], axis=1)
        way = way.reshape(-1, 2)
    return way
