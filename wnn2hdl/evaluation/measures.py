"""Figures of merit from confusion matrices, and how sure they are.

Every figure is a ratio; one that would be 0/0 is undefined, not 0: NaN in arrays, None where one is returned.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.muted import muted

Measure = Callable[[NDArray[np.int64]], NDArray[np.float64]]
"""Of confusion matrices ``[..., classes, classes]``, true class by row, a figure each ``[...]``."""

RESAMPLES = 2000
CONFIDENCE = 0.95
METHOD = f"percentile bootstrap over images, {RESAMPLES} resamples"


@dataclass(frozen=True)
class ClassScores:
    """How well one class is found; None where undefined.

    Attributes:
        precision: share of the answers "this class" that are right.
        recall: share of the class's pixels that are found.
        f1: harmonic mean of both, 2 TP / (2 TP + FP + FN).
        iou: intersection over union, TP / (TP + FP + FN).
    """

    precision: float | None
    recall: float | None
    f1: float | None
    iou: float | None


def confusion_of(truth: NDArray[np.integer], answers: NDArray[np.integer], classes: int) -> NDArray[np.int64]:
    """Samples by true class (rows) and answer (columns): int64 ``[classes, classes]``."""
    cells = truth.astype(np.int64) * classes + answers
    return np.bincount(cells, minlength=classes**2).reshape(classes, classes)


def accuracy(confusion: NDArray[np.int64]) -> NDArray[np.float64]:
    """Share of pixels that are right."""
    return _ratio(_hits(confusion).sum(axis=-1), confusion.sum(axis=(-2, -1)))


def kappa(confusion: NDArray[np.int64]) -> NDArray[np.float64]:
    """Cohen's kappa: agreement beyond what the two marginal distributions give by chance."""
    total = confusion.sum(axis=(-2, -1)).astype(np.float64)
    chance = (confusion.sum(axis=-1) * confusion.sum(axis=-2).astype(np.float64)).sum(axis=-1)
    return _ratio(_hits(confusion).sum(axis=-1) * total - chance, total**2 - chance)


def ious(confusion: NDArray[np.int64]) -> NDArray[np.float64]:
    """Intersection over union of each class: ``[..., classes]``."""
    return _ratio(_hits(confusion), confusion.sum(axis=-1) + confusion.sum(axis=-2) - _hits(confusion))


def mean_iou(confusion: NDArray[np.int64]) -> NDArray[np.float64]:
    """Mean intersection over union of the classes that occur, in the labels or the answers."""
    each = ious(confusion)
    defined = ~np.isnan(each)
    return _ratio(np.where(defined, each, 0).sum(axis=-1), defined.sum(axis=-1))


def class_scores(confusion: NDArray[np.int64]) -> tuple[ClassScores, ...]:
    """The scores of each class from one confusion matrix."""
    hits, truth, answers = _hits(confusion), confusion.sum(axis=-1), confusion.sum(axis=-2)
    columns = (
        _ratio(hits, answers),
        _ratio(hits, truth),
        _ratio(2 * hits, truth + answers),
        ious(confusion),
    )
    return tuple(
        ClassScores(*(defined(figure) for figure in figures)) for figures in zip(*columns, strict=True)
    )


def interval(confusions: NDArray[np.int64], measure: Measure, seed: int) -> tuple[float, float] | None:
    """An interval that holds the measure with the probability `CONFIDENCE`, were other images drawn.

    Whole images are drawn again, since pixels of one image resemble one another: the percentile bootstrap of
    scipy.stats with `RESAMPLES` resamples.

    Args:
        confusions: ``[images, classes, classes]``.
        measure: taken of sums over images.
        seed: of the draw.

    Returns:
        low and high; None with fewer than two images, or where the measure is undefined for a resample.
    """
    if len(confusions) < 2:
        return None

    def statistic(images: NDArray[np.int64], axis: int) -> NDArray[np.float64]:
        return measure(confusions[images].sum(axis=axis % images.ndim))

    # A resample without a figure makes the bounds NaN, of which SciPy warns.
    with muted():
        bounds = percentile_bootstrap((np.arange(len(confusions)),), statistic, seed)
    low, high = (defined(bound) for bound in bounds)
    return None if low is None or high is None else (low, high)


def percentile_bootstrap(
    samples: tuple[NDArray[Any], ...], statistic: Callable[..., NDArray[np.float64]], seed: int
) -> tuple[float, float]:
    """Low and high of the percentile bootstrap of scipy.stats with `RESAMPLES` resamples, at `CONFIDENCE`.

    Args:
        samples: each is drawn again by itself.
        statistic: of resamples, along a keyword ``axis``.
        seed: of the draw.
    """
    from scipy.stats import bootstrap

    found = bootstrap(
        samples,
        statistic,
        n_resamples=RESAMPLES,
        batch=100,
        confidence_level=CONFIDENCE,
        method="percentile",
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return float(found.low), float(found.high)


def wilson(confusion: NDArray[np.int64]) -> tuple[float, float]:
    """An interval that holds the accuracy with the probability `CONFIDENCE`, were other samples drawn.

    Wilson's score interval; samples are taken for independent, which pixels of an image are not.

    Args:
        confusion: ``[classes, classes]``, of at least one sample.
    """
    from scipy.stats import binomtest

    test = binomtest(int(_hits(confusion).sum()), int(confusion.sum()))
    found = test.proportion_ci(confidence_level=CONFIDENCE, method="wilson")
    return float(found.low), float(found.high)


def defined(figure: float | NDArray[np.float64]) -> float | None:
    """A figure, or None for one that is undefined."""
    return None if np.isnan(figure) else float(figure)


def _hits(confusion: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(np.diagonal(confusion, axis1=-2, axis2=-1))


def _ratio(part: NDArray[np.number], whole: NDArray[np.number]) -> NDArray[np.float64]:
    part, whole = np.asarray(part, dtype=np.float64), np.asarray(whole, dtype=np.float64)
    return np.asarray(np.divide(part, whole, out=np.full(whole.shape, np.nan), where=whole != 0))
