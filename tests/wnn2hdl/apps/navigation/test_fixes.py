"""Positions, which of them are given, and the track."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.fixes import UNCALIBRATED, accepted, fixes, tracked
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import Acceptance, Match, Peak
from wnn2hdl.apps.navigation.navigator import Located
from wnn2hdl.apps.navigation.poses import Pose

GRID = MapGrid(
    np.zeros((1000, 1000, 3), np.uint8), np.ones((1000, 1000), np.bool_), 1.0, (-500.0, 500.0), 24.0, 120.0
)


def pose(east: float, north: float, number: int = 0) -> Pose:
    latitude, longitude = GRID.to_geographic(*GRID.from_metres(east, north))
    return Pose(f"f{number}.jpg", float(latitude), float(longitude), 100, 0)


def located(*places: tuple[float, float], heights: tuple[float, ...]) -> Located:
    """Peaks at metres east and north, these standard deviations above the mean."""
    peaks = (
        Peak(round(-north), round(east), height)
        for (east, north), height in zip(places, heights, strict=True)
    )
    return Located(Match(tuple(peaks), 0.0, 1.0), places, 0.25)


def test_a_position_and_how_far_it_is_off() -> None:
    found = fixes(GRID, [pose(100, 50)], [located((130, 10), heights=(6,))], Acceptance(5, 1, 1))[0]
    assert found.error_m == pytest.approx(50, abs=0.3)
    assert found.geodesic_error_m == pytest.approx(50, abs=0.001)
    assert found.fixed
    assert found.seconds == 0.25


def test_no_fix_below_the_threshold_and_none_without_a_match() -> None:
    poses = [pose(0, 0), pose(0, 0)]
    doubtful, nothing = fixes(GRID, poses, [located((0, 0), heights=(4,)), None], Acceptance(9, 1, 1))
    assert not doubtful.fixed
    assert doubtful.error_m == pytest.approx(0, abs=1e-6)
    assert nothing.latitude is None
    assert not nothing.fixed


def test_the_threshold_parts_right_from_wrong() -> None:
    poses = [pose(0, 0)] * 12
    right = [located((1, 1), (300, 300), heights=(9, 3))] * 10
    wrong = [located((200, 200), (-300, 300), heights=(4, 3.9))] * 2
    acceptance = accepted(GRID, poses, [*right, *wrong])
    assert acceptance.accepts(right[0].match.confidence)
    assert not acceptance.accepts(wrong[0].match.confidence)
    assert acceptance.doubted == (0 + 1) / (2 + 2)


def test_the_threshold_lies_between_wrong_and_right() -> None:
    right = located(
        (1, 1), (300, 300), (-300, -300), heights=(12, 4, 3)
    )  # 20 with its margin, 5 without the truth
    acceptance = accepted(GRID, [pose(0, 0)] * 12, [right] * 12)
    assert acceptance.threshold == pytest.approx((20 + 5) / 2)


def test_no_fix_is_given_where_confidence_tells_nothing() -> None:
    right = located((1, 1), (300, 300), heights=(5, 4))
    wrong = located((300, 300), (1, 1), heights=(5, 4))
    acceptance = accepted(GRID, [pose(0, 0)] * 10, [right, wrong] * 5)
    assert not acceptance.accepts(1e9)
    assert acceptance.doubted == (5 + 1) / (10 + 2)


def test_without_matches_every_position_is_given() -> None:
    assert accepted(GRID, [], []).accepts(0.0)
    assert accepted(GRID, [pose(0, 0)], [None]).accepts(0.0)


def test_a_track_overrules_a_stray_match() -> None:
    poses = [pose(20 * i, 0, i) for i in range(10)]
    matches: list[Located | None] = [located((20.0 * i, 0.0), heights=(8,)) for i in range(10)]
    matches[6] = located((-300.0, 300.0), (121.0, 1.0), heights=(5, 4.8))
    matches[8] = None
    track = tracked(GRID, poses, matches, UNCALIBRATED, None)
    assert track[6].error_m is not None
    assert track[6].error_m < 20
    assert track[8].error_m is not None
    assert track[8].error_m < 40
    alone = fixes(GRID, poses, matches, Acceptance(0, 1, 1))
    assert alone[6].error_m == pytest.approx(np.hypot(420, 300), rel=0.01)


def test_a_track_through_doubtful_matches_is_no_fix_until_they_agree() -> None:
    poses = [pose(20 * i, 0, i) for i in range(9)]
    doubtful: list[Located | None] = [
        located((20.0 * i, 0.0), (300.0 - 90 * (i % 5), 300.0 * (-1) ** i), heights=(4.5, 4.2))
        for i in range(9)
    ]
    track = tracked(GRID, poses, doubtful, UNCALIBRATED, None)
    assert not track[0].fixed
    assert track[8].fixed
    assert 0 <= track[0].confidence < track[8].confidence <= 1


def test_a_track_through_matches_below_the_threshold_is_believed_less() -> None:
    poses = [pose(20 * i, 0, i) for i in range(4)]
    matches = [located((20.0 * i, 0.0), (300.0, 300.0 * (-1) ** i), heights=(6, 3)) for i in range(4)]
    believed, doubted = (
        tracked(GRID, poses, matches, acceptance, None)
        for acceptance in (Acceptance(5, 1, 1, 0.3), Acceptance(50, 1, 1, 0.3))
    )
    assert believed[0].fixed
    assert not doubted[0].fixed
    assert doubted[0].confidence < doubted[3].confidence < believed[3].confidence


def test_a_track_that_starts_at_a_wrong_match_is_no_fix() -> None:
    rng = np.random.default_rng(0)
    poses = [pose(0, 0, 9 * i) for i in range(12)]
    strays: list[Located | None] = [
        located(*map(tuple, rng.uniform(-480, 480, (3, 2))), heights=(4.4, 4.2, 4.1)) for _ in poses
    ]
    for half_width_m in (None, 95.0):
        assert not any(fix.fixed for fix in tracked(GRID, poses, strays, UNCALIBRATED, half_width_m))


def test_a_track_does_not_leave_the_window_that_the_uav_is_in() -> None:
    poses = [pose(20 * i, 0, i) for i in range(6)]
    aside: list[Located | None] = [located((20.0 * i, 0.0), heights=(8,)) for i in range(5)]
    track = tracked(GRID, [*poses[:5], pose(300, 0, 5)], [*aside, None], UNCALIBRATED, 95.0)
    assert track[4].error_m == pytest.approx(0, abs=1)
    assert track[5].latitude is None
    whole = tracked(GRID, [*poses[:5], pose(300, 0, 5)], [*aside, None], UNCALIBRATED, None)
    assert whole[5].error_m == pytest.approx(200, abs=20)
