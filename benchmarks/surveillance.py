"""Deforestation on unseen images, pixel by pixel and square by square, beside common classifiers.

    python benchmarks/surveillance.py IMAGES MASKS [--seed 0] [--mappings 5] [--pixels 5000]

Five folds by image. Every classifier of single pixels is trained on the same pixels: equally many of each
training image, drawn at random; those of neighbourhoods draw their own windows. Squares are those of the
reference
design: 20 x 20, half of the pixels vote; they are scored against the majority of each square of the mask, and
against its pixels.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import RandomForestClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, folds, from_masks
from wnn2hdl.encode import high_bits
from wnn2hdl.evaluation.accuracy import Squares, evaluate, majority_labels
from wnn2hdl.evaluation.classifiers import PictureClassifier, model_classifier
from wnn2hdl.evaluation.measures import ious
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bitselect import LUTS
from wnn2hdl.training.budget import train_under_budget
from wnn2hdl.training.crossval import FOLDS
from wnn2hdl.training.discriminators import train
from wnn2hdl.training.neighbourhood import train_neighbourhood

SIDE, SHARE = 20, 0.5
TREES = 100

Trainer = Callable[[Dataset], PictureClassifier]


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
        colours, place = np.unique(picture.reshape(-1, 3), axis=0, return_inverse=True)
        return self.predict(colours).astype(np.uint8)[place].reshape(picture.shape[:2])

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """Any colour is answered for."""
        return self.classify(picture), np.ones(picture.shape[:2], dtype=np.bool_)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("images", type=Path)
    parser.add_argument("masks", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--mappings", type=int, default=5)
    parser.add_argument("--pixels", type=int, default=5000)
    given = parser.parse_args()
    dataset = from_masks(given.images, given.masks)
    print(
        f"{len(dataset)} images, {FOLDS} folds, {given.pixels} training pixels an image, seed {given.seed}\n"
    )
    measures = ["pixels right", "IoU", "squares right", "IoU", "pixels of squares right", "IoU"]
    print(head(["classifier", *measures]))
    for name, trainers in rivals(given.pixels, given.mappings, given.seed).items():
        results = [cross_validated(dataset, trainer, given.seed) for trainer in trainers]
        print(row([name, *np.mean(results, axis=0).tolist()]), flush=True)


def rivals(pixels: int, mappings: int, seed: int) -> dict[str, list[Trainer]]:
    """What is compared: each row of the table is the mean over its trainers."""

    def on_pixels(trainer: Trainer) -> Trainer:
        return lambda dataset: trainer(sampled(dataset, pixels, seed))

    def discriminators(mapping: int) -> Trainer:
        return lambda dataset: model_classifier(
            train(
                dataset, high_bits(), address_bits=4, rams=16, bleaching=None, seed=mapping, progress=silent
            )
        )

    def under_budget(luts: int) -> Trainer:
        return lambda dataset: model_classifier(
            train_under_budget(dataset, luts, trials=0, seed=seed, progress=silent)
        )

    def neighbourhood(size: int) -> Trainer:
        return lambda dataset: model_classifier(
            train_neighbourhood(dataset, size, luts_per_pixel=None, seed=seed, progress=silent)
        )

    single: dict[str, list[Trainer]] = {
        "red threshold": [red_threshold],
        "quadratic logistic regression": [quadratic_regression],
        f"random forest of {TREES} trees": [lambda dataset: random_forest(dataset, seed)],
        f"WiSARD n = 4, k = 16, mean of {mappings} mappings": [
            discriminators(seed + i) for i in range(mappings)
        ],
        "bit selection, 1 LUT per pixel": [under_budget(1)],
        "bit selection, 2 LUTs per pixel": [under_budget(2)],
    }
    whole: dict[str, list[Trainer]] = {
        f"{size}x{size} neighbourhood, {LUTS} LUTs per pixel": [neighbourhood(size)] for size in (3, 5)
    }
    return {name: [on_pixels(trainer) for trainer in trainers] for name, trainers in single.items()} | whole


def cross_validated(dataset: Dataset, trainer: Trainer, seed: int) -> list[float]:
    """Share right and IoU of "deforested": of pixels, of squares, of squares' pixels; over all images."""
    confusions = np.zeros((3, 2, 2), dtype=np.int64)
    for training, held_out in folds(dataset.names, FOLDS):
        classifier = trainer(dataset.subset(training))
        squares = Squares(SIDE, SHARE, seed)
        tests = dataset.subset(held_out)
        pairs = (tests, None), (majority_labels(tests, SIDE), squares), (tests, squares)
        for place, (labelled, voting) in enumerate(pairs):
            confusions[place] += evaluate(classifier, labelled, silent, voting).confusion.sum(axis=0)
    right = np.trace(confusions, axis1=1, axis2=2) / confusions.sum(axis=(1, 2))
    return np.stack([right, ious(confusions)[:, 1]], axis=1).ravel().tolist()


def sampled(dataset: Dataset, count: int, seed: int) -> Dataset:
    """Of each image ``count`` pixels drawn without replacement, the same whichever images are in the set."""

    def load(name: str) -> LabelledImage:
        image = dataset.load(name)
        rng = np.random.default_rng([seed, *name.encode()])
        chosen = rng.choice(len(image.labels), size=min(count, len(image.labels)), replace=False)
        return LabelledImage(name, image.pixels[chosen], image.labels[chosen])

    return Dataset(dataset.classes, dataset.names, load)


def gathered(dataset: Dataset) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """All pixels and labels of a set."""
    images = list(dataset)
    return np.concatenate([i.pixels for i in images]), np.concatenate([i.labels for i in images])


def red_threshold(dataset: Dataset) -> PictureClassifier:
    """Deforested is what is at least as red as the threshold with the most training pixels right."""
    pixels, labels = gathered(dataset)
    counts = np.stack([np.bincount(pixels[labels == label, 0], minlength=256) for label in (0, 1)])
    right = [counts[1, level:].sum() + counts[0, :level].sum() for level in range(257)]
    threshold = int(np.argmax(right))
    return ColourClassifier(lambda colours: (colours[:, 0] >= threshold).astype(np.int64))


def quadratic_regression(dataset: Dataset) -> PictureClassifier:
    """Logistic regression on RGB, its squares and products."""
    pixels, labels = gathered(dataset)
    model = make_pipeline(
        PolynomialFeatures(2, include_bias=False),
        StandardScaler(),
        LogisticRegression(solver="newton-cholesky"),
    )
    model.fit(pixels.astype(np.float64), labels)
    return ColourClassifier(lambda colours: np.asarray(model.predict(colours.astype(np.float64))))


def random_forest(dataset: Dataset, seed: int) -> PictureClassifier:
    """A random forest on RGB; leaves of at least 20 pixels, without which it learns the noise."""
    pixels, labels = gathered(dataset)
    model = RandomForestClassifier(TREES, min_samples_leaf=20, random_state=seed)
    model.fit(pixels, labels)
    return ColourClassifier(lambda colours: np.asarray(model.predict(colours)))


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


if __name__ == "__main__":
    main()
