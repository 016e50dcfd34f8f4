"""One frame located by several methods at once."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.geometry import Patch, ground_patch, rotated_patch
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import Match, Peak, Window
from wnn2hdl.apps.navigation.methods import Method
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.results import SearchKind

Place = tuple[SearchKind, str]
"""A search by its kind and a method by its key."""

P = ParamSpec("P")
T = TypeVar("T")

HEADING_STEP_DEG = 6.0
"""Between headings that are tried: a match survives half of it."""

SCALE_STEP = 0.04
"""Between heights that are tried: half of it moves an edge 60 m off the frame's middle by 1.2 m."""

APART_M = 20.0
"""Peaks are at least this far apart in rows or columns, metres; nearer ones are two sides of one peak."""


@dataclass(frozen=True)
class PoseTolerance:
    """How far the log may be off; the poses between are tried.

    Attributes:
        heading_deg: headings up to this far from the logged one, degrees.
        scale: heights up to this share above and below the logged one, which an error of the scale comes to.
    """

    heading_deg: float = 0.0
    scale: float = 0.0

    def poses(self, pose: Pose) -> tuple[Pose, ...]:
        """The poses to try for a logged one, this among them."""
        return tuple(
            replace(
                pose,
                yaw_deg=pose.yaw_deg + turn,
                height_m=pose.height_m * (1 + growth),
            )
            for turn in _steps(self.heading_deg, HEADING_STEP_DEG)
            for growth in _steps(self.scale, SCALE_STEP)
        )


def _steps(most: float, step: float) -> list[float]:
    """Multiples of a step that reach ``most`` on both sides of 0."""
    count = math.ceil(most / step - 1e-9)
    return [number * step for number in range(-count, count + 1)]


@dataclass(frozen=True)
class Located:
    """Where a method may put the UAV.

    Attributes:
        match: of the point below the UAV, in whole pixels of the method's grid; its peaks are the best over
            all poses and cameras that were tried.
        places: metres east and north of the map's middle, of each peak.
        seconds: processor time for laying the frame out, describing and searching, over all poses.
    """

    match: Match
    places: tuple[tuple[float, float], ...]
    seconds: float


EXACT = PoseTolerance()


class Navigator:
    """A map made ready for each method.

    Args:
        grids: the map by ground sample distance in metres; None for its own.
        methods: what is compared.
    """

    def __init__(self, grids: Mapping[float | None, MapGrid], methods: Sequence[Method]) -> None:
        self._grids = dict(grids)
        self._methods = tuple(methods)
        # Methods that describe the map alike share its index.
        ways = {(method.describe, method.index, method.gsd_m) for method in methods}
        indices = {
            (describe, index, gsd_m): index(*describe(grids[gsd_m].image, grids[gsd_m].valid))
            for describe, index, gsd_m in ways
        }
        self._indices = {
            method.key: indices[method.describe, method.index, method.gsd_m] for method in methods
        }

    def locate(
        self,
        frame: NDArray[np.uint8],
        pose: Pose,
        cameras: Sequence[Camera],
        windows: Mapping[SearchKind, tuple[float, float, float] | None],
        tolerance: PoseTolerance = EXACT,
    ) -> dict[Place, Located | None]:
        """Search for a frame.

        Args:
            frame: uint8 ``[height, width, 3]``.
            pose: its height and angles; its position is not looked at.
            cameras: any of which may have taken it; each is tried.
            windows: for each search by kind, latitude, longitude and half side in metres of the square in
                which the UAV is; None for the whole map.
            tolerance: how far the pose may be off.

        Returns:
            for each search and method, where the UAV is; None if the frame shows nothing to match, or has too
            little in common with what is searched of the map.
        """
        found: dict[Place, list[_Sight]] = {
            (search, method.key): [] for search in windows for method in self._methods
        }
        seconds = dict.fromkeys(found, 0.0)
        for camera, tried in product(cameras, tolerance.poses(pose)):
            laid = {
                (perspective, gsd_m): _timed(
                    ground_patch if perspective else rotated_patch,
                    frame,
                    tried,
                    camera,
                    self._grids[gsd_m].gsd_m,
                )
                for perspective, gsd_m in {(method.perspective, method.gsd_m) for method in self._methods}
            }
            for method in self._methods:
                patch, laying = laid[method.perspective, method.gsd_m]
                (picture, mask), describing = _timed(method.describe, patch.image, patch.valid)
                grid, index = self._grids[method.gsd_m], self._indices[method.key]
                apart = round(APART_M / grid.gsd_m)
                for search, area in windows.items():
                    place = search, method.key
                    window = None if area is None else _window(grid, patch, area)
                    match, searching = _timed(index.search, picture, mask, "ncc", window, exclusion=apart)
                    seconds[place] += laying + describing + searching
                    # A frame or a map without any structure correlates with nothing.
                    if match and match.score > 0:
                        found[place].append(_Sight(match, patch, grid))
        return {place: _best(sights, seconds[place]) if sights else None for place, sights in found.items()}


@dataclass(frozen=True)
class _Sight:
    """A match at one pose."""

    match: Match
    patch: Patch
    grid: MapGrid


def _window(grid: MapGrid, patch: Patch, area: tuple[float, float, float]) -> Window:
    row, column = (float(axis) for axis in grid.to_pixel(area[0], area[1]))
    return Window.around(row - patch.nadir_row, column - patch.nadir_col, area[2] / grid.gsd_m)


def _best(sights: Sequence[_Sight], seconds: float) -> Located:
    """One match of several poses': the best peaks of all, against the scores of all."""
    grid = sights[0].grid
    peaks = [
        (peak.score, peak.row + sight.patch.nadir_row, peak.col + sight.patch.nadir_col)
        for sight in sights
        for peak in sight.match.peaks
    ]
    kept: list[tuple[float, float, float]] = []
    for score, row, column in sorted(peaks, key=lambda peak: -peak[0]):
        if all(max(abs(row - one[1]), abs(column - one[2])) * grid.gsd_m > APART_M for one in kept):
            kept.append((score, row, column))
    kept = kept[: max(len(sight.match.peaks) for sight in sights)]
    means = np.array([sight.match.mean for sight in sights])
    variance = np.mean([sight.match.std**2 for sight in sights]) + means.var()
    match = Match(
        tuple(Peak(round(row), round(column), score) for score, row, column in kept),
        float(means.mean()),
        float(np.sqrt(variance)),
    )
    metres = (grid.to_metres(row, column) for _, row, column in kept)
    return Located(match, tuple((float(east), float(north)) for east, north in metres), seconds)


def _timed(function: Callable[P, T], *arguments: P.args, **options: P.kwargs) -> tuple[T, float]:
    """A result, and the processor time of this thread that it took."""
    started = time.thread_time()
    result = function(*arguments, **options)
    return result, time.thread_time() - started
