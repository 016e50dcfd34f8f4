"""Connected regions of a class raster that is read in strips: numbered once, and the same for any strips."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import Strip, read_strip
from wnn2hdl.apps.deforestation.ellipsoid import PixelAreas

if TYPE_CHECKING:
    from rasterio.io import DatasetReader

NO_REGION = -1
"""The number that pixels without data have in place of their region's."""


@dataclass(frozen=True, eq=False)
class Regions:
    """All regions of a raster: valid pixels of one class connected by their sides.

    Memory is about 35 bytes per region.

    Attributes:
        pixels: int64 ``[regions]``.
        square_metres: float64 ``[regions]``, the sum of their pixels' areas on the ellipsoid; NaN if unknown.
        classes: uint8 ``[regions]``, class indices.
        last_strip: int32 ``[regions]``, the last strip with a part of the region.
        parts: int32 ``[parts]``, the region of each strip's connected parts, strip after strip.
        starts: the first part of each strip, and in the end the number of parts.
    """

    pixels: NDArray[np.int64]
    square_metres: NDArray[np.float64]
    classes: NDArray[np.uint8]
    last_strip: NDArray[np.int32]
    parts: NDArray[np.int32]
    starts: tuple[int, ...]

    def label(self, index: int, strip: Strip) -> NDArray[np.int32]:
        """The region of every pixel of strip number ``index``, or `NO_REGION`: int32 ``[rows, width]``."""
        mine = self.parts[self.starts[index] : self.starts[index + 1]]
        return np.concatenate([np.array([NO_REGION], np.int32), mine])[_parts(strip)[0]]


def find_regions(
    dataset: "DatasetReader",
    strips: Sequence[tuple[int, int]],
    progress: Callable[[int], None],
    areas: PixelAreas | None = None,
) -> Regions:
    """Number the regions of an open class raster, in the order of their first parts.

    Args:
        dataset: the raster.
        strips: first row and end of each strip.
        progress: called with the number of strips done.
        areas: of the raster's pixels; None where regions need none.
    """
    from scipy import sparse

    starts, pixels, square_metres, classes, joints = [0], [], [], [], []
    above: tuple[NDArray[np.int64], NDArray[np.uint8]] | None = None
    for number, rows in enumerate(strips):
        strip = read_strip(dataset, rows)
        labels, part_classes = _parts(strip)
        pixels.append(np.bincount(labels.ravel(), minlength=len(part_classes) + 1)[1:])
        if areas:
            weights = areas.rows(*rows).ravel()
            square_metres.append(np.bincount(labels.ravel(), weights, minlength=len(part_classes) + 1)[1:])
        classes.append(part_classes)
        # Numbers over all strips; pixels without data keep a negative one.
        first, last = (np.where(labels[i] > 0, labels[i] + starts[-1] - 1, NO_REGION) for i in (0, -1))
        if above is not None:
            joined = (above[0] >= 0) & (first >= 0) & (above[1] == strip.classes[0])
            joints.append(np.unique(np.stack([above[0][joined], first[joined]]), axis=1))
        above = last, strip.classes[-1]
        starts.append(starts[-1] + len(part_classes))
        progress(number + 1)
    pairs = np.concatenate(joints, axis=1) if joints else np.zeros((2, 0), np.int64)
    graph = sparse.coo_array((np.ones(pairs.shape[1], np.int8), tuple(pairs)), shape=(starts[-1],) * 2)
    count, regions = sparse.csgraph.connected_components(graph, directed=False)
    region_classes = np.zeros(count, np.uint8)
    region_classes[regions] = np.concatenate(classes)
    last_strip = np.zeros(count, np.int32)
    np.maximum.at(last_strip, regions, np.repeat(np.arange(len(strips), dtype=np.int32), np.diff(starts)))
    total, area = np.zeros(count, np.int64), np.full(count, 0.0 if areas else np.nan)
    np.add.at(total, regions, np.concatenate(pixels))
    if areas:
        np.add.at(area, regions, np.concatenate(square_metres))
    return Regions(total, area, region_classes, last_strip, regions.astype(np.int32), tuple(starts))


def _parts(strip: Strip) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """The connected parts of one strip.

    Returns:
        int32 ``[rows, width]``, 0 without data and else the part's number from 1; and each part's class.
    """
    from scipy import ndimage  # other commands need not wait for it

    labels = np.zeros(strip.classes.shape, dtype=np.int32)
    classes: list[NDArray[np.uint8]] = []
    count = 0
    for index in np.flatnonzero(np.bincount(strip.classes[strip.valid], minlength=256)).tolist():
        of_class = (strip.classes == index) & strip.valid
        found, parts = ndimage.label(of_class)
        labels[of_class] = found[of_class] + count
        count += parts
        classes.append(np.full(parts, index, dtype=np.uint8))
    return labels, np.concatenate(classes) if classes else np.zeros(0, np.uint8)
