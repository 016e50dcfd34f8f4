"""The track filter beats the raw fixes, finds back, and never looks ahead."""

import sys

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.track import Fix, TrackPoint, follow
from wnn2hdl.errors import ExtraMissingError, InputError

AREA = 1500.0**2


def flight(seed: int, frames: int = 60) -> NDArray[np.float64]:
    """A path of 40 m per step that turns slowly, and once at a right angle; metres ``[frames, 2]``."""
    rng = np.random.default_rng(seed)
    heading = np.cumsum(rng.normal(0, 0.06, frames)) + np.pi / 2 * (np.arange(frames) > frames // 2)
    return np.cumsum(40 * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0)


def fix(place: NDArray[np.float64], std_m: float, weight: float) -> Fix:
    return Fix(float(place[0]), float(place[1]), std_m, weight)


def searches(path: NDArray[np.float64], seed: int, wrong: float) -> list[list[Fix]]:
    """Each frame's best positions: the first wrong at times, the right one then second in half of those."""
    rng = np.random.default_rng(seed)
    frames = []
    for place in path:
        right = fix(place + rng.normal(0, 12, 2), 12.0, 0.6)
        stray = [fix(rng.uniform(-700, 700, 2) + path.mean(axis=0), 12.0, weight) for weight in (0.6, 0.2)]
        if rng.random() >= wrong:
            frames.append([right, stray[1]])
        else:
            second = Fix(right.east_m, right.north_m, 12.0, 0.2)
            frames.append([stray[0], second if rng.random() < 0.5 else stray[1]])
    return frames


def errors(points: list[TrackPoint | None], path: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array(
        [
            np.hypot(point.east_m - east, point.north_m - north)
            for point, (east, north) in zip(points, path, strict=True)
            if point is not None
        ]
    )


@pytest.mark.parametrize("seed", range(3))
def test_the_track_is_nearer_to_the_truth_than_the_fixes(seed: int) -> None:
    path = flight(seed)
    frames = searches(path, seed, wrong=0.3)
    raw = np.hypot(*(np.array([[fixes[0].east_m, fixes[0].north_m] for fixes in frames]) - path).T)
    filtered = errors(follow(frames, area_m2=AREA), path)
    assert len(filtered) == len(path)
    assert filtered.mean() < raw.mean() / 3
    assert np.mean(filtered[5:] < 100) > np.mean(raw < 100)
    assert np.mean(filtered[5:] < 100) > 0.95


def test_it_recovers_from_wrong_fixes_at_the_start() -> None:
    path = flight(7, 30)
    frames = [[fix(place, 12.0, 0.9)] for place in path]
    for number in range(3):
        frames[number] = [Fix(900.0 + 5 * number, -900.0, 12.0, 0.9)]
    assert errors(follow(frames, area_m2=AREA), path)[10:].max() < 60


def test_the_past_does_not_change_with_the_future() -> None:
    path = flight(1)
    frames = searches(path, 1, wrong=0.3)
    whole = follow(frames, area_m2=AREA)
    assert follow(frames[:25], area_m2=AREA) == whole[:25]


def test_the_probability_tells_how_often_the_track_is_right() -> None:
    sure, right = [], []
    for seed in range(12):
        path = flight(seed, 30)
        points = follow(searches(path, seed, wrong=0.5), area_m2=AREA)
        for point, place in zip(points, path, strict=True):
            if point is not None:
                sure.append(point.probability)
                right.append(np.hypot(*(place - (point.east_m, point.north_m))) < 100)
    given, wrong = np.array(sure) >= 0.95, ~np.array(right)
    assert wrong.any()
    assert given.mean() > 0.5
    assert wrong[given].mean() < 0.05
    assert np.mean(sure) == pytest.approx(np.mean(right), abs=0.1)


def test_a_first_fix_is_worth_its_weight() -> None:
    for weight in (0.6, 0.9):
        point = follow([[Fix(0.0, 0.0, 5.0, weight)]], area_m2=AREA)[0]
        assert point is not None
        assert point.probability == pytest.approx(weight)


def test_a_vague_position_is_seldom_right() -> None:
    """A circular normal distribution has 1 - exp(-1/2) of its weight within one deviation."""
    point = follow([[Fix(0.0, 0.0, 30.0, 1.0)]], right_m=30.0, area_m2=1e7)[0]
    assert point is not None
    assert point.probability == pytest.approx(0.99 * (1 - np.exp(-0.5)), abs=0.01)


def test_frames_without_fixes_are_bridged() -> None:
    path = flight(2, 20)
    frames = [[fix(place, 5.0, 0.9)] for place in path]
    frames[0] = []
    frames[14] = []
    points = follow(frames, area_m2=AREA)
    assert points[0] is None
    bridged = points[14]
    before = points[13]
    assert bridged is not None
    assert before is not None
    assert bridged.taken is None
    assert bridged.std_m > before.std_m
    assert np.hypot(bridged.east_m - path[14, 0], bridged.north_m - path[14, 1]) < 30


def test_a_track_that_has_become_vaguer_than_the_area_is_given_up() -> None:
    points = follow([[Fix(0.0, 0.0)], [Fix(40.0, 0.0)], []], [0, 1, 60], area_m2=1e5)
    assert points[1] is not None
    assert points[2] is None


def test_uneven_times_are_used() -> None:
    times = [0.0, 1.0, 2.0, 3.0, 8.0]
    frames = [[Fix(30 * time, 0.0, 2.0, 0.9)] for time in times[:4]] + [[]]
    last = follow(frames, times, area_m2=1e7)[-1]
    assert last is not None
    assert last.east_m == pytest.approx(240, abs=15)


def test_a_fix_of_less_spread_pulls_harder() -> None:
    def end(std_m: float) -> float:
        frames = [[Fix(0.0, 0.0, 10.0, 0.9)] for _ in range(6)] + [[Fix(20.0, 0.0, std_m, 0.9)]]
        point = follow(frames, acceleration_m=2.0, area_m2=AREA)[-1]
        assert point is not None
        return point.east_m

    assert end(3.0) > end(30.0) > 0


def test_a_track_that_has_settled_on_a_wrong_place_is_left() -> None:
    wrong = [[Fix(-400.0 + 40 * i, 300.0, 12.0, 0.7)] for i in range(4)]
    right = [[Fix(40.0 * i, -300.0, 12.0, 0.7)] for i in range(4, 9)]
    ends = [point.north_m for point in follow([*wrong, *right], area_m2=AREA) if point]
    assert ends[3] == pytest.approx(300, abs=10)
    assert ends[-1] == pytest.approx(-300, abs=10)


@pytest.mark.parametrize(
    ("frames", "times", "message"),
    [
        ([[], []], [0.0], "not those of the frames"),
        ([[], []], [1.0, 0.0], "not those of the frames"),
        ([[Fix(0, 0, 1, 0.7), Fix(9, 9, 1, 0.7)]], None, "sum to more than 1"),
    ],
)
def test_times_and_weights_must_make_sense(
    frames: list[list[Fix]], times: list[float] | None, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        follow(frames, times)


def test_without_filterpy_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "filterpy.kalman", None)
    with pytest.raises(ExtraMissingError, match=r"wnn2hdl\[geo\]"):
        follow([[Fix(0.0, 0.0)]])
