import numpy as np

from wnn2hdl.training.bitselect.drift import Colours
from wnn2hdl.training.bitselect.reference import fit_ratio_reference, fit_reference


def test_reference_learns_that_red_means_the_second_class() -> None:
    rgb = np.array([[red, 60, 60] for red in range(20, 100)])
    right = rgb[:, 0] >= 60
    probability = fit_reference(Colours(rgb, np.stack([~right, right]).astype(np.float64)))
    assert ((probability(rgb) > 0.5) == right).mean() > 0.97


def test_reference_follows_weights_not_the_number_of_colours() -> None:
    rgb = np.array([[50, 50, 50], [52, 50, 50], [54, 50, 50]])
    seldom = Colours(rgb, np.array([[1.0, 1, 1], [100, 100, 100]]))
    assert (fit_reference(seldom)(rgb) > 0.9).all()


def test_reference_changes_smoothly_between_colours_it_has_not_seen() -> None:
    rgb = np.array([[20, 40, 40], [90, 40, 40]])
    probability = fit_reference(Colours(rgb, np.array([[3.0, 1], [1, 3]])))
    between = probability(np.array([[red, 40, 40] for red in range(20, 91)]))
    assert (np.diff(between) > 0).all()


def test_reference_of_ratios_says_the_same_in_twice_the_light() -> None:
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 2, 2000)
    blue = rng.uniform(40, 110, len(labels))
    red = blue * np.where(labels == 1, 1.0, 0.6) * rng.uniform(0.8, 1.2, len(labels))
    pixels = np.stack([red, rng.uniform(30, 110, len(labels)), blue], axis=1).astype(np.uint8)
    probability = fit_ratio_reference(pixels, labels)
    assert ((probability(pixels) > 0.5) == labels).mean() > 0.95
    assert ((probability(2 * pixels) > 0.5) == labels).mean() > 0.95
