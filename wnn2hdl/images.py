"""Pictures, GeoTIFFs and masks to arrays and back; nothing about a file's meaning is guessed in silence."""

import io
import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageFile, ImageOps, TiffImagePlugin, UnidentifiedImageError

from wnn2hdl.errors import InputError
from wnn2hdl.ir.files import read_json, write_bytes

FORMATS = ("PNG", "JPEG", "TIFF", "BMP")
"""What is read, by Pillow's names; GeoTIFFs are TIFFs, their georeference is not looked at here."""

SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")
"""What `list_images` takes for a picture, in lower or upper case."""

EIGHT_BIT_MODES = frozenset({"1", "L", "LA", "P", "PA", "RGB", "RGBA", "CMYK", "YCbCr"})
"""Pillow's modes whose samples have at most 8 bits and that have one plain reading as RGB."""

CLASS_COLOURS = {
    "forest": (22, 92, 44),
    "deforested": (226, 104, 52),
    "pasture": (202, 206, 110),
    "burnt soil": (74, 44, 52),
    "bare ground": (206, 160, 116),
    "river": (58, 120, 192),
    "road": (238, 230, 214),
}
"""Colours of the classes this project names itself."""

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


@dataclass(frozen=True)
class Palette:
    """The colour of each class, for masks of more than two classes and for pictures of results.

    Attributes:
        names: class names; the index of a name is the class index.
        colours: red, green and blue of each class, 0 to 255, all different.
    """

    names: tuple[str, ...]
    colours: tuple[tuple[int, int, int], ...]

    @classmethod
    def of(cls, names: tuple[str, ...]) -> Self:
        """The project's own colours for ``names``; names it does not know get hues apart from one another."""
        hues = (ImageColor.getrgb(f"hsv({(37 + 137 * i) % 360}, 85%, 90%)")[:3] for i in range(len(names)))
        return cls(names, tuple(CLASS_COLOURS.get(name, hue) for name, hue in zip(names, hues, strict=True)))

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a palette file: a JSON object of class names and colours, ``{"forest": "#165c2c", …}``.

        The first class is the background.

        Raises:
            InputError: no such file, no JSON object, fewer than two or more than 256 classes, a colour that
                is none, or one colour for two classes.
        """
        entries = read_json(path, "a palette")
        if not 2 <= len(entries) <= 256:
            raise InputError("a palette has 2 to 256 classes", value=f"{path} ({len(entries)})")
        colours = []
        for name, text in entries.items():
            try:
                colours.append(ImageColor.getrgb(text)[:3])
            except (ValueError, AttributeError, TypeError) as error:
                raise InputError(
                    f"the palette {path} gives {name!r} no colour",
                    value=repr(text),
                    mend="write it as #rrggbb",
                ) from error
        if len(set(colours)) != len(colours):
            raise InputError(
                "two classes of the palette share a colour", value=path, mend="change one of them"
            )
        return cls(tuple(entries), tuple(colours))

    def to_json(self) -> dict[str, str]:
        """The object of a palette file, read back by `read`."""
        return {
            name: "#{:02x}{:02x}{:02x}".format(*colour)
            for name, colour in zip(self.names, self.colours, strict=True)
        }

    def paint(self, labels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """A picture of class indices: uint8 ``S`` to uint8 ``S + (3,)``."""
        return np.take(np.array(self.colours, dtype=np.uint8), labels, axis=0)


def read_rgb(path: Path) -> NDArray[np.uint8]:
    """Read a picture, turned upright if it says how it was held (EXIF orientation), as viewers show it.

    Grey becomes three equal channels; a palette is looked up; CMYK is converted as Pillow does, without
    colour management (Planet's Amazon chips: R = 255 - C, and so on); bands past red, green and blue of a
    TIFF are left out. Alpha is dropped if the whole picture is opaque and refused otherwise, since what lies
    under a transparent pixel is no measurement.

    Args:
        path: a file of `FORMATS`.

    Returns:
        uint8 ``[height, width, 3]``: red, green, blue.

    Raises:
        InputError: the file is missing, is no picture, is damaged or truncated, has samples of more than
            8 bits, has transparent pixels, or is larger than Pillow's safety limit (179 million pixels).
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
                mend="save it as a grey picture, 0 forest and 255 deforested, or give a palette file",
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
            mend=f"use the colours of {', '.join(palette.names)}, without smoothing",
        )
    return np.asarray(labels, dtype=np.uint8)


def list_images(folder: Path) -> tuple[Path, ...]:
    """The pictures of a folder by `SUFFIXES`, sorted by name; hidden files and subfolders are left out.

    Raises:
        InputError: the folder cannot be read or holds no picture.
    """
    try:
        entries = sorted(folder.iterdir())
    except OSError as error:
        raise InputError("cannot read the folder", value=f"{folder} ({error.strerror})") from error
    found = tuple(
        entry
        for entry in entries
        if entry.suffix.lower() in SUFFIXES and not entry.name.startswith(".") and entry.is_file()
    )
    if not found:
        raise InputError(
            "no pictures in the folder",
            value=folder,
            mend=f"it should hold files ending in {', '.join(SUFFIXES)}",
        )
    return found


def pair_masks(images: Path, masks: Path) -> tuple[tuple[Path, Path], ...]:
    """Each picture of one folder with the mask of the same stem in the other, sorted by name.

    Raises:
        InputError: a folder cannot be read or is empty, a picture has no mask, or two files of a folder have
            the same stem. Masks without a picture are left out.
    """
    pictures, mask_of = _by_stem(images), _by_stem(masks)
    missing = [path.name for stem, path in pictures.items() if stem not in mask_of]
    if missing:
        raise InputError(
            f"{len(missing)} of {len(pictures)} pictures have no mask of the same stem in {masks}",
            value=", ".join(missing[:3]) + (" …" if len(missing) > 3 else ""),
            mend="add the masks, or take the pictures out",
        )
    return tuple((path, mask_of[stem]) for stem, path in pictures.items())


def _by_stem(folder: Path) -> dict[str, Path]:
    found: dict[str, Path] = {}
    for path in list_images(folder):
        if path.stem in found:
            raise InputError(
                "two pictures of a folder have the same stem",
                value=f"{found[path.stem]}, {path.name}",
                mend="rename or remove one",
            )
        found[path.stem] = path
    return found


def write_png(path: Path, array: NDArray[np.uint8] | NDArray[np.bool_]) -> None:
    """Write a PNG, whole or not at all.

    Args:
        path: the file.
        array: uint8 ``[height, width, 3]`` (RGB), uint8 ``[height, width]`` (grey), or bool
            ``[height, width]`` (black and white).

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    write_bytes(path, png_bytes(array))


def png_bytes(array: NDArray[np.uint8] | NDArray[np.bool_]) -> bytes:
    """What `write_png` writes."""
    stream = io.BytesIO()
    Image.fromarray(array).save(stream, format="PNG")
    return stream.getvalue()


@contextmanager
def _opened(path: Path) -> Iterator[ImageFile.ImageFile]:
    """An open picture; whatever Pillow raises inside becomes an `InputError`, and its warnings are muted."""
    try:
        # Pillow warns above 89 million pixels and refuses above twice that; a map may well lie between.
        with warnings.catch_warnings(action="ignore"), Image.open(path, formats=FORMATS) as picture:
            yield picture
    except Image.DecompressionBombError as error:
        raise InputError(
            "the picture is too large to be read at once", value=f"{path} ({error})", mend="cut it into tiles"
        ) from error
    except UnidentifiedImageError as error:
        raise InputError(
            "not a picture that can be read",
            value=path,
            mend=f"give a {', '.join(FORMATS[:-1])} or {FORMATS[-1]} file",
        ) from error
    except _BROKEN as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise InputError("cannot read the picture", value=f"{path} ({error.strerror})") from error
        raise InputError(
            "the picture is damaged or truncated", value=f"{path} ({error})", mend="copy or save it again"
        ) from error


def _rgb(picture: ImageFile.ImageFile, path: Path) -> NDArray[np.uint8]:
    if _sample_bits(picture) > 8:
        raise InputError(
            f"the picture has samples of {_sample_bits(picture)} bits",
            value=path,
            mend="scale it to 8 bits a channel first, for instance with gdal_translate -ot Byte -scale",
        )
    if picture.mode not in EIGHT_BIT_MODES:
        raise InputError(
            f"the picture is of the kind {picture.mode}", value=path, mend="save it as 8-bit RGB"
        )
    upright = ImageOps.exif_transpose(picture)
    if not upright.has_transparency_data:
        return np.asarray(upright.convert("RGB"))
    pixels = np.asarray(upright.convert("RGBA"))
    transparent = int((pixels[..., 3] < 255).sum())
    if transparent:
        raise InputError(
            f"{transparent} pixels of the picture are transparent",
            value=path,
            mend="cut the empty border off or fill it, and save without alpha",
        )
    return np.ascontiguousarray(pixels[..., :3])


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
            "a JPEG cannot be a mask, its compression smears labels", value=path, mend="save the mask as PNG"
        )
    colours = _rgb(picture, path)
    if colours.shape[:2] != shape:
        raise InputError(
            "the mask and its picture have different sizes",
            value=f"{path} is {colours.shape[1]}x{colours.shape[0]}, the picture {shape[1]}x{shape[0]}",
            mend="give a mask of the picture's size",
        )
    return colours
