"""Thresholds keep their promise on matches they were not chosen on."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.matching import Match, Peak, choose_threshold, peak_weights
from wnn2hdl.errors import InputError


def flight(rng: np.random.Generator, frames: int) -> tuple[list[float], list[float]]:
    """Confidences and errors: two thirds are right, and their confidences overlap those of wrong ones."""
    right = rng.random(frames) < 0.67
    confidences = np.where(right, rng.normal(9, 2, frames), rng.normal(4, 1, frames))
    return list(confidences), list(np.where(right, 10.0, 300.0))


def test_of_the_fixes_given_enough_are_right() -> None:
    rng = np.random.default_rng(0)
    precisions, shares = [], []
    for _ in range(200):
        acceptance = choose_threshold(*flight(rng, 20), negatives=list(rng.normal(4, 1, 100)))
        assert acceptance.precision >= 0.95
        confidences, errors = flight(rng, 400)
        given = [error for value, error in zip(confidences, errors, strict=True) if acceptance.accepts(value)]
        precisions.append(np.mean(np.asarray(given) < 100))
        shares.append(len(given) / 400)
    assert np.mean(precisions) > 0.97
    assert np.quantile(precisions, 0.05) > 0.93
    assert np.mean(shares) > 0.55


def test_a_few_right_frames_alone_do_not_promise_much() -> None:
    few = choose_threshold([5.0, 6.0, 7.0], [1.0, 2.0, 3.0])
    many = choose_threshold(list(np.linspace(5, 7, 18)), [1.0] * 18)
    assert few.threshold == many.threshold == 5
    assert few.precision == pytest.approx(0.8)
    assert few.share == 1
    assert many.precision >= 0.95


def test_no_threshold_accepts_if_nothing_was_right() -> None:
    acceptance = choose_threshold([5.0, 9.0], [500.0, 800.0])
    assert not acceptance.accepts(1e9)
    assert acceptance.share == 0


def test_a_threshold_needs_matches() -> None:
    with pytest.raises(InputError, match="error is known"):
        choose_threshold([], [])


def test_weights_of_peaks_leave_room_for_none() -> None:
    clear = peak_weights(Match((Peak(0, 0, 0.9), Peak(50, 50, 0.3)), 0.0, 0.1))
    vague = peak_weights(Match((Peak(0, 0, 0.32), Peak(50, 50, 0.3)), 0.0, 0.1))
    assert clear[0] > 0.95
    assert sum(clear) < 1
    assert vague[0] > vague[1]
    assert sum(vague) < 0.5
    assert peak_weights(Match((Peak(0, 0, 0.0), Peak(9, 9, 0.0)), 0.0, 0.0)) == (1 / 3, 1 / 3)
