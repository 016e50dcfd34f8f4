"""Arrays to PNG and JPEG."""

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.files import write_bytes

_QUALITY = 82
"""Of a JPEG."""


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


def jpeg_bytes(array: NDArray[np.uint8]) -> bytes:
    """A photograph, uint8 ``[height, width, 3]``, as a JPEG for a page: a tenth of what a PNG takes."""
    stream = io.BytesIO()
    Image.fromarray(array).save(stream, format="JPEG", quality=_QUALITY, optimize=True)
    return stream.getvalue()
