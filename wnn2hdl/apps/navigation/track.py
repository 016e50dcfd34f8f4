"""A UAV has a past: a constant-velocity Kalman filter over the fixes of a flight.

The filter keeps several hypotheses of which fixes were right (multiple hypothesis tracking: D. B. Reid, IEEE
Trans. Automatic Control 24 (6), 1979). Each frame offers some fixes, the best positions of its search; a
hypothesis takes one of them, or none, and is weighted by how well it had predicted it. So a wrong fix at the
start does not mislead forever, and the second best position of a frame may be the one that fits the track. A
hypothesis that has taken nothing for so long that it knows nothing better than the whole area starts again;
and any may have been wrong all along, and start again at a fix.
Nothing looks into the future: the position of a frame follows from it and the frames before.
"""

import math
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.special import chndtr

from wnn2hdl.apps.navigation.results import FAR_M
from wnn2hdl.errors import InputError, extra_needed

GATE = 13.8
"""Squared Mahalanobis distance beyond which a fix does not belong to a track: 1 in 1000 right ones does."""

HYPOTHESES = 30
"""Hypotheses that are kept from frame to frame."""

RESTART = 0.02
"""How likely a track that has been followed was wrong: then the next fix is as good a start as the first was.

At 0.005 to 0.05 two real flights come out alike; without, a track that has settled on a wrong place stays.
"""

SPEED_STD_M = 60.0
"""Standard deviation of either component of the velocity before anything is known, metres per unit of
time."""


@dataclass(frozen=True)
class Fix:
    """One position that a frame's search offers.

    Attributes:
        east_m: in local metres.
        north_m: in local metres.
        std_m: standard deviation of a right fix in either direction.
        weight: how likely this fix is the right one of its frame, 0 to 1. The weights of a frame's fixes
            sum to at most 1; the rest is the chance that none is right.
    """

    east_m: float
    north_m: float
    std_m: float = 15.0
    weight: float = 0.7


@dataclass(frozen=True)
class TrackPoint:
    """Where the filter believes the UAV is.

    Attributes:
        east_m: in local metres.
        north_m: in local metres.
        std_m: standard deviation of the position, root mean square of the two directions, if the likeliest
            hypothesis is the right one.
        probability: that the UAV is less than `follow`'s ``right_m`` from here, over all hypotheses.
        taken: which of the frame's fixes was taken; None if none was.
    """

    east_m: float
    north_m: float
    std_m: float
    probability: float
    taken: int | None


@dataclass(frozen=True, eq=False)
class _Hypothesis:
    """A filter, None before its first fix, the logarithm of its weight, and the fix it took last."""

    kalman: Any
    weight: float
    taken: int | None


def follow(
    frames: Sequence[Sequence[Fix]],
    times: Sequence[float] | None = None,
    *,
    acceleration_m: float = 15.0,
    area_m2: float = 1e6,
    right_m: float = FAR_M,
) -> list[TrackPoint | None]:
    """Filter the fixes of a flight.

    Args:
        frames: what each frame's search offers, in the order of flight; nothing where there is no fix.
        times: when each frame was taken, not falling, in any unit, as `counter.frame_times`;
            one unit apart if not given.
        acceleration_m: standard deviation of the acceleration, metres per squared unit of time. The default
            is that of two real flights whose unit is the number in a frame's name (9 and 18, measured).
        area_m2: area over which wrong fixes scatter: that of the map, or of the search window.
        right_m: how near to the truth a position must be to count as right, metres.

    Returns:
        for each frame the position of the likeliest hypothesis; None before the first fix, and
        when the track has become vaguer than the area.

    Raises:
        ExtraMissingError: filterpy is not installed.
        InputError: times do not fit the frames, or weights are not shares.
    """
    times = list(range(len(frames))) if times is None else times
    if len(times) != len(frames) or any(later < sooner for sooner, later in pairwise(times)):
        raise InputError("the times are not those of the frames in the order of flight", value=list(times))
    hypotheses = [_Hypothesis(None, 0.0, None)]
    points: list[TrackPoint | None] = []
    last = times[0] if times else 0.0
    for fixes, now in zip(frames, times, strict=True):
        missed = 1.0 - sum(fix.weight for fix in fixes)
        if missed < -1e-9 or any(fix.weight < 0 for fix in fixes):
            raise InputError(
                "a frame's fixes have weights that sum to more than 1, or are negative", value=list(fixes)
            )
        hypotheses = [_moved(hypothesis, now - last, acceleration_m, area_m2) for hypothesis in hypotheses]
        last = now
        # Never quite 0: a filter that has lost its way must be able to continue.
        nothing = math.log(max(missed, 0.01) / area_m2)
        branches = [
            branch for hypothesis in hypotheses for branch in _branches(hypothesis, fixes, nothing, area_m2)
        ]
        branches.sort(key=lambda branch: -branch.weight)
        hypotheses = branches[:HYPOTHESES]
        points.append(_point(hypotheses, right_m))
    return points


def _branches(
    hypothesis: _Hypothesis, fixes: Sequence[Fix], nothing: float, area_m2: float
) -> Iterator[_Hypothesis]:
    """What can become of a hypothesis: it takes one of the fixes, or starts again at it, or takes none."""
    yield _Hypothesis(hypothesis.kalman, hypothesis.weight + nothing, None)
    for number, fix in enumerate(fixes):
        if not fix.weight:
            continue
        restart = math.log(fix.weight / area_m2)
        if hypothesis.kalman is None:
            yield _Hypothesis(_start(fix), hypothesis.weight + restart, number)
            continue
        yield _Hypothesis(_start(fix), hypothesis.weight + math.log(RESTART) + restart, number)
        kalman = deepcopy(hypothesis.kalman)
        kalman.update(np.array([[fix.east_m], [fix.north_m]]), R=np.eye(2) * fix.std_m**2)
        distance = float((kalman.y.T @ kalman.SI @ kalman.y).item())
        if distance <= GATE:
            density = -0.5 * distance - math.log(2 * math.pi) - 0.5 * math.log(np.linalg.det(kalman.S))
            yield _Hypothesis(kalman, hypothesis.weight + math.log(fix.weight) + density, number)


def _start(fix: Fix) -> Any:
    """A filter of the state (east, east velocity, north, north velocity) that stands at a fix."""
    with extra_needed("geo", "the track filter needs filterpy"):
        from filterpy.kalman import KalmanFilter
    kalman = KalmanFilter(dim_x=4, dim_z=2)
    kalman.x = np.array([[fix.east_m], [0.0], [fix.north_m], [0.0]])
    kalman.P = np.diag([fix.std_m**2, SPEED_STD_M**2, fix.std_m**2, SPEED_STD_M**2])
    kalman.H = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    return kalman


def _moved(hypothesis: _Hypothesis, elapsed: float, acceleration_m: float, area_m2: float) -> _Hypothesis:
    """The hypothesis at a later time; without a track if that has become vaguer than the whole area."""
    kalman = hypothesis.kalman
    if kalman is None:
        return hypothesis
    # White noise on the acceleration, constant over a step: covariance of (position, velocity) of one axis.
    gain = np.array([[elapsed**2 / 2], [elapsed]])
    noise = gain @ gain.T * acceleration_m**2
    move = np.array([[1.0, elapsed], [0.0, 1.0]])
    kalman.predict(F=np.kron(np.eye(2), move), Q=np.kron(np.eye(2), noise))
    lost = 2 * math.pi * math.sqrt(kalman.P[0, 0] * kalman.P[2, 2]) > area_m2
    return replace(hypothesis, kalman=None) if lost else hypothesis


def _point(hypotheses: Sequence[_Hypothesis], right_m: float) -> TrackPoint | None:
    """The likeliest hypothesis, which is the first."""
    best = hypotheses[0]
    if best.kalman is None:
        return None
    east, north, spread = _position(best.kalman)
    weights = np.exp([hypothesis.weight - best.weight for hypothesis in hypotheses])
    near = np.zeros(len(hypotheses))
    for number, kalman in enumerate(hypothesis.kalman for hypothesis in hypotheses):
        # A hypothesis without a position says nothing about this one.
        if kalman is not None:
            other_east, other_north, std = _position(kalman)
            apart = math.hypot(other_east - east, other_north - north)
            # The squared distance of a circular normal distribution from a point beside its middle.
            near[number] = chndtr((right_m / std) ** 2, 2, (apart / std) ** 2)
    return TrackPoint(east, north, spread, float(near @ weights / weights.sum()), best.taken)


def _position(kalman: Any) -> tuple[float, float, float]:
    """East, north, and the root mean square of their two standard deviations."""
    state, covariance = kalman.x, kalman.P
    return float(state[0, 0]), float(state[2, 0]), math.sqrt((covariance[0, 0] + covariance[2, 2]) / 2)
