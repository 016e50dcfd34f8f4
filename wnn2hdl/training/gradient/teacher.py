"""A teacher for few samples: it labels rows made up between them, as many as a network wants.

A hundred samples say little about tables of 64 entries. A classifier that suits few samples, such as a
support vector machine, is trained on all of them; rows are made up where samples lie, and the network
learns what the teacher says about these (distillation; Hinton et al., 2015).
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis, QuadraticDiscriminantAnalysis
from sklearn.linear_model import LogisticRegression
from sklearn.neighbors import NearestNeighbors
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.training.folds import FOLDS, dealt

FEW_SAMPLES = 5000
"""Up to so many samples a teacher is worth its time."""

MADE_UP = 20_000
"""Rows that are made up for so few."""

NEIGHBOURS = 10
JITTER = 0.1
"""Deviation of the noise on rows that are made up, in units of each feature's."""

_TEACHERS: dict[str, Callable[[], Any]] = {
    "support vectors, C = 10": lambda: SVC(C=10),
    "support vectors, C = 100": lambda: SVC(C=100),
    "linear discriminant": LinearDiscriminantAnalysis,
    "quadratic discriminant": lambda: QuadraticDiscriminantAnalysis(reg_param=0.01),
    "logistic regression": lambda: LogisticRegression(max_iter=1000),
}


@dataclass(frozen=True)
class Teacher:
    """A trained teacher.

    Attributes:
        name: what kind it is.
        accuracy: in cross-validation of the samples, 0 to 1. It chose the kind, so it flatters a little.
        classifier: what predicts class indices.
    """

    name: str
    accuracy: float
    classifier: Any


def usual_made_up(samples: int, *, pictures: bool) -> int:
    """Rows to make up for so many samples: none for many, or for pictures, which are distorted instead."""
    return 0 if pictures or samples > FEW_SAMPLES else MADE_UP


def choose_teacher(features: NDArray[np.float64], labels: NDArray[np.int64], seed: int) -> Teacher:
    """The teacher that is most often right in cross-validation, trained on all samples.

    Args:
        features: ``[samples, features]``.
        labels: class index of each; at least two classes.
        seed: of the folds.
    """
    right = {name: _cross_validated(make, features, labels, seed) for name, make in _TEACHERS.items()}
    name = max(right, key=lambda name: right[name])
    return Teacher(name, right[name], _fitted(_TEACHERS[name], features, labels))


def made_up(features: NDArray[np.float64], words: FixedPoint, count: int, seed: int) -> NDArray[np.float64]:
    """Rows between samples and their neighbours, with some noise, within the range of the samples.

    Args:
        features: of the samples, ``[samples, features]``.
        words: the format that rows are rounded to.
        count: how many rows.
        seed: of everything random.

    Returns:
        float64 ``[count, features]``.
    """
    rng = np.random.default_rng(seed)
    spread = features.std(axis=0)
    near = min(NEIGHBOURS + 1, len(features))
    scaled = features / np.where(spread > 0, spread, 1)
    neighbours = NearestNeighbors(n_neighbors=near).fit(scaled).kneighbors(return_distance=False, X=scaled)
    first = rng.integers(0, len(features), count)
    second = neighbours[first, rng.integers(0, near, count)]
    between = features[first] + rng.random((count, 1)) * (features[second] - features[first])
    noisy = between + rng.normal(0, JITTER, between.shape) * spread
    half = np.ldexp(0.5, -words.fraction)
    nearest = words.values(words.words(noisy + half))
    return np.clip(nearest, features.min(axis=0), features.max(axis=0))


def _fitted(make: Callable[[], Any], features: NDArray[np.float64], labels: NDArray[np.int64]) -> Any:
    with warnings.catch_warnings():
        # Collinear features, equal means and slow convergence make a poor teacher, as cross-validation shows.
        warnings.simplefilter("ignore")
        return make_pipeline(StandardScaler(), make()).fit(features, labels)


def _cross_validated(
    make: Callable[[], Any], features: NDArray[np.float64], labels: NDArray[np.int64], seed: int
) -> float:
    """Share right of the samples of each fold when trained on the others; 0 if it cannot be trained."""
    fold_of = dealt(labels, FOLDS, seed)
    right = 0
    for fold in range(FOLDS):
        test = fold_of == fold
        if not test.any():
            continue
        try:
            fitted = _fitted(make, features[~test], labels[~test])
        # Too few samples of a class for this kind, or, for discriminants, no feature that varies.
        except (ValueError, IndexError, np.linalg.LinAlgError):
            return 0.0
        right += int((fitted.predict(features[test]) == labels[test]).sum())
    return right / len(labels)
