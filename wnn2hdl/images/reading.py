"""Pictures, GeoTIFFs and masks to arrays."""

import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFile, ImageOps, TiffImagePlugin, UnidentifiedImageError

from wnn2hdl.errors import InputError
from wnn2hdl.images.palette import Palette

FORMATS = ("PNG", "JPEG", "TIFF", "BMP")
"""What is read, by Pillow's names; GeoTIFFs are TIFFs, their georeference is not looked at here."""

EIGHT_BIT_MODES = frozenset({"1", "L", "LA", "P", "PA", "RGB", "RGBA", "CMYK", "YCbCr"})
"""Pillow's modes whose samples have at most 8 bits and that have one plain reading as RGB."""

_BROKEN = (
    OSError,
    SyntaxError,
    ValueError,
    EOFError,
    KeyError,
    IndexError,
    TypeError,
    struct.error,
    zlib.error,
)
"""What Pillow raises on damaged files; found by cutting and flipping bytes of each format."""

_NODATA_TAG = 42113
"""Of a GeoTIFF: the value of pixels without data, as text (GDAL_NODATA)."""


def read_rgb(path: Path) -> NDArray[np.uint8]:
    """Read a picture, turned upright if it says how it was held (EXIF orientation), as viewers show it.

    Grey becomes three equal channels; a palette is looked up; CMYK is converted as Pillow does, without
    colour management (Planet's Amazon chips: R = 255 - C, and so on); bands past red, green and blue of a
    TIFF are left out. Alpha is dropped if the whole picture is opaque and refused otherwise, since what lies
    under a transparent pixel is no measurement; likewise pixels of a GeoTIFF's value for no data.

    Args:
        path: a file of `FORMATS`.

    Returns:
        uint8 ``[height, width, 3]``: red, green, blue.

    Raises:
        InputError: the file is missing, is no picture, is damaged or truncated, has samples of more than
            8 bits, has transparent pixels or some without data, or is larger than Pillow's safety limit
            (179 million pixels).
    """
    with _opened(path) as picture:
        return _rgb(picture, path)


def picture_size(path: Path) -> tuple[int, int]:
    """Height and width as `read_rgb` returns them, from the file's head alone.

    Raises:
        InputError: as `read_rgb`, where the head shows the fault.
    """
    with _opened(path) as picture:
        width, height = picture.size
        turned = picture.getexif().get(0x0112, 1) >= 5 and picture.format != "TIFF"
    return (width, height) if turned else (height, width)


def read_mask(path: Path, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """Read a mask of two classes: zero or black is forest, anything else deforested.

    Args:
        path: a lossless picture.
        shape: height and width of the picture the mask belongs to.

    Returns:
        uint8 ``[height, width]``: 0 forest, 1 deforested.

    Raises:
        InputError: as `read_rgb`; the size differs from ``shape``; the file is a JPEG, whose compression
            moves labels; or its palette's first entry is not black, so that "zero" has two readings.
    """
    with _opened(path) as picture:
        deforested = np.asarray(_lossless(picture, path, shape).any(axis=2))
        if picture.mode == "P" and not np.array_equal(np.asarray(picture) != 0, deforested):
            raise InputError(
                "the mask's palette does not give black, and black alone, to index 0",
                value=path,
                hint="save it as a grey picture, 0 forest and 255 deforested, or give a palette file",
            )
    return deforested.astype(np.uint8)


def read_labels(path: Path, shape: tuple[int, int], palette: Palette) -> NDArray[np.uint8]:
    """Read a mask of several classes by its colours.

    Args:
        path: a lossless picture.
        shape: height and width of the picture the mask belongs to.
        palette: the colour of each class.

    Returns:
        uint8 ``[height, width]``: class indices.

    Raises:
        InputError: as `read_mask`, or a pixel has a colour that is not in the palette.
    """
    weights = np.array([1 << 16, 1 << 8, 1])
    with _opened(path) as picture:
        codes = _lossless(picture, path, shape) @ weights
    known = np.array(palette.colours) @ weights
    order = np.argsort(known)
    slot = np.searchsorted(known, codes, sorter=order).clip(max=len(known) - 1)
    labels = order[slot]
    strange = codes[known[labels] != codes]
    if strange.size:
        raise InputError(
            f"{strange.size} pixels of the mask have a colour that is not in the palette",
            value=f"{path} (#{int(strange[0]):06x})",
            hint=f"use the colours of {', '.join(palette.names)}, without smoothing",
        )
    return np.asarray(labels, dtype=np.uint8)


@contextmanager
def _opened(path: Path) -> Iterator[ImageFile.ImageFile]:
    """An open picture; whatever Pillow raises inside becomes an `InputError`, and its warnings are muted."""
    try:
        # Pillow warns above 89 million pixels and refuses above twice that; a map may well lie between.
        with warnings.catch_warnings(action="ignore"), Image.open(path, formats=FORMATS) as picture:
            yield picture
    except Image.DecompressionBombError as error:
        raise InputError(
            "the picture is too large to be read at once", value=f"{path} ({error})", hint="cut it into tiles"
        ) from error
    except UnidentifiedImageError as error:
        raise InputError(
            "not a picture that can be read",
            value=path,
            hint=f"give a {', '.join(FORMATS[:-1])} or {FORMATS[-1]} file",
        ) from error
    except _BROKEN as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise InputError("cannot read the picture", value=f"{path} ({error.strerror})") from error
        raise InputError(
            "the picture is damaged or truncated", value=f"{path} ({error})", hint="copy or save it again"
        ) from error


def _rgb(picture: ImageFile.ImageFile, path: Path) -> NDArray[np.uint8]:
    if _sample_bits(picture) > 8:
        raise InputError(
            f"the picture has samples of {_sample_bits(picture)} bits",
            value=path,
            hint="scale it to 8 bits a channel first, for instance with gdal_translate -ot Byte -scale",
        )
    if picture.mode not in EIGHT_BIT_MODES:
        raise InputError(
            f"the picture is of the kind {picture.mode}", value=path, hint="save it as 8-bit RGB"
        )
    _require_data(picture, path)
    upright = ImageOps.exif_transpose(picture)
    if not upright.has_transparency_data:
        return np.asarray(upright.convert("RGB"))
    pixels = np.asarray(upright.convert("RGBA"))
    transparent = int((pixels[..., 3] < 255).sum())
    if transparent:
        raise InputError(
            f"{transparent} pixels of the picture are transparent",
            value=path,
            hint="cut the empty border off or fill it, and save without alpha",
        )
    return np.ascontiguousarray(pixels[..., :3])


def _require_data(picture: ImageFile.ImageFile, path: Path) -> None:
    """Refuse a GeoTIFF that leaves pixels out: those where every band has the value for no data."""
    if not isinstance(picture, TiffImagePlugin.TiffImageFile) or _NODATA_TAG not in picture.tag_v2:
        return
    samples = np.asarray(picture)
    empty = samples == float(str(picture.tag_v2[_NODATA_TAG]).strip("\0 "))
    count = int((empty if empty.ndim == 2 else empty.all(axis=2)).sum())
    if count:
        raise InputError(
            f"{count} pixels of the picture hold no data",
            value=path,
            hint="cut them off; or, if they are data all the same, remove the tag: gdal_edit.py -unsetnodata",
        )


def _sample_bits(picture: ImageFile.ImageFile) -> int:
    """Bits of a sample in the file; Pillow opens 16-bit RGB as 8-bit RGB and drops the low byte unasked."""
    if isinstance(picture, TiffImagePlugin.TiffImageFile):
        return int(max(picture.tag_v2.get(TiffImagePlugin.BITSPERSAMPLE, (1,))))
    # The decoder's raw mode ("RGB;16B") is the only trace of a deep PNG.
    return 16 if picture.format == "PNG" and ";16" in str(picture.tile[0].args) else 8


def _lossless(picture: ImageFile.ImageFile, path: Path, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """The colours of a mask, its format and size checked."""
    if picture.format == "JPEG":
        raise InputError(
            "a JPEG cannot be a mask, its compression smears labels", value=path, hint="save the mask as PNG"
        )
    colours = _rgb(picture, path)
    if colours.shape[:2] != shape:
        raise InputError(
            "the mask and its picture have different sizes",
            value=f"{path} is {colours.shape[1]}x{colours.shape[0]}, the picture {shape[1]}x{shape[0]}",
            hint="give a mask of the picture's size",
        )
    return colours
