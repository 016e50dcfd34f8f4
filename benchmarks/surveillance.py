"""Deforestation on unseen images, beside common classifiers, in changed light and square by square.

    python benchmarks/surveillance.py IMAGES MASKS [--seed 0] [--mappings 5] [--pixels 5000] [--squares]

Five folds by image. Rivals are trained on equally many pixels of each training image, drawn at random; what
has a circuit is trained on whole images, as `wnn2hdl train` does it. The table gives the mean share of right
pixels of an image with all levels multiplied by each exposure, as a camera saturates, the worst image at x1,
and the LUTs per pixel of what has a circuit, trained on all images.

With --squares it gives pixels and squares of the reference design instead: 20 x 20, half of the pixels vote;
they are scored against the majority of each square of the mask, and against its pixels.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from benchmarks.light import SHAPES, threshold
from benchmarks.pixel_networks import EVERY, PAIRS, thermometers
from benchmarks.rivals import (
    TREES,
    Threshold,
    boosting,
    excess_green,
    forest,
    levels,
    linear,
    normalised_difference,
    of_colours,
    of_context,
    of_varied_colours,
    quadratic,
    ratios,
)
from benchmarks.scenes import scene_parser
from wnn2hdl.dataset import CLASSES, Dataset, colour_histogram, folds, from_masks
from wnn2hdl.encode import high_bits
from wnn2hdl.evaluation.accuracy import Squares, evaluate, majority_labels
from wnn2hdl.evaluation.classifiers import PictureClassifier, model_classifier
from wnn2hdl.evaluation.light import light_curve
from wnn2hdl.evaluation.measures import accuracy, ious
from wnn2hdl.ir import Comparison, PixelEncoder, Relational, WisardModel
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bitselect import LUTS, select_bits
from wnn2hdl.training.budget import WITHIN, pixel_luts
from wnn2hdl.training.comparisons import draw_pixels, select_comparisons
from wnn2hdl.training.crossval import EXPOSURES
from wnn2hdl.training.discriminators import train
from wnn2hdl.training.folds import FOLDS
from wnn2hdl.training.neighbourhood import train_neighbourhood

SIDE, SHARE = 20, 0.5

RATIO_WISARDS = ((4, 16), (6, 16), (6, 48))
"""Thresholds of R/B, and of R/G, that discriminators read, and their RAMs: 48 are three of 16 that vote."""

Trainer = Callable[[Dataset], PictureClassifier]
ModelTrainer = Callable[[Dataset], WisardModel]


def main() -> None:
    """Print the table."""
    parser = scene_parser(__doc__)
    parser.add_argument("--mappings", type=int, default=5)
    parser.add_argument("--pixels", type=int, default=5000)
    parser.add_argument("--squares", action="store_true")
    given = parser.parse_args()
    dataset = from_masks(given.images, given.masks)
    print(
        f"{len(dataset)} images, {FOLDS} folds, {given.pixels} training pixels an image, seed {given.seed}\n"
    )
    if given.squares:
        columns = ["pixels right", "IoU", "squares right", "IoU", "pixels of squares right", "IoU"]
    else:
        columns = ["LUTs per pixel", *(f"x{exposure:g}" for exposure in EXPOSURES), "worst image"]
    print(head(["classifier", *columns]))
    models = circuits(given.mappings, given.seed)
    trainers = rivals(given.pixels, given.seed)
    trainers |= {name: [classifying(one) for one in several] for name, several in models.items()}
    for name, several in trainers.items():
        if given.squares:
            results = [by_squares(dataset, trainer, given.seed) for trainer in several]
            print(row([name, *np.mean(results, axis=0).tolist()]), flush=True)
        else:
            shares = np.mean([in_light(dataset, trainer) for trainer in several], axis=0)
            needed = luts(models[name][0](dataset)) if name in models else ""
            print(row([name, needed, *printed(shares)]), flush=True)


def rivals(pixels: int, seed: int) -> dict[str, list[Trainer]]:
    """What has no circuit here: one trainer for each row of the table."""
    trees, boosted = partial(forest, seed), partial(boosting, seed)
    drawn = (pixels, seed)
    return {
        "(R - G) / (R + G) >= t": [partial(of_colours, Threshold, normalised_difference(0, 1), *drawn)],
        "(R - B) / (R + B) >= t": [partial(of_colours, Threshold, normalised_difference(0, 2), *drawn)],
        "excess green below t": [partial(of_colours, Threshold, excess_green, *drawn)],
        "linear logistic regression": [partial(of_colours, linear, levels, *drawn)],
        "quadratic logistic regression": [partial(of_colours, quadratic, levels, *drawn)],
        "the same of log R/B, log R/G": [partial(of_colours, quadratic, ratios, *drawn)],
        f"random forest of {TREES} trees": [partial(of_colours, trees, levels, *drawn)],
        "gradient boosting": [partial(of_colours, boosted, levels, *drawn)],
        "the same under varied light": [partial(of_varied_colours, boosted, levels, *drawn)],
        "gradient boosting of log R/B, log R/G": [partial(of_colours, boosted, ratios, *drawn)],
        "the same with means and deviations to 31": [partial(of_context, boosted, ratios, *drawn)],
        "gradient boosting of RGB with the same": [partial(of_context, boosted, levels, *drawn)],
    }


def circuits(mappings: int, seed: int) -> dict[str, list[ModelTrainer]]:
    """What has a circuit: each row of the table is the mean over its trainers."""

    def discriminators(mapping: int) -> ModelTrainer:
        return lambda dataset: train(
            dataset, high_bits(), address_bits=4, rams=16, bleaching=None, seed=mapping, progress=silent
        )

    def of_ratios(levels: int, rams: int, mapping: int) -> ModelTrainer:
        def discriminators(dataset: Dataset) -> WisardModel:
            images = [colour_histogram(image, len(CLASSES)) for image in dataset]
            drawn = draw_pixels(images, np.random.default_rng(seed), smooth=False)
            bits = Relational(thermometers(drawn.pixels[::EVERY], PAIRS[:2], levels))
            return train(
                dataset, bits, address_bits=4, rams=rams, bleaching=None, seed=mapping, progress=silent
            )

        return discriminators

    def bit_selection(count: int, dataset: Dataset) -> WisardModel:
        images = [colour_histogram(image, len(CLASSES)) for image in dataset]
        return select_bits(images, CLASSES, luts=count, seed=seed)

    def comparisons(count: int, smooth: bool, dataset: Dataset) -> WisardModel:
        images = [colour_histogram(image, len(CLASSES)) for image in dataset]
        return select_comparisons(images, CLASSES, luts=count, seed=seed, smooth=smooth)

    def compared(shape: Comparison, dataset: Dataset) -> WisardModel:
        return threshold(shape, [colour_histogram(image, len(CLASSES)) for image in dataset])

    def neighbourhood(size: int) -> ModelTrainer:
        return lambda dataset: train_neighbourhood(
            dataset, size, luts_per_pixel=None, seed=seed, progress=silent
        )

    found: dict[str, list[ModelTrainer]] = {
        f"{name} + t": [partial(compared, shape)] for name, shape in SHAPES.items()
    }
    found[f"WiSARD n = 4, k = 16, mean of {mappings} mappings"] = [
        discriminators(seed + i) for i in range(mappings)
    ]
    found |= {
        f"the same of {2 * levels} ratios, k = {rams}": [
            of_ratios(levels, rams, seed + i) for i in range(mappings)
        ]
        for levels, rams in RATIO_WISARDS
    }
    found |= {f"bit selection, {count} LUT": [partial(bit_selection, count)] for count in (1, 2)}
    found |= {
        f"comparisons of channels, {count} LUTs{', smooth aim' if smooth else ''}": [
            partial(comparisons, count, smooth)
        ]
        for count in WITHIN
        for smooth in (False, True)
    }
    return found | {f"{size}x{size} neighbourhood": [neighbourhood(size)] for size in (3, 5)}


def classifying(trainer: ModelTrainer) -> Trainer:
    """The trainer of the classifier that a model is."""
    return lambda dataset: model_classifier(trainer(dataset))


def luts(model: WisardModel) -> int:
    """LUTs per pixel of a model's exact circuit; a neighbourhood's are known."""
    return pixel_luts(model) if isinstance(model.encoder, PixelEncoder) else LUTS


def in_light(dataset: Dataset, trainer: Trainer) -> NDArray[np.float64]:
    """Share of right pixels of each image at each of `EXPOSURES`, in its fold: ``[images, exposures]``."""
    shares: dict[str, NDArray[np.float64]] = {}
    for training, held_out in folds(dataset.names, FOLDS):
        classifier = trainer(dataset.subset(training))
        curve = light_curve(classifier, dataset.subset(held_out), "exposure", EXPOSURES, silent)
        shares |= dict(zip(curve.names, accuracy(curve.confusion).T, strict=True))
    return np.stack([shares[name] for name in dataset.names])


def printed(shares: NDArray[np.float64]) -> list[str]:
    """The mean over images at each exposure, and the worst image at x1."""
    worst = shares[:, EXPOSURES.index(1.0)].min()
    return [f"{share:.3f}" for share in (*shares.mean(axis=0), worst)]


def by_squares(dataset: Dataset, trainer: Trainer, seed: int) -> list[float]:
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


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


if __name__ == "__main__":
    main()
