"""The picture that is scanned: plain pictures as the rest of the project reads them, all else in windows."""

from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.images import read_rgb
from wnn2hdl.raster import PICTURE_DRIVERS, Georeference, RasterReader, Reading

PLAIN_PIXELS = 1 << 26
"""Plain pictures up to this size (67 million pixels) are read whole; decoding takes 7 bytes a pixel."""


class Source(Protocol):
    """A picture that is read in windows, by several threads at once."""

    height: int
    width: int
    block: tuple[int, int]
    """Height and width of the blocks it is stored in; windows made of whole ones are read the quickest."""
    georeference: Georeference
    note: str
    """What had to be assumed about its bands, for the summary."""

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """A window: uint8 ``[height, width, 3]``, and which pixels are valid, or None for all."""

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """The whole picture by its nearest pixels: uint8 ``[height, width, 3]``."""


class PlainPicture:
    """A picture in memory; the attributes are those of `Source`.

    Args:
        pixels: uint8 ``[height, width, 3]``: red, green, blue.
        valid: bool ``[height, width]``; None for all.
        georeference: as a world file beside the picture tells.
    """

    note = ""

    def __init__(
        self,
        pixels: NDArray[np.uint8],
        valid: NDArray[np.bool_] | None = None,
        georeference: Georeference = Georeference(),  # noqa: B008  # frozen
    ) -> None:
        self._pixels, self._valid, self.georeference = pixels, valid, georeference
        self.height, self.width = pixels.shape[:2]
        self.block = (1, self.width)

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """See `Source.read`."""
        window = np.s_[row : row + height, column : column + width]
        return self._pixels[window], None if self._valid is None else self._valid[window]

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """See `Source.thinned`."""
        rows = (2 * np.arange(height) + 1) * self.height // (2 * height)
        columns = (2 * np.arange(width) + 1) * self.width // (2 * width)
        return np.asarray(self._pixels[rows[:, np.newaxis], columns])


def open_source(path: Path, reading: Reading) -> Source:
    """Open a picture.

    Plain pictures (JPEG, PNG, BMP) of 8 bits without transparency are turned upright and converted as
    `wnn2hdl.images.read_rgb` does, so that a scan sees the bytes that a training saw: GDAL decodes the
    colours of most JPEGs a little differently. Beyond `PLAIN_PIXELS` they are read in windows all the same,
    and that is slow; a tiled GeoTIFF is the format for them.

    Raises:
        InputError: it cannot be read, or it is not said how, see `RasterReader`; or it is to be turned
            upright, and is not plain or has a mask.
        ExtraMissingError: rasterio is not installed.
    """
    raster = RasterReader(path, reading)
    size = (raster.height, raster.width)
    plain = raster.plain and raster.driver in PICTURE_DRIVERS and size[0] * size[1] <= PLAIN_PIXELS
    if raster.masked or not plain:
        raster.require_upright()
    if not plain:
        return raster
    valid = raster.read(0, 0, *size)[1] if raster.masked else None
    # A world file tells where the stored pixels lie, not the turned ones.
    place = raster.georeference if raster.upright else Georeference()
    return PlainPicture(read_rgb(path), valid, place)
