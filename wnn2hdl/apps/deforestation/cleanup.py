"""Cleaning class maps: majority of the neighbourhood, and a minimum mapping unit."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import (
    STRIP_PIXELS,
    colours,
    open_classes,
    read_strip,
    strip_rows,
)
from wnn2hdl.apps.deforestation.ellipsoid import SQUARE_METRES, PixelAreas
from wnn2hdl.apps.deforestation.regions import NO_REGION, Regions, find_regions
from wnn2hdl.progress import Progress
from wnn2hdl.raster import NODATA, ClassWriter, Georeference


def despeckle(classes: NDArray[np.uint8], valid: NDArray[np.bool_], radius: int) -> NDArray[np.uint8]:
    """Give each pixel the class of most valid pixels in the square of ``2 * radius + 1`` around it.

    A pixel keeps its class where that class has as many as any other; otherwise the lowest of the most
    frequent classes wins. Beyond the picture nothing is counted. The result depends on no more than
    ``radius`` pixels around, so a window read with a halo of ``radius`` gives what the whole picture would.

    Args:
        classes: uint8 ``[height, width]``.
        valid: bool ``[height, width]``; other pixels do not vote and are returned as they are.
        radius: at least 0; 0 changes nothing.

    Returns:
        uint8 ``[height, width]``.
    """
    side = 2 * radius + 1
    most = np.zeros(classes.shape, dtype=np.int32)
    own = np.zeros_like(most)
    winner = classes.copy()
    for index in np.unique(classes[valid]).tolist():
        of_class = (classes == index) & valid
        votes = cv2.boxFilter(
            of_class.view(np.uint8), cv2.CV_32S, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT
        )
        own[of_class] = votes[of_class]
        winner[votes > most] = index
        np.maximum(most, votes, out=most)
    keep = ~valid | (own == most)
    winner[keep] = classes[keep]
    return winner


@dataclass(frozen=True)
class MinimumSize:
    """The minimum mapping unit: regions below either limit are too small.

    Attributes:
        pixels: of a region.
        hectares: of a region, on the ellipsoid: the sum of the areas of its own pixels, which may be a third
            of those at the equator.
    """

    pixels: int = 0
    hectares: float = 0

    def below(self, regions: Regions) -> NDArray[np.bool_]:
        """Which regions are too small: bool ``[regions]``."""
        small = regions.pixels < self.pixels
        return small | (regions.square_metres < self.hectares * SQUARE_METRES) if self.hectares else small


def sieve_in_place(raster: Path, minimum: MinimumSize, progress: Progress) -> None:
    """As `sieve_raster`, the result instead of the raster."""
    sieved = raster.with_name(f"sieved-{raster.name}")
    sieve_raster(raster, sieved, minimum, progress)
    sieved.replace(raster)


def sieve_raster(
    source: Path,
    output: Path,
    minimum: MinimumSize,
    progress: Progress,
    *,
    strip_pixels: int = STRIP_PIXELS,
) -> int:
    """Dissolve regions below a minimum size into what surrounds them.

    A region is a set of valid pixels of one class connected by their sides, over the whole raster. A small
    one takes the class of the large regions along most of its border (the lowest class if several share the
    most); one that touches small regions only, or nothing, stays. So does GDAL's sieve for a speck in a
    field; it takes the largest neighbour instead of the longest border, and needs the whole raster in
    memory, which this does not: memory holds one strip, and about 40 bytes for each region.

    Args:
        source: a class raster.
        output: where to write the result, with the same georeference and colours.
        minimum: the minimum mapping unit; one in hectares needs a raster with a georeference.
        progress: called with each strip, three times over.
        strip_pixels: how many pixels are worked on at a time; the result does not depend on it.

    Returns:
        how many regions were dissolved.

    Raises:
        ExtraMissingError: the extra ``geo`` is not installed.
        InputError: a file cannot be read or written.
    """
    with open_classes(source) as dataset:
        strips = strip_rows(dataset, strip_pixels)
        place = Georeference.of(dataset)
        areas = PixelAreas(place, *dataset.shape) if minimum.hectares else None
        regions = find_regions(
            dataset, strips, lambda done: progress("finding regions", done, len(strips)), areas
        )
        borders = _Borders(regions, minimum.below(regions))
        for index, rows in enumerate(strips):
            borders.add(regions.label(index, read_strip(dataset, rows)))
            progress("measuring borders", index + 1, len(strips))
        classes = borders.dissolved()
        with ClassWriter(output, dataset.height, dataset.width, place, colours(dataset)) as written:
            for index, rows in enumerate(strips):
                strip = read_strip(dataset, rows)
                new = classes[regions.label(index, strip)]
                written.write(np.where(strip.valid, new, np.uint8(NODATA)))
                progress("dissolving regions", index + 1, len(strips))
    return int(np.count_nonzero(classes[:-1] != regions.classes))


class _Borders:
    """How long the border of each small region is with the large regions of each class."""

    def __init__(self, regions: Regions, small: NDArray[np.bool_]) -> None:
        self._regions = regions
        self._small = np.flatnonzero(small)
        # One more entry than regions: NO_REGION is the last one's index, and belongs to no small region.
        self._place = np.full(len(regions.pixels) + 1, -1, dtype=np.int32)
        self._place[self._small] = np.arange(len(self._small), dtype=np.int32)
        self._classes = int(regions.classes.max(initial=0)) + 1
        self._lengths = np.zeros(len(self._small) * self._classes, dtype=np.int32)
        self._above: NDArray[np.int32] | None = None

    def add(self, labels: NDArray[np.int32]) -> None:
        """Count the borders in the next strip, and with the one before: int32 ``[rows, width]``, regions."""
        if self._above is not None:
            self._count(self._above, labels[0])
        self._count(labels[:-1], labels[1:])
        self._count(labels[:, :-1], labels[:, 1:])
        self._above = labels[-1].copy()

    def _count(self, one: NDArray[np.int32], other: NDArray[np.int32]) -> None:
        border = one != other
        sides = one[border], other[border]
        for inner, outer in (sides, sides[::-1]):
            counted = (self._place[inner] >= 0) & (self._place[outer] < 0) & (outer != NO_REGION)
            key = self._place[inner[counted]].astype(np.int64) * self._classes
            np.add.at(self._lengths, key + self._regions.classes[outer[counted]], 1)

    def dissolved(self) -> NDArray[np.uint8]:
        """Each region's class after all, uint8 ``[regions + 1]``, the last one to be had by `NO_REGION`."""
        classes = np.append(self._regions.classes, np.uint8(0))
        lengths = self._lengths.reshape(-1, self._classes)
        found = lengths.any(axis=1)
        classes[self._small[found]] = lengths[found].argmax(axis=1)
        return classes
