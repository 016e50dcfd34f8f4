"""Colours counted by class: all that a classifier of single pixels can learn from, and far smaller."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset.labelled import LabelledImage


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
