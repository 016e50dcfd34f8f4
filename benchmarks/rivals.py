"""Classifiers of ground that LUTs have to compare with: thresholds, regressions, forests, boosted trees."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage
from wnn2hdl.evaluation.accuracy import with_halo
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.training.light import varied

TREES = 100
BOXES = (3, 7, 15, 31)
"""Sides of the squares around a pixel over which context is taken."""

Features = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Of colours ``S + (3,)``, features ``S + (n,)``."""


class Estimator(Protocol):
    """What scikit-learn's classifiers have in common."""

    def fit(self, samples: NDArray[np.float64], labels: NDArray[np.uint8]) -> Any:
        """Train on samples ``[n, features]`` and class indices ``[n]``."""

    def predict(self, samples: NDArray[np.float64]) -> NDArray[np.integer]:
        """The class of each sample."""


@dataclass(frozen=True, eq=False)
class ColourClassifier:
    """A rival that answers for colours, asked once for each colour of a picture.

    Attributes:
        predict: uint8 ``[n, 3]`` to class indices ``[n]``.
    """

    predict: Callable[[NDArray[np.uint8]], NDArray[np.integer]]
    classes: tuple[str, ...] = CLASSES
    halo: int = 0

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """See `PictureClassifier.classify`."""
        weights = np.array([1 << 16, 1 << 8, 1])
        _, first, place = np.unique(picture.reshape(-1, 3) @ weights, return_index=True, return_inverse=True)
        answers = self.predict(picture.reshape(-1, 3)[first]).astype(np.uint8)
        return answers[place].reshape(picture.shape[:2])

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """Any colour is answered for."""
        return self.classify(picture), np.ones(picture.shape[:2], dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class ContextClassifier:
    """A rival that reads features of a pixel and means and deviations of them over `BOXES` around it.

    Attributes:
        features: of single pixels.
        estimator: reads features, then the mean and the deviation of each over each box.
    """

    features: Features
    estimator: Estimator
    classes: tuple[str, ...] = CLASSES
    halo: int = field(default=max(BOXES) // 2, init=False)

    def samples(self, picture: NDArray[np.uint8]) -> NDArray[np.float64]:
        """What the estimator reads, ``[height - 2 * halo, width - 2 * halo, features]``."""
        inner = slice(self.halo, -self.halo)
        found = self.features(picture.astype(np.float64))
        columns = [found[inner, inner]]
        for side in BOXES:
            margin = self.halo - side // 2
            kept = slice(margin, len(found) - margin), slice(margin, found.shape[1] - margin)
            mean, square = (box_means(values[kept], side) for values in (found, found**2))
            columns += [mean, np.sqrt(np.maximum(square - mean**2, 0))]
        return np.concatenate(columns, axis=-1)

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """See `PictureClassifier.classify`."""
        samples = self.samples(picture)
        answers = self.estimator.predict(samples.reshape(-1, samples.shape[-1]))
        return answers.astype(np.uint8).reshape(samples.shape[:2])

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """Any picture is answered for."""
        answers = self.classify(picture)
        return answers, np.ones(answers.shape, dtype=np.bool_)


def box_means(values: NDArray[np.float64], side: int) -> NDArray[np.float64]:
    """Means over all squares of ``side`` inside, ``[height - side + 1, width - side + 1, n]``."""
    sums = np.pad(values.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0), (0, 0)))
    total = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
    return np.asarray(total / side**2)


def levels(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """Red, green and blue as they are."""
    return colours


def ratios(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """The logarithms of R/B and R/G, from which light cancels."""
    red, green, blue = np.moveaxis(np.log(colours + 1), -1, 0)
    return np.stack([red - blue, red - green], axis=-1)


def normalised_difference(one: int, other: int) -> Features:
    """(a - b) / (a + b) of two channels by number, as vegetation indices have it."""

    def index(colours: NDArray[np.float64]) -> NDArray[np.float64]:
        first, second = colours[..., one], colours[..., other]
        return np.asarray((first - second) / (first + second + 1))[..., np.newaxis]

    return index


def excess_green(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """(R + B - 2G) / (R + G + B): the excess of green over the others, the other way round."""
    total = colours.sum(axis=-1)
    return np.asarray((total - 3 * colours[..., 1]) / (total + 1))[..., np.newaxis]


def quadratic() -> Estimator:
    """Logistic regression on features, their squares and products."""
    estimator: Estimator = make_pipeline(
        PolynomialFeatures(2, include_bias=False),
        StandardScaler(),
        LogisticRegression(solver="newton-cholesky"),
    )
    return estimator


def linear() -> Estimator:
    """Logistic regression on features."""
    estimator: Estimator = make_pipeline(StandardScaler(), LogisticRegression(solver="newton-cholesky"))
    return estimator


def forest(seed: int) -> Estimator:
    """A random forest; leaves of at least 20 pixels, without which it learns the noise."""
    estimator: Estimator = RandomForestClassifier(TREES, min_samples_leaf=20, random_state=seed)
    return estimator


def boosting(seed: int) -> Estimator:
    """Gradient boosting of trees with 15 leaves of at least 200 pixels."""
    estimator: Estimator = HistGradientBoostingClassifier(
        max_leaf_nodes=15, min_samples_leaf=200, random_state=seed
    )
    return estimator


class Threshold:
    """The threshold of one feature with the most training samples right, above which all is deforested."""

    def fit(self, samples: NDArray[np.float64], labels: NDArray[np.uint8]) -> None:
        """Look at every threshold."""
        order = np.argsort(samples[:, 0], kind="stable")
        ranked, classes = samples[order, 0], labels[order].astype(np.int64)
        # Right are forest below and cleared ground from the threshold on; equal values stay together.
        right = np.append(0, (1 - 2 * classes).cumsum()) + classes.sum()
        starts = np.append(True, np.diff(ranked) > 0)
        best = int(np.where(np.append(starts, True), right, -1).argmax())
        self.bound = np.append(ranked, np.inf)[best]

    def predict(self, samples: NDArray[np.float64]) -> NDArray[np.integer]:
        """See `Estimator.predict`."""
        return np.asarray(samples[:, 0] >= self.bound).astype(np.int64)


def of_colours(
    estimator: Callable[[], Estimator], features: Features, pixels: int, seed: int, dataset: Dataset
) -> PictureClassifier:
    """Train a rival on features of single pixels; ``pixels`` of them are drawn from each image."""
    drawn = [_drawn(image, pixels, seed) for image in dataset]
    return _trained(estimator(), features, *map(np.concatenate, zip(*drawn, strict=True)))


def of_varied_colours(
    estimator: Callable[[], Estimator], features: Features, pixels: int, seed: int, dataset: Dataset
) -> PictureClassifier:
    """The same under varied light, as comparisons of channels are trained."""
    drawn = [_drawn(image, pixels, seed) for image in dataset]
    colours, labels = map(np.concatenate, zip(*drawn, strict=True))
    return _trained(estimator(), features, varied(colours, np.random.default_rng(seed)), labels)


def of_context(
    estimator: Callable[[], Estimator], features: Features, pixels: int, seed: int, dataset: Dataset
) -> PictureClassifier:
    """Train a rival that looks around, on ``pixels`` drawn from each image."""
    classifier = ContextClassifier(features, estimator())
    samples, labels = [], []
    for image in dataset:
        read = classifier.samples(with_halo(image.picture, classifier.halo)).reshape(len(image.labels), -1)
        chosen = _chosen(image, pixels, seed)
        samples.append(read[chosen])
        labels.append(image.labels[chosen])
    classifier.estimator.fit(np.concatenate(samples), np.concatenate(labels))
    return classifier


def _trained(
    estimator: Estimator, features: Features, colours: NDArray[np.uint8], labels: NDArray[np.uint8]
) -> ColourClassifier:
    estimator.fit(features(colours.astype(np.float64)), labels)
    return ColourClassifier(partial(_predicted, estimator, features))


def _predicted(estimator: Estimator, features: Features, colours: NDArray[np.uint8]) -> NDArray[np.integer]:
    return estimator.predict(features(colours.astype(np.float64)))


def _drawn(image: LabelledImage, pixels: int, seed: int) -> Sequence[NDArray[np.uint8]]:
    chosen = _chosen(image, pixels, seed)
    return image.pixels[chosen], image.labels[chosen]


def _chosen(image: LabelledImage, pixels: int, seed: int) -> NDArray[np.int64]:
    """Pixels drawn without replacement, the same whichever images are in the set."""
    rng = np.random.default_rng([seed, *image.name.encode()])
    return rng.choice(len(image.labels), size=min(pixels, len(image.labels)), replace=False)
