"""The smooth reference: what a classifier of any cost would say, as the aim of those that are cheap."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.training.bitselect.drift import Colours

INVERSE_RIDGE = 1e4
"""Inverse strength of the ridge penalty for weights that sum to 1: next to none, yet never singular."""

DARKEST = 4.0
"""Added to the levels of mean colours, so that their logarithms do not separate black from nearly black."""

Probability = Callable[[NDArray[np.int64]], NDArray[np.float64]]


def fit_reference(colours: Colours) -> Probability:
    """The mean of two logistic regressions, one on RGB and one on the logarithms of RGB.

    Either alone is a plane through its space; on images that were not trained on, their mean was at least as
    accurate as each, and as a quadratic one.

    Args:
        colours: weights of two classes.

    Returns:
        a function from colours, int64 ``[u, 3]``, to the probability of the second class, float64 ``[u]``.
    """
    # scikit-learn takes a second to import, which no command should wait for that does not use it.
    from sklearn.linear_model import LogisticRegression

    labels = np.repeat([0, 1], len(colours.rgb))
    weights = colours.weights.ravel()
    used = weights > 0
    fits = []
    for features in (_linear, _logarithmic):
        samples = np.tile(features(colours.rgb), (2, 1))[used]
        # Three features and very many samples: Newton's method needs a few passes only.
        regression = LogisticRegression(C=INVERSE_RIDGE, solver="newton-cholesky")
        regression.fit(samples, labels[used], sample_weight=weights[used] / weights.sum())
        fits.append((features, regression))

    def probability(rgb: NDArray[np.int64]) -> NDArray[np.float64]:
        answers = [regression.predict_proba(features(rgb))[:, 1] for features, regression in fits]
        return np.asarray(np.mean(answers, axis=0))

    return probability


def fit_window_reference(
    means: NDArray[np.float64], labels: NDArray[np.uint8]
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """A logistic regression on the logarithms of a window's mean colour, their squares and products.

    Args:
        means: mean colours of windows, float64 ``[samples, 3]``.
        labels: 0 or 1, ``[samples]``.

    Returns:
        a function from mean colours, float64 ``[m, 3]``, to the probability of class 1, float64 ``[m]``.
    """
    fitted = _quadratic(np.log(means + DARKEST), labels)
    return lambda colours: fitted(np.log(colours + DARKEST))


def fit_ratio_reference(
    pixels: NDArray[np.uint8], labels: NDArray[np.int64]
) -> Callable[[NDArray[np.uint8]], NDArray[np.float64]]:
    """A logistic regression on the logarithms of red over blue and red over green, squares and product.

    More light multiplies all channels alike and leaves their ratios as they are.

    Args:
        pixels: uint8 ``[samples, 3]``.
        labels: 0 or 1, ``[samples]``.

    Returns:
        a function from pixels, uint8 ``[m, 3]``, to the probability of class 1, float64 ``[m]``.
    """
    fitted = _quadratic(_ratios(pixels), labels)
    return lambda others: fitted(_ratios(others))


def _quadratic(
    features: NDArray[np.float64], labels: NDArray[np.integer]
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """A logistic regression on features ``[samples, n]``, their squares and products."""
    # scikit-learn takes a second to import, which no command should wait for that does not use it.
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler

    regression = make_pipeline(
        StandardScaler(),
        PolynomialFeatures(2, include_bias=False),
        StandardScaler(),
        LogisticRegression(solver="newton-cholesky"),
    )
    regression.fit(features, labels)
    return lambda others: np.asarray(regression.predict_proba(others)[:, 1])


def _ratios(pixels: NDArray[np.uint8]) -> NDArray[np.float64]:
    red, green, blue = np.log(pixels.astype(np.float64) + DARKEST).T
    return np.stack([red - blue, red - green], axis=-1)


def _linear(rgb: NDArray[np.int64]) -> NDArray[np.float64]:
    return (rgb - 50) / 20


def _logarithmic(rgb: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.log1p(rgb) * 4 - 16
