"""Plain pictures, decoded by Pillow: those of 8 bits about which no other file or tag says anything."""

import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFile, TiffImagePlugin, UnidentifiedImageError

from wnn2hdl.errors import InputError
from wnn2hdl.muted import muted
from wnn2hdl.raster.formats import PLAIN_FORMATS, TIFF
from wnn2hdl.raster.reading import MOST_PIXELS, ORIENTATION_TAG, require_decodable
from wnn2hdl.raster.validity import AlphaMeaning, require_mask

Scalar = TypeVar("Scalar", np.uint8, np.bool_)

EIGHT_BIT_MODES = frozenset({"1", "L", "LA", "P", "PA", "RGB", "RGBA", "CMYK", "YCbCr"})
"""Pillow's modes whose samples have at most 8 bits and that have one plain reading as RGB."""

_FORMATS = ("PNG", "JPEG", "TIFF", "BMP")
_SPEAKING_NEIGHBOURS = (".aux.xml", ".msk", ".MSK")
"""Files beside a picture that may leave pixels out or name its bands."""

_PLAIN_TIFF = {"RGB": 2, "L": 1}
"""Modes of TIFFs that are plain, and their photometric interpretation."""
_SPEAKING_TAGS = frozenset({338, 42112, 42113})
"""Tags of a TIFF that say more: extra samples, GDAL_METADATA, GDAL_NODATA."""
_JPEG_IN_TIFF = ("jpeg", "tiff_jpeg")

_STRIP_PIXELS = 1 << 20

_BROKEN = (
    OSError,
    SyntaxError,
    ValueError,
    EOFError,
    KeyError,
    IndexError,
    TypeError,
    AttributeError,
    OverflowError,
    MemoryError,
    struct.error,
    zlib.error,
)
"""What Pillow raises on damaged files; found by cutting and flipping bytes of each format."""


@dataclass(frozen=True)
class PlainHead:
    """What the head of a plain picture says.

    Attributes:
        height: of the picture as viewers show it, in pixels.
        width: of the picture as viewers show it, in pixels.
        orientation: how viewers turn the stored picture, as EXIF numbers it from 1, upright.
    """

    height: int
    width: int
    orientation: int


def plain_head(path: Path, kind: str) -> PlainHead | None:
    """The head of a picture; None if it is not plain, so that GDAL has to read it.

    A TIFF is plain only where GDAL is missing, and nothing in it needs GDAL.

    Args:
        path: a file.
        kind: its format, see `wnn2hdl.raster.format_of`.

    Raises:
        InputError: the file is damaged or too large.
    """
    if kind not in PLAIN_FORMATS and (kind != TIFF or find_spec("rasterio")):
        return None
    if any(path.with_name(path.name + suffix).exists() for suffix in _SPEAKING_NEIGHBOURS):
        return None
    with _opened(path) as picture:
        if picture.mode not in EIGHT_BIT_MODES or _sample_bits(picture) > 8:
            return None
        if picture.format == "BMP" and picture.mode == "1":
            # Pillow takes indices of 8 bits for single bits where two colours are black and white.
            return None
        turn = _orientation(picture)
        turn = turn if 1 <= turn <= 8 else 1
        if isinstance(picture, TiffImagePlugin.TiffImageFile) and (turn != 1 or not _plain_tiff(picture)):
            return None
        width, height = picture.size
    require_decodable(path, height, width)
    return PlainHead(height, width, turn) if turn < 5 else PlainHead(width, height, turn)


def decode(path: Path, alpha: AlphaMeaning | None) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
    """A plain picture, turned upright if it says how it was held (EXIF orientation), as viewers show it.

    Grey becomes three equal channels; a palette is looked up; CMYK is converted as Pillow does, without
    colour management (Planet's Amazon chips: R = 255 - C, and so on).

    Args:
        path: a file that `plain_head` takes for plain.
        alpha: what its alpha holds; None excludes pixels by it, and refuses one that looks like data.

    Returns:
        uint8 ``[height, width, 3]``: red, green, blue; and which pixels are opaque, bool
        ``[height, width]``, None for all.

    Raises:
        InputError: the file is damaged or truncated, or its alpha looks like data.
    """
    with _opened(path) as picture:
        width, height = picture.size
        pixels = np.empty((height, width, 3), dtype=np.uint8)
        opacity = np.empty((height, width), dtype=np.uint8) if picture.has_transparency_data else None
        # Strips, so that no second copy of a large picture is made on the way.
        rows = max(_STRIP_PIXELS // width, 1)
        for top in range(0, height, rows):
            strip = picture.crop((0, top, width, min(top + rows, height)))
            if opacity is None:
                pixels[top : top + rows] = np.asarray(strip.convert("RGB"))
            else:
                colours = np.asarray(strip.convert("RGBA"))
                pixels[top : top + rows] = colours[..., :3]
                opacity[top : top + rows] = colours[..., 3]
        # Only now: of some PNGs it is known when all is decoded.
        turn = _orientation(picture)
    if opacity is None or alpha == "data":
        return turned(pixels, turn), None
    if alpha is None:
        require_mask([opacity], path)
    valid = opacity == 255
    return turned(pixels, turn), None if valid.all() else turned(valid, turn)


def indices(path: Path) -> NDArray[np.uint8] | None:
    """The indices of an indexed picture, uint8 ``[height, width]``, not turned; None if it has no palette."""
    with _opened(path) as picture:
        return np.array(picture) if picture.mode == "P" else None


def turned(array: NDArray[Scalar], orientation: int) -> NDArray[Scalar]:
    """An array ``[rows, columns, …]`` turned as EXIF's orientation says; contiguous."""
    if orientation in (5, 6, 7, 8):
        array = array.swapaxes(0, 1)
    if orientation in (3, 4, 7, 8):
        array = array[::-1]
    if orientation in (2, 3, 6, 7):
        array = array[:, ::-1]
    return np.ascontiguousarray(array)


@contextmanager
def _opened(path: Path) -> Iterator[ImageFile.ImageFile]:
    """An open picture; whatever Pillow raises inside becomes an `InputError`."""
    try:
        # Pillow warns above 89 million pixels and refuses above twice that; a map may well lie between.
        with muted():
            picture = Image.open(path, formats=_FORMATS)
        with picture:
            yield picture
    except Image.DecompressionBombError as error:
        raise InputError(
            f"the picture is too large to be read at once; the limit is {MOST_PIXELS:,} pixels",
            value=path,
            hint="cut it into tiles",
        ) from error
    except UnidentifiedImageError as error:
        raise _damaged(path, "its head cannot be read") from error
    except _BROKEN as error:
        raise _damaged(path, error) from error


def _orientation(picture: ImageFile.ImageFile) -> int:
    """What the EXIF data says, without Pillow's warnings of what is wrong in it."""
    with muted():
        return int(picture.getexif().get(ORIENTATION_TAG, 1))


def _damaged(path: Path, reason: object) -> InputError:
    return InputError(
        "the picture is damaged or truncated", value=f"{path} ({reason})", hint="copy or save it again"
    )


def _plain_tiff(picture: TiffImagePlugin.TiffImageFile) -> bool:
    return (
        picture.tag_v2.get(262) == _PLAIN_TIFF.get(picture.mode)
        and not _SPEAKING_TAGS & set(picture.tag_v2)
        and getattr(picture, "n_frames", 1) == 1
        and picture.info.get("compression") not in _JPEG_IN_TIFF
    )


def _sample_bits(picture: ImageFile.ImageFile) -> int:
    """Bits of a sample in the file; Pillow opens 16-bit RGB as 8-bit RGB and drops the low byte unasked."""
    if isinstance(picture, TiffImagePlugin.TiffImageFile):
        return int(max(picture.tag_v2.get(TiffImagePlugin.BITSPERSAMPLE, (1,))))
    # The decoder's raw mode ("RGB;16B") is the only trace of a deep PNG.
    return 16 if picture.format == "PNG" and picture.tile and ";16" in str(picture.tile[0].args) else 8
