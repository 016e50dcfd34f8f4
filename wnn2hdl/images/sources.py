"""Pictures read in windows: plain ones from memory, all else from the file."""

import threading
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.images.plain import PlainHead, decode, plain_head
from wnn2hdl.raster import Exclusion, Georeference, RasterReader, Reading, format_of
from wnn2hdl.raster.formats import PNG
from wnn2hdl.raster.handles import Handles
from wnn2hdl.raster.reading import require_upright, stored_orientation
from wnn2hdl.raster.validity import AlphaMeaning

PLAIN_PIXELS = 1 << 24
"""PNGs beyond this size (17 million pixels) are read in windows: Pillow would hold them twice in memory."""

_WORLD_SUFFIXES = (".wld", ".pgw", ".pngw", ".jgw", ".jpgw", ".jpegw", ".bpw", ".bmpw")


class Source(Protocol):
    """A picture that is read in windows, by several threads at once."""

    height: int
    width: int
    block: tuple[int, int]
    """Height and width of the blocks it is stored in; windows made of whole blocks are read fastest."""
    note: str
    """What had to be assumed about it, for the summary."""
    files: tuple[Path, ...]
    """What is read for it."""

    @property
    def georeference(self) -> Georeference:
        """Where it lies; raises InputError if the file says so in a way that is not understood."""

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
    """

    note = ""
    files: tuple[Path, ...] = ()
    georeference = Georeference()

    def __init__(self, pixels: NDArray[np.uint8], valid: NDArray[np.bool_] | None = None) -> None:
        self._pixels, self._valid = pixels, valid
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


class PlainFile:
    """A plain picture, decoded when a window is first asked for; the attributes are those of `Source`.

    Args:
        path: a file that `plain_head` takes for plain.
        head: what its head says.
        alpha: what its alpha holds, see `Reading`.
    """

    note = ""

    def __init__(self, path: Path, head: PlainHead, alpha: AlphaMeaning | None) -> None:
        self._path, self._head, self._alpha = path, head, alpha
        self._lock = threading.Lock()
        self.height, self.width = head.height, head.width
        self.block = (1, self.width)
        self.files = (path, *self._world_files)

    @property
    def _world_files(self) -> tuple[Path, ...]:
        names = (self._path.with_suffix(x) for low in _WORLD_SUFFIXES for x in (low, low.upper()))
        return tuple(name for name in names if name.is_file())

    @cached_property
    def georeference(self) -> Georeference:
        """As a world file beside the picture says; it locates the stored pixels, not turned ones."""
        if not self._world_files or self._head.orientation != 1:
            return Georeference()
        with Handles(self._path).borrowed() as source:
            return Georeference.of(source)

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """See `Source.read`."""
        return self._decoded().read(row, column, height, width)

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """See `Source.thinned`."""
        return self._decoded().thinned(height, width)

    def _decoded(self) -> PlainPicture:
        with self._lock:
            return self._picture

    @cached_property
    def _picture(self) -> PlainPicture:
        return PlainPicture(*decode(self._path, self._alpha))


class Masked:
    """A picture of which a mask leaves pixels out; the attributes are those of `Source`.

    Args:
        source: the picture.
        mask: a raster of its size, see `Exclusion`.
    """

    def __init__(self, source: Source, mask: Path) -> None:
        self._source = source
        self.height, self.width, self.block = source.height, source.width, source.block
        self.note, self.georeference = source.note, source.georeference
        self._mask = Exclusion(mask, self.height, self.width, self.georeference)
        self.files = (*source.files, *self._mask.files)

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """See `Source.read`."""
        pixels, valid = self._source.read(row, column, height, width)
        kept = self._mask.kept(row, column, height, width)
        return pixels, kept if valid is None else valid & kept

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """See `Source.thinned`."""
        return self._source.thinned(height, width)


def open_picture(path: Path, reading: Reading = Reading()) -> Source:  # noqa: B008  # frozen
    """Open a picture: the one way in which pictures, scenes and maps are read.

    Plain pictures (JPEG, PNG and BMP of 8 bits, with nothing but a world file beside them) are decoded by
    Pillow and turned upright; everything else by GDAL, whose JPEGs have slightly other colours.

    Raises:
        InputError: it cannot be read, or it is not said how, see `RasterReader`; or it is stored turned, and
            is not plain or pixels are excluded.
        ExtraMissingError: GDAL is needed, and rasterio is not installed.
    """
    kind = format_of(path)
    chosen = reading.bands is not None or reading.scale is not None
    head = None if chosen else plain_head(path, kind)
    if head is not None and not _in_windows(kind, head):
        plain = PlainFile(path, head, reading.alpha)
        if reading.exclude is None:
            return plain
        # Turned, there would be two readings of what is excluded.
        require_upright(path, head.orientation)
        return Masked(plain, reading.exclude)
    raster = RasterReader(path, reading)
    # GDAL does not turn its windows.
    require_upright(path, stored_orientation(path))
    return raster if reading.exclude is None else Masked(raster, reading.exclude)


def _in_windows(kind: str, head: PlainHead) -> bool:
    """Whether a plain picture is large, and GDAL reads the same of it row by row."""
    large = head.height * head.width > PLAIN_PIXELS
    return large and kind == PNG and head.orientation == 1 and find_spec("rasterio") is not None
