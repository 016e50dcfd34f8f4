"""The code of a class in a mask, as one number: a value of its only band, or a colour."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import ImageColor

from wnn2hdl.errors import InputError

_COLOUR = 1 << 24
"""Added to ``0xRRGGBB`` of a colour; but a grey has the code of its level, as a single band has."""


def code_of(colour: tuple[int, int, int]) -> int:
    """The code of a colour."""
    red, green, blue = colour
    return red if red == green == blue else _COLOUR | red << 16 | green << 8 | blue


def colour_of(code: int) -> tuple[int, int, int]:
    """The colour of a code; a value is taken for a level of grey."""
    return (code >> 16 & 255, code >> 8 & 255, code & 255) if code >= _COLOUR else (code, code, code)


def parse_code(entry: Any) -> int:
    """The code of ``"#rrggbb"``, of the name of a colour, of a whole number, or of one as text.

    Raises:
        ValueError: it is none of these.
    """
    if isinstance(entry, str):
        text = entry.strip()
        if not text.lstrip("+-").isdecimal():
            return code_of(ImageColor.getrgb(text)[:3])
        entry = int(text)
    if isinstance(entry, bool) or not isinstance(entry, int) or abs(entry) >= _COLOUR:
        raise ValueError(f"{entry!r} is neither a colour nor a whole number")
    return entry


def spoken(code: int) -> str:
    """A code as users write it: a number or ``#rrggbb``."""
    return str(code) if code < _COLOUR else f"#{code - _COLOUR:06x}"


def spoken_codes(codes: Iterable[int]) -> str:
    """Several codes, with commas between."""
    return ",".join(map(spoken, codes))


def colour_codes(colours: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Codes, int64 ``S``, of colours, uint8 ``S + (3,)``."""
    red, green, blue = np.moveaxis(colours, -1, 0).astype(np.int64)
    grey = (red == green) & (green == blue)
    return np.asarray(np.where(grey, red, _COLOUR | red << 16 | green << 8 | blue), dtype=np.int64)


def value_codes(values: NDArray[Any], valid: NDArray[np.bool_], path: Path) -> NDArray[np.int64]:
    """Codes of the values of a single band, int64 shaped as ``values``; 0 where they are not valid.

    Raises:
        InputError: a valid value is not a whole number, or too large for a code.
    """
    numbers = np.where(valid, values, 0)
    wrong = (numbers != np.rint(numbers)) | (np.abs(numbers.astype(np.float64)) >= _COLOUR)
    if wrong.any():
        raise InputError(
            f"{np.count_nonzero(wrong)} values of the mask do not stand for a class",
            value=f"{path} ({numbers[wrong][0]:g})",
            hint="a mask has whole numbers, one for each class",
        )
    return numbers.astype(np.int64)
