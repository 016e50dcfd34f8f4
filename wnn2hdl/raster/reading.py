"""Windows of a raster as red, green and blue of 8 bits, with what the file states to be no data."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.muted import muted
from wnn2hdl.raster.channels import choose_channels
from wnn2hdl.raster.gdal import Georeference
from wnn2hdl.raster.handles import Handles
from wnn2hdl.raster.levels import Levels
from wnn2hdl.raster.validity import AlphaMeaning, Validity, masking_alpha

MOST_PIXELS = 178_956_970
"""What is decoded at once: twice what Pillow warns of, where it refuses a picture."""

ORIENTATION_TAG = 0x0112
_UPRIGHT = 1
_SHOWN = 255


@dataclass(frozen=True)
class Reading:
    """How a picture is read.

    Attributes:
        bands: band numbers from 1 of red, green and blue, or of one band; None for what the file states.
        scale: values ``(low, high)`` that become 0 and 255; what lies beyond is cut off. None for 8-bit
            samples as they are. Where the file states a scale and an offset, the values are in its units.
        alpha: what a band marked as alpha holds; None excludes pixels by it, and refuses one that looks like
            data.
        exclude: a raster of the same size whose pixels other than 0 are left out (clouds).
    """

    bands: tuple[int, ...] | None = None
    scale: tuple[float, float] | None = None
    alpha: AlphaMeaning | None = None
    exclude: Path | None = None


class RasterReader:
    """A raster that is read in windows, by several threads at once if need be.

    `Validity` says what is valid, as do the transparent entries of a colour table.

    Args:
        path: a file of one of the formats of `wnn2hdl.raster.formats`.
        reading: how; `exclude` is not looked at here.

    Attributes:
        height: pixels.
        width: pixels.
        block: height and width of the blocks that the file is stored in.
        note: what had to be assumed about its bands and pages.
        files: what GDAL reads for it: the file itself and those beside it.

    Raises:
        InputError: the file cannot be read or points at others; its bands are not named; its samples have
            other than 8 bits, a scale or an offset and no scaling was given, or are complex; its alpha looks
            like data and it is not said what it is; or it is stored in blocks too large to be read.
        ExtraMissingError: rasterio is not installed.
    """

    def __init__(self, path: Path, reading: Reading) -> None:
        self._path = path
        self._handles = Handles(path)
        with self._handles.borrowed() as source:
            self.height, self.width = int(source.height), int(source.width)
            self.block: tuple[int, int] = source.block_shapes[0]
            require_decodable(path, *self.block, hint="save it in tiles: gdal_translate -co TILED=YES")
            kinds = tuple(x.name for x in source.colorinterp)
            self._channels = choose_channels(path, kinds, source.descriptions, reading.bands)
            self.note = "; ".join(filter(None, [self._channels.note, _pages(source)]))
            self.files: tuple[Path, ...] = tuple(map(Path, source.files))
            self._palette: NDArray[np.uint8] | None = None
            self._levels: Levels | None = None
            if self._channels.palette:
                _refuse_scale(path, reading)
                self._palette = colour_table(source, path, self._channels.indexes[0])
            else:
                self._levels = Levels.of(source, path, self._channels, reading.scale)
            alpha = masking_alpha(source, path, reading.bands, reading.alpha)
            self._validity = self._impossible(Validity.of(source, path, self._channels.indexes, alpha))

    def _impossible(self, validity: Validity) -> Validity:
        levels = self._levels
        if levels is None:
            return validity
        return replace(
            validity,
            impossible=tuple(
                value is not None and levels.beyond(band, value) for band, value in enumerate(validity.nodata)
            ),
        )

    @cached_property
    def georeference(self) -> Georeference:
        """Where it lies; raises InputError if only control points say so, and no affine map fits them."""
        with self._handles.borrowed() as source:
            return Georeference.of(source)

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """A window that lies in the raster.

        Returns:
            uint8 ``[height, width, 3]``: red, green, blue; and which pixels are valid, bool
            ``[height, width]``, or None for all.

        Raises:
            InputError: the file is damaged there.
        """
        return self._picture(((row, row + height), (column, column + width)), (height, width))

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """The whole picture by its nearest pixels: uint8 ``[height, width, 3]``, for showing it."""
        return self._picture(((0, self.height), (0, self.width)), (height, width))[0]

    def _picture(
        self, window: tuple[tuple[int, int], tuple[int, int]], shape: tuple[int, int]
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        indexes, alpha = self._channels.indexes, self._validity.alpha
        bands = [*indexes] if alpha is None else [*indexes, alpha]
        with self._handles.borrowed() as source:
            stored = source.read(bands, window=window, out_shape=(len(bands), *shape))
            samples = stored[: len(indexes)]
            opacity = None if alpha is None else stored[-1]
            where = {"window": window, "out_shape": shape}
            valid = self._validity.read(source, samples, opacity, where)
        if self._palette is not None:
            colours = self._palette[samples[0]]
            shown = colours[..., 3] == _SHOWN
            return np.ascontiguousarray(colours[..., :3]), shown if valid is None else valid & shown
        assert self._levels is not None
        levels = np.moveaxis(self._levels.apply(samples), 0, 2)
        return np.broadcast_to(levels, (*shape, 3)), valid


def stored_orientation(path: Path) -> int:
    """How a picture is stored, as EXIF numbers it from 1, upright; 1 also where Pillow does not know."""
    try:
        # Pillow warns of large pictures and refuses larger ones; only the head is read here.
        with muted(), Image.open(path) as picture:
            return int(picture.getexif().get(ORIENTATION_TAG, _UPRIGHT))
    except (OSError, SyntaxError, ValueError, TypeError, KeyError, Image.DecompressionBombError):
        return _UPRIGHT


def require_upright(path: Path, orientation: int) -> None:
    """Raise InputError unless a picture is stored as it is to be viewed: its ``orientation`` is 1."""
    if orientation != _UPRIGHT:
        raise InputError(
            f"the picture is stored turned (orientation {orientation})", value=path, hint="save it upright"
        )


def require_decodable(path: Path, height: int, width: int, *, hint: str = "cut it into tiles") -> None:
    """Raise InputError if a picture has too many pixels to be decoded at once."""
    if height * width > MOST_PIXELS:
        raise InputError(
            f"the picture is too large to be read at once; the limit is {MOST_PIXELS:,} pixels",
            value=f"{path} ({width}x{height})",
            hint=hint,
        )


def colour_table(source: Any, path: Path, band: int) -> NDArray[np.uint8]:
    """The colour table of a band: uint8 ``[256, 4]``, red, green, blue, alpha.

    Raises:
        InputError: its indices are not of 8 bits.
    """
    if source.dtypes[band - 1] != "uint8":
        raise InputError(
            f"the colour table is of {source.dtypes[band - 1]} indices",
            value=path,
            hint="make it red, green and blue first, for instance with gdal_translate -expand rgb",
        )
    table = np.zeros((256, 4), dtype=np.uint8)
    for index, colour in source.colormap(band).items():
        table[index] = colour
    return table


def _refuse_scale(path: Path, reading: Reading) -> None:
    if reading.scale is not None:
        raise InputError(
            "the file holds indices of a colour table, which no scale fits",
            value=path,
            hint="leave --scale out",
        )


def _pages(source: Any) -> str:
    pages = len(source.subdatasets)
    return f"the file holds {pages} pictures; the first one is read" if pages > 1 else ""
