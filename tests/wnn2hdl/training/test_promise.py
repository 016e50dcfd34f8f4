"""Predictions hold as often as they say."""

import numpy as np
import pytest

from wnn2hdl.training.promise import OTHERS, light_figures, prediction_interval


def test_the_interval_is_students() -> None:
    # Mean 0.8 and standard deviation 0.1, of four images; 3.1824 is the quantile of three degrees of freedom.
    shares = np.array([0.8 - 0.1, 0.8 + 0.1, 0.8 - 0.05, 0.8 + 0.05])
    reach = 3.1824463 * shares.std(ddof=1) * np.sqrt(1 / 4 + 1 / 10)
    assert prediction_interval(shares, 10) == pytest.approx((0.8 - reach, 0.8 + reach))


def test_it_stays_within_0_and_1_and_needs_two_images() -> None:
    assert prediction_interval(np.array([0.1, 1.0]), 1) == (0.0, 1.0)
    assert prediction_interval(np.array([0.9])) is None
    assert prediction_interval(np.array([0.5, 0.5])) == (0.5, 0.5)


def test_means_of_other_images_lie_in_it_as_often_as_it_says() -> None:
    rng = np.random.default_rng(0)
    # Accuracies of scenes are skewed: most are high, a few are low.
    held = 0
    for _ in range(2000):
        shares = 1 - rng.beta(1.2, 16, 30 + OTHERS)
        interval = prediction_interval(shares[:30])
        assert interval is not None
        held += interval[0] <= shares[30:].mean() <= interval[1]
    assert held / 2000 == pytest.approx(0.95, abs=0.02)


def test_figures_are_given_for_each_exposure() -> None:
    shares = np.array([[0.9, 0.9, 0.5, 0.5], [0.7, 0.9, 0.9, 0.9]])
    figures = light_figures(shares)
    assert list(figures) == ["0.8", "1", "1.25", "1.5"]
    assert figures["0.8"]["accuracy"] == pytest.approx(0.8)
    assert figures["1.25"]["worst_image"] == 0.5
    assert figures["1"]["other_images"] == pytest.approx((0.9, 0.9))
    assert figures["1.5"]["other_images"] == prediction_interval(shares[:, 3])
