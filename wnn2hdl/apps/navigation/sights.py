"""Frames of a known place, looked for around it: how far beside the truth each matches the map."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.geometry import ground_patch
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import MapIndex, Window
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.progress import Progress

WINDOW_M = 60.0
"""How far a match may be from the truth: as much as 27 degrees of tilt make at 120 m."""

HEADINGS_DEG = tuple(float(error) for error in range(-60, 61, 6))
"""Errors of the logged heading that are tried; a match survives 3 degrees more or less."""


@dataclass(frozen=True)
class Sight:
    """A calibration frame's match.

    Attributes:
        ahead_m: the match is so far ahead of the truth, along the heading that fits best.
        right_m: so far to the right of it.
        heading_error_deg: what has to be added to the logged heading.
        score: normalised correlation of the grey levels.
        psr: standard deviations of the score above the mean of all positions in the window.
    """

    ahead_m: float
    right_m: float
    heading_error_deg: float
    score: float
    psr: float

    @property
    def miss_m(self) -> float:
        """Distance between match and truth."""
        return float(np.hypot(self.ahead_m, self.right_m))


@dataclass(frozen=True)
class Lookout:
    """Calibration frames and the map they are looked for on.

    Attributes:
        grid: the map's grid; it may be coarser than for matching.
        index: of its grey levels.
        frames: uint8 ``[height, width]`` each, grey.
        poses: of the frames, in the order of flight.
        looked: called whenever a frame has been looked for, by all headings of one camera.
    """

    grid: MapGrid
    index: MapIndex
    frames: Sequence[NDArray[np.uint8]]
    poses: Sequence[Pose]
    looked: Callable[[], None]

    def sight(
        self, number: int, camera: Camera, headings: Sequence[float], window_m: float = WINDOW_M
    ) -> Sight | None:
        """The best match of a frame over some errors of its heading; None if it shows nothing of the map.

        Raises:
            InputError: with such a pose and camera the frame shows no ground, or too much of it.
        """
        pose, best = self.poses[number], None
        row, column = (float(axis) for axis in self.grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
        for error in headings:
            turned = replace(pose, yaw_deg=pose.yaw_deg + error)
            patch = ground_patch(self.frames[number], turned, camera, self.grid.gsd_m)
            place = row - patch.nadir_row, column - patch.nadir_col
            window = Window.around(*place, window_m / self.grid.gsd_m)
            match = self.index.search(patch.image, patch.valid, "ncc", window)
            if match is None or (best is not None and match.score <= best.score):
                continue
            north, east = (place[0] - match.row) * patch.gsd_m, (match.col - place[1]) * patch.gsd_m
            course = np.radians(turned.yaw_deg + camera.twist_deg)
            ahead = north * np.cos(course) + east * np.sin(course)
            right = east * np.cos(course) - north * np.sin(course)
            best = Sight(float(ahead), float(right), error, match.score, match.psr)
        self.looked()
        return best

    def sights(self, cameras: Sequence[Camera], headings: Sequence[float]) -> list[Sight | None]:
        """The match of each frame with its own camera; errors as of `sight`."""
        return [self.sight(number, camera, headings) for number, camera in enumerate(cameras)]


def steps(progress: Progress, step: str, total: int) -> Callable[[], None]:
    """A function to call after each of ``total`` steps, to report them; further calls report the end."""
    progress(step, 0, total)
    done: Iterator[int] = iter(range(1, total + 1))
    return lambda: progress(step, next(done, total), total)
