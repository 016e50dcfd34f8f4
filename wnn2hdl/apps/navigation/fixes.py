"""From matches to positions: which are given as fixes, how far they are off, and the track through them."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from wnn2hdl.apps.navigation.counter import frame_times
from wnn2hdl.apps.navigation.distance import geodesic_m, great_circle_m
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import Acceptance, Match, choose_threshold, peak_weights
from wnn2hdl.apps.navigation.navigator import Located
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.results import FAR_M, FrameFix
from wnn2hdl.apps.navigation.track import Fix, follow

UNCALIBRATED = Acceptance(0.0, 0.0, 1.0)
"""Without calibration frames the worth of a confidence is unknown, so every position is given."""

PRECISION = 0.95
"""Share of the fixes given that should be right: off by less than `FAR_M`."""

WRONG_M = 60.0
"""A peak this far from the truth is a wrong one, whatever else it is."""


def fixes(
    grid: MapGrid, poses: Sequence[Pose], located: Sequence[Located | None], acceptance: Acceptance
) -> tuple[FrameFix, ...]:
    """Each frame's best position; it is a fix if its confidence is accepted."""
    return tuple(
        _fix(
            grid, pose, at.places[0], at.match.confidence, acceptance.accepts(at.match.confidence), at.seconds
        )
        if at
        else _nothing(pose)
        for pose, at in zip(poses, located, strict=True)
    )


def accepted(grid: MapGrid, poses: Sequence[Pose], located: Sequence[Located | None]) -> Acceptance:
    """From which confidence on a fix is given, by frames whose position is known.

    What a match would have been worth without the peaks near the truth shows what a wrong match looks like.
    The threshold lies in the middle between the least confidence to be accepted and the next lower one of a
    wrong match, as nothing is known of what lies between them. Where no threshold is expected to make
    `PRECISION` of the fixes right, none are given.

    Matches below the threshold are doubted by as much as those of these frames were wrong, by Laplace's rule.
    """
    known = [(pose, at) for pose, at in zip(poses, located, strict=True) if at]
    if not known:
        return UNCALIBRATED
    errors, wrong = [], []
    for pose, at in known:
        pixel = grid.to_pixel(pose.latitude_deg, pose.longitude_deg)
        east, north = (float(axis) for axis in grid.to_metres(*pixel))
        misses = [float(np.hypot(one[0] - east, one[1] - north)) for one in at.places]
        errors.append(misses[0])
        peaks = tuple(peak for peak, miss in zip(at.match.peaks, misses, strict=True) if miss > WRONG_M)
        if peaks:
            wrong.append(Match(peaks, at.match.mean, at.match.std).confidence)
    confidences = [at.match.confidence for _, at in known]
    acceptance = choose_threshold(confidences, errors, wrong, precision=PRECISION)
    if acceptance.precision < PRECISION:
        return Acceptance(math.inf, 0.0, 0.0, _share_right(errors))
    missed = [confidence for confidence, error in zip(confidences, errors, strict=True) if error >= FAR_M]
    below = [confidence for confidence in (*wrong, *missed) if confidence < acceptance.threshold]
    middle = (acceptance.threshold + max(below)) / 2 if below else acceptance.threshold
    refused = [error for confidence, error in zip(confidences, errors, strict=True) if confidence < middle]
    return replace(acceptance, threshold=middle, doubted=_share_right(refused))


def _share_right(errors_m: Sequence[float]) -> float:
    return (sum(error < FAR_M for error in errors_m) + 1) / (len(errors_m) + 2)


def tracked(
    grid: MapGrid,
    poses: Sequence[Pose],
    located: Sequence[Located | None],
    acceptance: Acceptance,
    half_width_m: float | None,
) -> tuple[FrameFix, ...]:
    """The positions of a filter that takes all frames' peaks in turn, gated by confidence.

    Its confidence in a position is the probability that it is right, off by less than `FAR_M`; from
    `PRECISION` on the position is given as a fix. Where the filter knows nothing, before its
    start or when it has lost the track, or is outside the window that the UAV is known to be in, the position
    is that of the frame alone, and no fix is given.
    """
    offered = [
        [
            Fix(east, north, weight=weight * acceptance.trust(at.match.confidence))
            for (east, north), weight in zip(at.places, peak_weights(at.match), strict=True)
        ]
        if at
        else []
        for at in located
    ]
    area = float(grid.valid.sum()) * grid.gsd_m**2 if half_width_m is None else (2 * half_width_m) ** 2
    times = frame_times([pose.frame for pose in poses])
    points = follow(offered, times, area_m2=area, right_m=FAR_M)
    track = []
    for pose, at, point in zip(poses, located, points, strict=True):
        seconds = at.seconds if at else 0.0
        if point and _within(grid, pose, (point.east_m, point.north_m), half_width_m):
            place = point.east_m, point.north_m
            fixed = point.probability >= PRECISION
            track.append(_fix(grid, pose, place, point.probability, fixed, seconds))
        elif at:
            track.append(_fix(grid, pose, at.places[0], 0.0, False, seconds))
        else:
            track.append(_nothing(pose))
    return tuple(track)


def _within(grid: MapGrid, pose: Pose, place: tuple[float, float], half_width_m: float | None) -> bool:
    """Whether a place lies in the window around where a pose is logged."""
    if half_width_m is None:
        return True
    logged = grid.to_metres(*grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
    return all(abs(float(middle) - one) <= half_width_m for middle, one in zip(logged, place, strict=True))


def _fix(
    grid: MapGrid, pose: Pose, place: tuple[float, float], confidence: float, fixed: bool, seconds: float
) -> FrameFix:
    latitude, longitude = (float(axis) for axis in grid.to_geographic(*grid.from_metres(*place)))
    fix = replace(
        _nothing(pose),
        latitude=latitude,
        longitude=longitude,
        confidence=confidence,
        fixed=fixed,
        seconds=seconds,
    )
    if not pose.located:
        return fix
    ends = pose.latitude_deg, pose.longitude_deg, latitude, longitude
    return replace(fix, error_m=float(great_circle_m(*ends)), geodesic_error_m=float(geodesic_m(*ends)))


def _nothing(pose: Pose) -> FrameFix:
    latitude, longitude = (pose.latitude_deg, pose.longitude_deg) if pose.located else (None, None)
    return FrameFix(pose.frame, latitude, longitude, None, None, None, None, 0.0, False, 0.0)
