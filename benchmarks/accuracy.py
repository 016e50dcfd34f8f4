"""Accuracy on unseen images against LUTs per pixel, of several classifiers, in one table.

    python benchmarks/accuracy.py IMAGES MASKS [--mappings 20] [--seed 0]

Five-fold cross-validation by image over a folder of pictures and one of masks: the mean over images, the
worst image, and the interval in which the mean of ten other images of the kind is to be expected with a
probability of 0.95. LUTs are those of the classifier trained on all images, as mapped; logistic regression is
not a circuit here and has none. The last rows look at a pixel's neighbours, too.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

from benchmarks.scenes import scene_parser
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.dataset import CLASSES, ColourHistogram, Dataset, colour_histogram, folds, from_masks
from wnn2hdl.encode import high_bits
from wnn2hdl.evaluation.accuracy import evaluate
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.evaluation.measures import accuracy
from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.lower.table import pixel_table
from wnn2hdl.markdown import head, row
from wnn2hdl.minimise import map_luts
from wnn2hdl.training.bitselect import MOST_LUTS, SIZES, look_up_table, select_bits
from wnn2hdl.training.budget import code_histogram, saturates, train_discriminators
from wnn2hdl.training.crossval import Trainer, cross_validated
from wnn2hdl.training.folds import FOLDS
from wnn2hdl.training.neighbourhood import train_neighbourhood
from wnn2hdl.training.promise import OTHERS, prediction_interval

Shares = NDArray[np.float64]
"""Of each image's pixels that are right, ``[images]``."""

RED = BitSelect(tuple(f"R{bit}" for bit in range(8)))


def main() -> None:
    """Print the table."""
    parser = scene_parser(__doc__)
    parser.add_argument("--mappings", type=int, default=20)
    given = parser.parse_args()
    dataset = from_masks(given.images, given.masks)
    images = [colour_histogram(image, 2) for image in dataset]
    columns = ["accuracy", "worst image", f"expected of {OTHERS} others", "LUTs per pixel"]
    print(head(["classifier", *columns]))

    show("red threshold", *measured(images, partial(red_threshold, images)))
    show("quadratic logistic regression on RGB", regression_shares(images))

    encoder = high_bits()
    histograms = np.stack([code_histogram(image, encoder) for image in images])
    trials: list[tuple[Shares, Trainer]] = []
    for seed in range(given.seed, given.seed + given.mappings):
        train = partial(train_discriminators, histograms, encoder, CLASSES, seed)
        if not saturates(train(range(len(images)))):
            trials.append((shares(images, train), train))
    mean = np.mean([found for found, _ in trials], axis=0)
    show(f"WiSARD n = 4, k = 16, mean of {len(trials)} mappings", mean)
    best, most_accurate = max(trials, key=lambda trial: float(trial[0].mean()))
    show("the best of them", best, luts(most_accurate(range(len(images)))))

    for count in range(1, MOST_LUTS + 1):

        def select(chosen: Sequence[int], count: int = count) -> WisardModel:
            return select_bits([images[i] for i in chosen], CLASSES, luts=count, seed=given.seed)

        show(f"bit selection, {count} LUT", *measured(images, select))

    for size in SIZES:
        show(f"neighbourhood {size}x{size}", *neighbourhood(dataset, size, given.seed))


def show(name: str, shares: Shares, luts: int | str = "") -> None:
    """Print a row of the table, of each image's share of right pixels."""
    low, high = prediction_interval(shares) or (0.0, 1.0)
    span = f"{low:.3f} to {high:.3f}"
    print(row([name, f"{shares.mean():.4f}", f"{shares.min():.3f}", span, luts]), flush=True)


def shares(images: Sequence[ColourHistogram], train: Trainer) -> Shares:
    """Share of each image's pixels that are right in cross-validation."""
    right = cross_validated(images, train, (1.0,))[:, 0]
    return np.asarray(right / [image.counts.sum() for image in images])


def measured(images: Sequence[ColourHistogram], train: Trainer) -> tuple[Shares, int]:
    """Shares of right pixels in cross-validation, and LUTs of the model trained on all images."""
    return shares(images, train), luts(train(range(len(images))))


def luts(model: WisardModel) -> int:
    """LUTs of a model's exact circuit."""
    return len(map_luts(pixel_table(model)).network.luts)


def neighbourhood(dataset: Dataset, size: int, seed: int) -> tuple[Shares, int]:
    """Shares of right pixels in cross-validation of tables over ``size`` x ``size`` pixels, and their LUTs.

    The LUTs are those of the whole circuit for one window, trained on all images, and just as many where
    pixels come as a stream: each table stands at one place of the window, so its answers need delays, but no
    copies.
    """

    def train(images: Dataset) -> WisardModel:
        return train_neighbourhood(images, size, luts_per_pixel=None, seed=seed, progress=silent)

    found: dict[str, float] = {}
    for training, test in folds(dataset.names, FOLDS):
        result = evaluate(model_classifier(train(dataset.subset(training))), dataset.subset(test), silent)
        found |= dict(zip(result.names, accuracy(result.confusion), strict=True))
    circuit = plan(train(dataset), "mine", CompileOptions(), silent).design
    needed = sum(len(network.luts) for network in circuit.networks.values())
    return np.array([found[name] for name in dataset.names]), needed


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def red_threshold(images: Sequence[ColourHistogram], chosen: Sequence[int]) -> WisardModel:
    """Deforested is what is at least as red as the threshold with the most training pixels right."""
    reds = sum(code_histogram(images[i], RED) for i in chosen)
    assert not isinstance(reds, int)
    above = reds[:, ::-1].cumsum(axis=1)[:, ::-1]
    right = above[1] + reds[0].sum() - above[0]
    answers = (np.arange(256) >= right.argmax()).astype(np.int64)
    return look_up_table(RED, CLASSES, answers, {})


def regression_shares(images: Sequence[ColourHistogram]) -> Shares:
    """Shares of right pixels in cross-validation of a logistic regression on RGB, squares and products."""
    found = np.zeros(len(images))
    for fold in range(FOLDS):
        answer = quadratic_regression([image for i, image in enumerate(images) if i % FOLDS != fold])
        for i in range(fold, len(images), FOLDS):
            image = images[i]
            right = image.counts[answer(image.pixels), np.arange(len(image.colours))].sum()
            found[i] = right / image.counts.sum()
    return found


def quadratic_regression(
    images: Sequence[ColourHistogram],
) -> Callable[[NDArray[np.uint8]], NDArray[np.int64]]:
    """Fit to the colours of images, each class's pixels as weights."""
    pixels = np.concatenate([image.pixels for image in images])
    weights = np.concatenate([image.counts for image in images], axis=1)
    used = weights.ravel() > 0
    samples = np.tile(pixels, (2, 1))[used].astype(np.float64)
    labels = np.repeat([0, 1], len(pixels))[used]
    model = make_pipeline(
        PolynomialFeatures(2, include_bias=False),
        StandardScaler(),
        LogisticRegression(solver="newton-cholesky"),
    )
    model.fit(samples, labels, logisticregression__sample_weight=weights.ravel()[used])
    return lambda colours: np.asarray(model.predict(colours.astype(np.float64)), dtype=np.int64)


if __name__ == "__main__":
    main()
