"""Unknowns of the camera, fitted on frames whose position is known and that are never scored.

Each calibration frame is laid on the ground with the camera as it is thought to be, and matched by grey
levels in a small window around where it was. What is left between match and truth, ahead and to the right, is
what the mount's angles have to explain; what scale and heading fit best, tell focal length and twist.

Two things that logs do not record are settled on the way: whether pitch and roll of the log reach the camera
at all (a gimbal may keep it level), and whether the tilt was set again in flight. The second is modelled as a
tilt that is constant over stretches of the flight.
"""

from bisect import bisect
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import MAX_TILT_DEG, Camera
from wnn2hdl.apps.navigation.counter import time_among
from wnn2hdl.apps.navigation.explain import require_fit, require_stated_meaning
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import MapIndex
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.sights import HEADINGS_DEG, WINDOW_M, Lookout, Sight, steps
from wnn2hdl.errors import InputError
from wnn2hdl.progress import Progress

HEADING_TOLERANCE_DEG = 6.0
"""Headings are searched if half of the log's or more are this much off their median error."""

SCALES = tuple(np.linspace(0.88, 1.12, 9).tolist())
"""Focal lengths that are tried, relative to the one given."""

MIN_FRAMES = 3
STRETCH_FRAMES = 3
"""Fewest calibration frames in a stretch with its own tilt."""

STRETCH_GAIN = 0.2
"""Another stretch must take away this part of the remaining error."""

_ROUNDS = 2


@dataclass(frozen=True)
class Fit:
    """How well calibration frames match the map where they were.

    Attributes:
        matched: frames that match at all.
        mean_miss_m: mean distance between match and truth.
        median_miss_m: its median.
        mean_score: mean normalised correlation of the grey levels.
    """

    matched: int
    mean_miss_m: float
    median_miss_m: float
    mean_score: float

    @classmethod
    def of(cls, sights: Sequence[Sight | None]) -> Self:
        """Of frames of which at least one matches."""
        seen = [sight for sight in sights if sight]
        misses = [sight.miss_m for sight in seen]
        return cls(
            len(seen),
            float(np.mean(misses)),
            float(np.median(misses)),
            float(np.mean([sight.score for sight in seen])),
        )


@dataclass(frozen=True)
class Calibration:
    """The fitted camera.

    Attributes:
        frames: the frames it was fitted on, in the order of the flight.
        cameras: the camera at each of these frames; they differ in tilt only.
        heading_search_deg: headings up to this much off the logged one have to be searched; 0 if the log
            is good.
        before: how the frames match with the camera as given.
        after: the same with the fitted one.
    """

    frames: tuple[str, ...]
    cameras: tuple[Camera, ...]
    heading_search_deg: float
    before: Fit
    after: Fit

    def cameras_at(self, frame: str) -> tuple[Camera, ...]:
        """The cameras that may have taken a frame: of the stretch it lies in; between two, of either.

        A frame's place follows from its name's number among those of the calibration's frames; if it does
        not, any of the cameras may have taken it.
        """
        if frame in self.frames:
            return (self.cameras[self.frames.index(frame)],)
        times = time_among(self.frames, frame)
        if times is None:
            return tuple(dict.fromkeys(self.cameras))
        after = bisect(*times)
        return tuple(dict.fromkeys(self.cameras[max(after - 1, 0) : after + 1]))

    @property
    def stretches(self) -> tuple[tuple[str, float], ...]:
        """First calibration frame and tilt in degrees of each stretch of the flight."""
        tilts = [camera.tilt_deg for camera in self.cameras]
        starts = [i for i, tilt in enumerate(tilts) if i == 0 or tilt != tilts[i - 1]]
        return tuple((self.frames[i], tilts[i]) for i in starts)

    def report(self) -> dict[str, Any]:
        """What was fitted and what it is worth, for JSON."""
        camera = self.cameras[0]
        return {
            "frames": list(self.frames),
            "focal_px": camera.fx,
            "stabilised": camera.stabilised,
            "lean_deg": camera.lean_deg,
            "twist_deg": camera.twist_deg,
            "tilts": [{"from_frame": frame, "tilt_deg": tilt} for frame, tilt in self.stretches],
            "heading_search_deg": self.heading_search_deg,
            "before": asdict(self.before),
            "after": asdict(self.after),
        }


def calibrate(
    grid: MapGrid,
    grey_map: NDArray[np.uint8],
    frames: Sequence[NDArray[np.uint8]],
    poses: Sequence[Pose],
    camera: Camera,
    progress: Progress,
) -> Calibration:
    """Fit gimbal, focal length, twist, lean and tilt.

    Args:
        grid: the map's grid; it may be coarser than for matching.
        grey_map: uint8, the grid's picture in grey.
        frames: uint8 ``[height, width]`` each, grey.
        poses: of the frames, at least `MIN_FRAMES`, in the order of flight.
        camera: first guess; its focal length good to 10 %.
        progress: called with how many of the frames have been looked for.

    Raises:
        InputError: too few frames, or most of them show nothing that is on the map; the log or the camera is
            probably given in another convention.
    """
    if len(poses) < MIN_FRAMES:
        raise InputError(
            f"calibration takes at least {MIN_FRAMES} frames",
            value=len(poses),
            hint="calibrate on more frames",
        )
    lookout = Lookout(grid, MapIndex(grey_map, grid.valid), frames, poses, lambda: None)
    require_stated_meaning(lookout, camera, progress)
    passes = 5 + _ROUNDS * (1 + len(SCALES))
    fit = _Fitting(replace(lookout, looked=steps(progress, "calibration", passes * len(poses))))

    sights = fit.lookout.sights([camera] * len(poses), HEADINGS_DEG)
    errors = np.array([sight.heading_error_deg for sight in sights if sight])
    typical = float(np.median(np.abs(errors - np.median(errors)))) if errors.size else 0.0
    free_heading = typical >= HEADING_TOLERANCE_DEG
    logged = HEADINGS_DEG if free_heading else (0.0,)
    guesses = []
    for stabilised in (False, True):
        cameras = [replace(camera, stabilised=stabilised)] * len(poses)
        sights = fit.lookout.sights(cameras, logged)
        guesses.append((fit.spread(sights), cameras, sights))
    before = guesses[camera.stabilised][2]
    _, cameras, _ = min(guesses, key=lambda each: each[0])
    for _ in range(_ROUNDS):
        sights = fit.lookout.sights(cameras, HEADINGS_DEG if free_heading else (-3.0, 0.0, 3.0))
        cameras = fit.mounted(cameras, sights)
        headings = [sight.heading_error_deg if sight and free_heading else 0.0 for sight in sights]
        cameras = fit.scaled(cameras, headings)
    cameras = fit.mounted(cameras, fit.lookout.sights(cameras, logged))
    after = fit.lookout.sights(cameras, logged)
    require_fit(after)
    return Calibration(
        tuple(pose.frame for pose in poses),
        tuple(cameras),
        float(np.ceil(typical / 6) * 18) if free_heading else 0.0,
        Fit.of(before),
        Fit.of(after),
    )


@dataclass(frozen=True)
class _Fitting:
    lookout: Lookout

    def spread(self, sights: Sequence[Sight | None]) -> float:
        """What no mount explains: how far, typically, matches are from the middle of their stretch."""
        seen = [sight for sight in sights if sight]
        if len(seen) < MIN_FRAMES:
            raise InputError(
                "too few calibration frames match the map",
                value=f"{len(seen)} of {len(sights)}",
                hint="calibrate on frames that the map shows, or correct their positions",
            )
        ahead, right = (np.array([getattr(sight, name) for sight in seen]) for name in ("ahead_m", "right_m"))
        return float(np.median(np.abs(ahead - _steps(ahead))) + np.median(np.abs(right - np.median(right))))

    def mounted(self, cameras: Sequence[Camera], sights: Sequence[Sight | None]) -> list[Camera]:
        """Cameras whose tilt, by stretches, lean and twist explain what the matches are off."""
        self.spread(sights)
        seen = [i for i, sight in enumerate(sights) if sight]
        tilts, leans, twists = [], [], []
        for i in seen:
            sight = sights[i]
            assert sight is not None
            height = self.lookout.poses[i].height_m
            tilts.append(cameras[i].tilt_deg + np.degrees(np.arctan2(sight.ahead_m, height)))
            leans.append(cameras[i].lean_deg - np.degrees(np.arctan2(sight.right_m, height)))
            twists.append(cameras[i].twist_deg + sight.heading_error_deg)
        tilt = np.clip(_steps(np.array(tilts)), -MAX_TILT_DEG / 2, MAX_TILT_DEG / 2)
        lean = float(np.clip(np.median(leans), -MAX_TILT_DEG / 2, MAX_TILT_DEG / 2))
        nearest = [int(np.argmin(np.abs(np.array(seen) - i))) for i in range(len(cameras))]
        return [
            replace(camera, tilt_deg=float(tilt[near]), lean_deg=lean, twist_deg=float(np.median(twists)))
            for camera, near in zip(cameras, nearest, strict=True)
        ]

    def scaled(self, cameras: Sequence[Camera], headings: Sequence[float]) -> list[Camera]:
        """Cameras of the focal length whose patches fit the map best."""
        scores = []
        for scale in SCALES:
            sights = [
                self.lookout.sight(
                    i, replace(camera, fx=camera.fx * scale, fy=camera.fy * scale), [heading], WINDOW_M / 3
                )
                for i, (camera, heading) in enumerate(zip(cameras, headings, strict=True))
            ]
            scores.append(float(np.mean([sight.score if sight else 0.0 for sight in sights])))
        best = int(np.argmax(scores))
        scale = SCALES[best]
        if 0 < best < len(SCALES) - 1:
            low, middle, high = scores[best - 1 : best + 2]
            step = SCALES[1] - SCALES[0]
            scale += step * (low - high) / (2 * (low - 2 * middle + high))
        return [replace(camera, fx=camera.fx * scale, fy=camera.fy * scale) for camera in cameras]


def _steps(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """A sequence as constant stretches: their medians, one stretch more as long as each pays."""
    bounds = [0, len(values)]

    def model(bounds: list[int]) -> NDArray[np.float64]:
        parts = [np.full(j - i, np.median(values[i:j])) for i, j in pairwise(bounds)]
        return np.concatenate(parts)

    def cost(bounds: list[int]) -> float:
        return float(np.abs(values - model(bounds)).sum())

    # Each round adds a bound; there is room for no more.
    for _ in range(len(values) // STRETCH_FRAMES):
        finer = [
            sorted([*bounds, cut])
            for i, j in pairwise(bounds)
            for cut in range(i + STRETCH_FRAMES, j - STRETCH_FRAMES + 1)
        ]
        best = min(finer, key=cost, default=bounds)
        if cost(best) >= (1 - STRETCH_GAIN) * cost(bounds):
            break
        bounds = best
    return model(bounds)
