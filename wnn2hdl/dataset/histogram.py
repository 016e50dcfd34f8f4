"""Colours counted by class: all that a classifier of single pixels can learn from, and far smaller."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset.labelled import Dataset, LabelledImage
from wnn2hdl.errors import InputError


@dataclass(frozen=True, eq=False)
class ColourHistogram:
    """How often each colour occurs in each class.

    Attributes:
        colours: uint32 ``[u]``, ``0xRRGGBB``, ascending, each once.
        counts: int64 ``[classes, u]``.
    """

    colours: NDArray[np.uint32]
    counts: NDArray[np.int64]

    @property
    def pixels(self) -> NDArray[np.uint8]:
        """The colours as uint8 ``[u, 3]``."""
        return np.stack([self.colours >> 16, self.colours >> 8, self.colours], axis=1).astype(np.uint8)


def colour_histogram(image: LabelledImage, classes: int) -> ColourHistogram:
    """The colours of one image, counted for each of ``classes`` classes."""
    red, green, blue = image.pixels.T.astype(np.uint32)
    packed = red << 16 | green << 8 | blue
    colours, place = np.unique(packed, return_inverse=True)
    cells = image.labels.astype(np.int64) * len(colours) + place
    counts = np.bincount(cells, minlength=classes * len(colours)).reshape(classes, len(colours))
    return ColourHistogram(colours, counts.astype(np.int64))


def training_histogram(dataset: Dataset) -> ColourHistogram:
    """The colours of a whole set; one image is in memory at a time.

    Raises:
        InputError: a class has no pixel, so that nothing can be learned of it.
    """
    total = ColourHistogram(np.zeros(0, np.uint32), np.zeros((len(dataset.classes), 0), np.int64))
    for image in dataset:
        total = _add(total, colour_histogram(image, len(dataset.classes)))
    empty = [
        name for name, pixels in zip(dataset.classes, total.counts.sum(axis=1), strict=True) if not pixels
    ]
    if empty:
        raise InputError(
            f"no training pixel is labelled {' or '.join(empty)}",
            value=f"{len(dataset)} images",
            hint="add images that show every class",
        )
    return total


def _add(one: ColourHistogram, other: ColourHistogram) -> ColourHistogram:
    colours, place = np.unique(np.concatenate([one.colours, other.colours]), return_inverse=True)
    counts = np.zeros((len(one.counts), len(colours)), dtype=np.int64)
    # A colour occurs at most once in each histogram, so plain indexed addition is safe twice.
    counts[:, place[: len(one.colours)]] += one.counts
    counts[:, place[len(one.colours) :]] += other.counts
    return ColourHistogram(colours, counts)
