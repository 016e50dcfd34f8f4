"""A picture as binary images by local thresholds, in whole numbers as hardware computes them.

A pixel is compared with its surroundings, not with a fixed level: light and season change levels from one
date to another, but seldom what is brighter, or redder, than what lies around it. Means of red and of blue
over a square serve three images: red above its mean, blue above its mean, and red further above its mean than
blue. The third separates bare ground from plants, which grey levels often cannot.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

IMAGES = ("red", "blue", "red less blue")
"""What the binary images threshold, in their order."""

_RED, _BLUE = 0, 2


def binary_images(picture: NDArray[np.uint8], valid: NDArray[np.bool_], side: int) -> NDArray[np.bool_]:
    """Threshold a picture by the means over the square around each pixel.

    Args:
        picture: uint8 ``[height, width, 3]``: red, green, blue.
        valid: bool ``[height, width]``: only these pixels count for the means.
        side: of the square, pixels, odd.

    Returns:
        bool ``[3, height, width]``, in the order of `IMAGES`; false where not valid.
    """
    count = _box_sum(valid, side)
    # Deviation from the mean, times the number of pixels: no division, no rounding.
    red, blue = (
        count * picture[..., band] - _box_sum(picture[..., band] * valid, side) for band in (_RED, _BLUE)
    )
    return np.asarray(np.stack([red > 0, blue > 0, red > blue]) & valid)


def shrunk(valid: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    """Valid pixels whose surroundings of ``by`` pixels are valid too, so that no border is taken for an edge.

    What lies beyond the picture is not valid.
    """
    inside = np.pad(valid, by).astype(np.uint8)
    core = cv2.erode(inside, np.ones((2 * by + 1, 2 * by + 1), dtype=np.uint8))
    return np.asarray(core[by:-by, by:-by] > 0)


def _box_sum(values: NDArray[np.uint8] | NDArray[np.bool_], side: int) -> NDArray[np.int64]:
    """Sum over the square around each pixel, as far as it lies in the picture: int64 ``[height, width]``."""
    half = side // 2
    padded = np.pad(values.astype(np.uint8), half)
    # Doubles hold the sums exactly: 8-bit pictures of 2**45 pixels would fit.
    total = cv2.integral(padded, sdepth=cv2.CV_64F)
    summed = total[side:, side:] - total[:-side, side:] - total[side:, :-side] + total[:-side, :-side]
    return np.asarray(summed, dtype=np.int64)
