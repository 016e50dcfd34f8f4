"""Accuracy on unseen images under more light and less, of classifiers of single pixels.

    python benchmarks/light.py IMAGES MASKS [--seed 0]

Five-fold cross-validation by image over a folder of pictures and one of masks. Each image that a fold leaves
out is judged with all its levels multiplied, rounded, and saturated at 255. A threshold is the best of its
fold's training pixels, taken as they are.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from benchmarks.scenes import scene_parser
from wnn2hdl.dataset import CLASSES, ColourHistogram, colour_histogram, from_masks
from wnn2hdl.ir import Comparison, Relational, WisardModel
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bitselect import MOST_LUTS, look_up_table, select_bits
from wnn2hdl.training.crossval import EXPOSURES, shares_right

SHAPES = {name: Comparison.parse(name) for name in ("R>=0", "R>=B", "3R>=2B")}
"""Comparisons, whose offset is trained."""

Trainer = Callable[[Sequence[ColourHistogram]], WisardModel]


def main() -> None:
    """Print the table."""
    given = scene_parser(__doc__).parse_args()
    images = [colour_histogram(image, len(CLASSES)) for image in from_masks(given.images, given.masks)]
    trainers: dict[str, Trainer] = {
        f"{name} + t": partial(threshold, shape) for name, shape in SHAPES.items()
    }
    for luts in range(1, MOST_LUTS + 1):
        trainers[f"bit selection, {luts} LUT"] = partial(bit_selection, luts, given.seed)
    print(head(["classifier", *(f"x{exposure:g}" for exposure in EXPOSURES)]))
    for name, train in trainers.items():
        accuracies = by_exposure(images, train).mean(axis=0)
        print(row([name, *(f"{accuracy:.3f}" for accuracy in accuracies)]), flush=True)


def threshold(shape: Comparison, images: Sequence[ColourHistogram]) -> WisardModel:
    """The comparison with the offset that gets most of the images' pixels right."""
    slacks = [shape.slack(image.pixels) for image in images]
    lowest, highest = min(map(np.min, slacks)), max(map(np.max, slacks))
    counts = np.zeros((2, highest - lowest + 2), dtype=np.int64)
    for image, slack in zip(images, slacks, strict=True):
        for index, found in enumerate(image.counts):
            counts[index] += np.bincount(slack - lowest, found, counts.shape[1]).astype(np.int64)
    # At a threshold, forest is right below it and cleared ground from it on.
    below = counts[0].cumsum() - counts[0]
    above = counts[1].sum() - counts[1].cumsum() + counts[1]
    offset = int((below + above).argmax() + lowest)
    encoder = Relational((str(Comparison(shape.left, shape.right, offset)),))
    return look_up_table(encoder, CLASSES, np.arange(2), {})


def bit_selection(luts: int, seed: int, images: Sequence[ColourHistogram]) -> WisardModel:
    """The most accurate classifier of so many LUTs per pixel."""
    return select_bits(images, CLASSES, luts=luts, seed=seed)


def by_exposure(images: Sequence[ColourHistogram], train: Trainer) -> NDArray[np.float64]:
    """Share of right pixels of each unseen image at each exposure: ``[images, exposures]``."""
    return shares_right(images, lambda chosen: train([images[i] for i in chosen]))


if __name__ == "__main__":
    main()
