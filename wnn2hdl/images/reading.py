"""Whole pictures as arrays, with what their files state to be no data."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.images.sources import open_picture
from wnn2hdl.raster import Reading, require_decodable


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture.

    Attributes:
        pixels: uint8 ``[height, width, 3]``: red, green, blue.
        valid: bool ``[height, width]``: which pixels are data.
    """

    pixels: NDArray[np.uint8]
    valid: NDArray[np.bool_]

    @property
    def left_out(self) -> int:
        """How many pixels are no data."""
        return int(self.valid.size - np.count_nonzero(self.valid))


def read_picture(path: Path, reading: Reading = Reading()) -> Picture:  # noqa: B008  # frozen
    """Read a whole picture.

    Raises:
        InputError: as `open_picture`, or it is too large.
        ExtraMissingError: as `open_picture`.
    """
    source = open_picture(path, reading)
    require_decodable(path, source.height, source.width)
    pixels, valid = source.read(0, 0, source.height, source.width)
    everywhere = np.ones((source.height, source.width), dtype=np.bool_)
    return Picture(pixels, everywhere if valid is None else valid)


def read_rgb(path: Path, reading: Reading = Reading()) -> NDArray[np.uint8]:  # noqa: B008  # frozen
    """Read a picture that has to be whole: uint8 ``[height, width, 3]``, red, green and blue.

    Raises:
        InputError: as `read_picture`, or some of its pixels are no data.
        ExtraMissingError: as `read_picture`.
    """
    picture = read_picture(path, reading)
    if picture.left_out:
        pixels = "1 pixel" if picture.left_out == 1 else f"{picture.left_out} pixels"
        raise InputError(
            f"{pixels} of the picture without data, and a whole one is needed",
            value=path,
            hint="cut them off",
        )
    return picture.pixels


def picture_size(path: Path, reading: Reading = Reading()) -> tuple[int, int]:  # noqa: B008  # frozen
    """Height and width as `read_picture` returns them, from the file's head alone.

    Raises:
        InputError: as `read_picture`, where the head shows the fault.
        ExtraMissingError: as `read_picture`.
    """
    source = open_picture(path, reading)
    return source.height, source.width


def whole_windows(valid: NDArray[np.bool_], halo: int) -> NDArray[np.bool_]:
    """Which pixels see data alone within ``halo`` pixels on each side: bool, shaped as ``valid``.

    Beyond the picture's borders nothing is missing: classifiers see the outermost pixels repeated there.
    """
    if not halo or valid.all():
        return valid
    kernel = np.ones((2 * halo + 1,) * 2, dtype=np.uint8)
    eroded = cv2.erode(valid.astype(np.uint8), kernel, borderType=cv2.BORDER_CONSTANT, borderValue=1)
    return np.asarray(eroded, dtype=np.bool_)
