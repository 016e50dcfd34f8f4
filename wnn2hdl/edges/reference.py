"""The edge detectors that the learned filter is compared with: Canny and Sobel, on grey pictures.

All edge images leave out the outermost pixels, as a 3x3 window does that must lie inside the picture:
a picture of ``[height, width]`` gives ``[height - 2, width - 2]``.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

CANNY_LOW = 10
CANNY_HIGH = 30
CANNY_SIGMA = 1.4
"""Canny's thresholds on the Euclidean length of the 3x3 Sobel gradient, and his Gaussian in pixels.

Set low, as satellite pictures of forest are dark: 4 to 5 % of the pixels of Sentinel-2 and Planet pictures
of the Amazon become edges, 1 to 2 % at 20 and 60, 0.3 % at 40 and 120.
"""


def grey(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Luma of ITU-R BT.601, ``0.299 R + 0.587 G + 0.114 B`` rounded as OpenCV does: uint8 ``[h, w]``."""
    return np.asarray(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), dtype=np.uint8)


def canny(
    picture: NDArray[np.uint8], low: int = CANNY_LOW, high: int = CANNY_HIGH, sigma: float = CANNY_SIGMA
) -> NDArray[np.bool_]:
    """Canny's edges (IEEE PAMI-8, 1986) by OpenCV, after a Gaussian of ``sigma`` pixels.

    Args:
        picture: grey, uint8 ``[height, width]``.
        low: gradients below are never an edge.
        high: gradients above always are; in between, only if connected to such a one.
        sigma: standard deviation of the Gaussian.

    Returns:
        bool ``[height - 2, width - 2]``.
    """
    smoothed = cv2.GaussianBlur(picture, (0, 0), sigma)
    return np.asarray(cv2.Canny(smoothed, low, high, apertureSize=3, L2gradient=True)[1:-1, 1:-1] > 0)


def sobel(picture: NDArray[np.uint8], threshold: int) -> NDArray[np.bool_]:
    """Sobel's edges in whole numbers, exactly as the hardware baseline computes them.

    Args:
        picture: grey, uint8 ``[height, width]``.
        threshold: an edge has ``|Gx| + |Gy| >= threshold``; the sum is at most 2040.

    Returns:
        bool ``[height - 2, width - 2]``.
    """
    across = cv2.Sobel(picture, cv2.CV_16S, 1, 0, ksize=3)
    down = cv2.Sobel(picture, cv2.CV_16S, 0, 1, ksize=3)
    return np.asarray((np.abs(across) + np.abs(down) >= threshold)[1:-1, 1:-1])
