"""Arrays to PNG."""

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.files import write_bytes


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
