"""Masks to labels: the class of each pixel, and which pixels are unlabelled."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.images.codes import colour_codes, spoken, value_codes
from wnn2hdl.images.palette import MOST_CLASSES, Palette
from wnn2hdl.images.plain import decode, indices, plain_head, turned
from wnn2hdl.raster import Stored, format_of, read_stored
from wnn2hdl.raster.formats import JPEG
from wnn2hdl.raster.reading import stored_orientation

UNLABELLED = MOST_CLASSES
"""The label of a pixel without a class."""

_FREQUENT = 0.001
"""Share of a mask's labelled pixels above which a value is not a slip of a brush or of a smoothed outline."""


@dataclass(frozen=True)
class MaskFormat:
    """How masks are read.

    Attributes:
        palette: what stands for each class; None for masks of two classes, 0 and another value.
        ignored: codes of unlabelled pixels, in addition to those of the palette.
    """

    palette: Palette | None = None
    ignored: frozenset[int] = frozenset()


@dataclass(frozen=True, eq=False)
class Labels:
    """A mask.

    Attributes:
        classes: uint8 ``[height, width]``: class indices, `UNLABELLED` where there is none.
        foreground: of a mask of two classes, the code that stands for the second; None if it is rare.
    """

    classes: NDArray[np.uint8]
    foreground: int | None


def read_labels(path: Path, picture: Path, shape: tuple[int, int], masks: MaskFormat) -> Labels:
    """Read a mask.

    A pixel is unlabelled where the file says so (nodata, its own mask, alpha, a transparent entry of its
    colour table), and where it has an ignored code. Without a palette 0 or black is the first class, forest,
    and the one other value the second, deforested.

    Args:
        path: a lossless picture.
        picture: the picture that the mask belongs to.
        shape: height and width of that picture.
        masks: how.

    Raises:
        InputError: the mask cannot be read; its size differs from ``shape``; it is turned in another way than
            its picture; it is a JPEG, whose compression moves labels; without a palette, it has further
            frequent values, a negative one, or a colour table whose first entry is not black; or with one, a
            code that is not in it.
        ExtraMissingError: rasterio is needed and not installed.
    """
    kind = format_of(path)
    if kind == JPEG:
        raise InputError(
            "a JPEG cannot be a mask, because its compression smears labels",
            value=path,
            hint="save the mask as PNG",
        )
    codes, labelled = _codes(path, kind, checked=masks.palette is None)
    if codes.shape != shape:
        raise InputError(
            "the mask and its picture have different sizes",
            value=f"{path} is {codes.shape[1]}x{codes.shape[0]}, the picture {shape[1]}x{shape[0]}",
            hint="give a mask of the picture's size",
        )
    turns = stored_orientation(picture), stored_orientation(path)
    if turns[0] != turns[1]:
        raise InputError(
            "the mask and its picture have different orientations",
            value=f"{path} (orientation {turns[1]}), {picture} ({turns[0]})",
            hint="save both upright",
        )
    ignored = masks.ignored | (masks.palette.ignored if masks.palette else frozenset())
    labelled = labelled & ~np.isin(codes, list(ignored))
    if masks.palette is not None:
        return Labels(_classified(codes, labelled, masks.palette, path), None)
    foreground = _foreground(codes[labelled], path)
    classes = (codes != 0).astype(np.uint8)
    classes[~labelled] = UNLABELLED
    return Labels(classes, foreground)


def _codes(path: Path, kind: str, *, checked: bool) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Codes of a mask, int64 ``[height, width]``, and which of them the file does not leave out.

    Args:
        path: the mask.
        kind: its format.
        checked: whether index 0 of a colour table has to be black, and nothing else.
    """
    head = plain_head(path, kind)
    if head is not None:
        colours, valid = decode(path, alpha="exclude")
        codes, labelled = colour_codes(colours), np.ones(colours.shape[:2], dtype=np.bool_)
        labelled = labelled if valid is None else valid
        index = indices(path) if checked else None
        index = None if index is None else turned(index, head.orientation)
    else:
        stored = read_stored(path)
        codes, labelled, index = _stored_codes(stored, path)
    if checked and index is not None and ((index == 0) != (codes == 0))[labelled].any():
        raise InputError(
            "the mask's palette must have black at index 0, and nowhere else",
            value=path,
            hint="save it as a grey picture, 0 forest and 255 deforested, or give a palette file",
        )
    return codes, labelled


def _stored_codes(
    stored: Stored, path: Path
) -> tuple[NDArray[np.int64], NDArray[np.bool_], NDArray[np.uint8] | None]:
    """Codes, which of them the file does not leave out, and the indices of a colour table."""
    samples = stored.samples
    if stored.palette is not None:
        colours = stored.palette[samples[0]]
        return colour_codes(colours[..., :3]), stored.valid & (colours[..., 3] == 255), samples[0]
    if len(samples) == 1:
        return value_codes(samples[0], stored.valid, path), stored.valid, None
    if samples.dtype != np.uint8:
        raise InputError(
            "the mask's colours have more than 8 bits", value=path, hint="save it with 8 bits per channel"
        )
    return colour_codes(np.moveaxis(samples, 0, 2)), stored.valid, None


def _foreground(codes: NDArray[np.int64], path: Path) -> int | None:
    """The code other than 0 of a mask of two classes, None if it is rare; others are refused."""
    found, counts = np.unique(codes, return_counts=True)
    frequent = counts > _FREQUENT * len(codes)
    others = found[(found != 0) & (frequent | (found < 0))]
    if len(others) > 1 or (others < 0).any():
        raise InputError(
            f"the mask holds {', '.join(map(spoken, others[:5].tolist()))}{' …' if len(others) > 5 else ''} "
            "besides 0, without saying which of them are deforested",
            value=path,
            hint="name unlabelled values with --ignore VALUE, or give a palette file of the classes",
        )
    return int(others[0]) if len(others) else None


def _classified(
    codes: NDArray[np.int64], labelled: NDArray[np.bool_], palette: Palette, path: Path
) -> NDArray[np.uint8]:
    known = {code: index for index, some in enumerate(palette.mask_codes) for code in some}
    found, place = np.unique(codes, return_inverse=True)
    indices = np.array([known.get(code, UNLABELLED) for code in found.tolist()], dtype=np.uint8)
    classes = indices[place.reshape(codes.shape)]
    strange = codes[labelled & (classes == UNLABELLED)]
    if strange.size:
        raise InputError(
            f"{strange.size} pixels of the mask have a colour or a number that is not in the palette",
            value=f"{path} ({spoken(int(strange[0]))})",
            hint=f"add it, or name it with --ignore; the palette has {', '.join(palette.names)}",
        )
    classes[~labelled] = UNLABELLED
    return classes
