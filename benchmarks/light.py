"""Accuracy on unseen images under more light and less, of classifiers of single pixels.

    python benchmarks/light.py IMAGES MASKS [--seed 0]

Five-fold cross-validation by image over a folder of pictures and one of masks. Each image that a fold leaves
out is judged with all its levels multiplied, rounded, and saturated at 255. A threshold is the best of its
fold's training pixels, taken as they are.
"""

import argparse
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import CLASSES, ColourHistogram, colour_histogram, from_masks
from wnn2hdl.images import exposed
from wnn2hdl.ir import pixel_encoder
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bitselect import MOST_LUTS, select_bits
from wnn2hdl.training.crossval import EXPOSURES, FOLDS

WEIGHTS = {"R": (1, 0, 0), "R - B": (1, 0, -1), "3R - 2B": (3, 0, -2)}
"""Of red, green and blue, in a sum that is compared with a threshold."""

Classifier = Callable[[NDArray[np.uint8]], NDArray[np.integer]]
"""Class indices ``[n]`` of pixels uint8 ``[n, 3]``."""
Trainer = Callable[[Sequence[ColourHistogram]], Classifier]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("images", type=Path)
    parser.add_argument("masks", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    images = [colour_histogram(image, len(CLASSES)) for image in from_masks(given.images, given.masks)]
    trainers: dict[str, Trainer] = {f"{name} >= t": partial(threshold, w) for name, w in WEIGHTS.items()}
    for luts in range(1, MOST_LUTS + 1):
        trainers[f"bit selection, {luts} LUT"] = partial(bit_selection, luts, given.seed)
    print(head(["classifier", *(f"x{exposure:g}" for exposure in EXPOSURES)]))
    for name, train in trainers.items():
        accuracies = by_exposure(images, train).mean(axis=0)
        print(row([name, *(f"{accuracy:.3f}" for accuracy in accuracies)]), flush=True)


def threshold(weights: tuple[int, int, int], images: Sequence[ColourHistogram]) -> Classifier:
    """Compare a sum of the channels with the threshold that gets most of the images' pixels right."""
    lowest, highest = (255 * sum(w for w in weights if w * sign > 0) for sign in (-1, 1))
    counts = np.zeros((2, highest - lowest + 2), dtype=np.int64)
    for image in images:
        for index, found in enumerate(image.counts):
            level = image.pixels.astype(np.int64) @ weights - lowest
            counts[index] += np.bincount(level, found, counts.shape[1]).astype(np.int64)
    # At a threshold, forest is right below it and cleared ground from it on.
    below = counts[0].cumsum() - counts[0]
    above = counts[1].sum() - counts[1].cumsum() + counts[1]
    best = int((below + above).argmax()) + lowest
    return lambda pixels: (pixels.astype(np.int64) @ weights >= best).astype(np.int64)


def bit_selection(luts: int, seed: int, images: Sequence[ColourHistogram]) -> Classifier:
    """The most accurate classifier of so many LUTs per pixel."""
    model = select_bits(images, CLASSES, luts=luts, seed=seed)
    encoder, classes = pixel_encoder(model), model.evaluate_all_codes()
    return lambda pixels: classes[encoder.codes(pixels)]


def by_exposure(images: Sequence[ColourHistogram], train: Trainer) -> NDArray[np.float64]:
    """Share of right pixels of each unseen image at each exposure: ``[images, exposures]``."""
    shares = np.zeros((len(images), len(EXPOSURES)))
    for fold in range(FOLDS):
        classify = train([image for place, image in enumerate(images) if place % FOLDS != fold])
        for place in range(fold, len(images), FOLDS):
            image = images[place]
            for column, exposure in enumerate(EXPOSURES):
                found = classify(exposed(image.pixels, exposure))
                right = image.counts[found, np.arange(len(found))].sum()
                shares[place, column] = right / image.counts.sum()
    return shares


if __name__ == "__main__":
    main()
