"""Tracks of constant speed without kinks, inside their room, and gusts of a known strength."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.samples.track import fly_track, gusts


@given(st.integers(0, 10**6), st.floats(60, 3000), st.floats(60, 3000), st.integers(1, 80), st.floats(5, 30))
def test_places_are_evenly_spaced_inside_the_room_and_headed_along_the_way(
    seed: int, height: float, width: float, frames: int, spacing: float
) -> None:
    track = fly_track(np.random.default_rng(seed), np.array([height, width]), frames, spacing)
    assert len(track.south) == len(track.east) == len(track.heading_deg) == frames
    assert 0 <= track.south.min() <= track.south.max() <= height
    assert 0 <= track.east.min() <= track.east.max() <= width
    steps = np.hypot(np.diff(track.south), np.diff(track.east))
    # A chord is shorter than its arc, and never longer.
    assert (steps <= spacing * (1 + 1e-9)).all()
    if frames > 1:
        assert steps.min() > 0
        assert np.median(steps) > 0.5 * spacing


def test_a_long_way_in_a_large_room_is_flown_straight_ahead_with_few_turns() -> None:
    track = fly_track(np.random.default_rng(3), np.array([4000.0, 4000.0]), 60, 35)
    course = np.degrees(np.arctan2(np.diff(track.east), -np.diff(track.south)))
    off = (track.heading_deg[:-1] - course + 180) % 360 - 180
    assert np.median(np.abs(off)) < 5
    assert np.median(np.hypot(np.diff(track.south), np.diff(track.east))) > 34.9


def test_gusts_wander_with_a_standard_deviation_of_one_and_stay_below_two_and_a_half() -> None:
    wind = gusts(np.random.default_rng(0), 20_000)
    assert abs(wind.mean()) < 0.05
    assert 0.93 < wind.std() < 1.02
    assert np.abs(wind).max() <= 2.5
    assert 0.5 < np.corrcoef(wind[1:], wind[:-1])[0, 1] < 0.65
