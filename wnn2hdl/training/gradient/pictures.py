"""Pictures slightly moved, turned, scaled and sheared, so that a network learns what does not matter."""

import cv2
import numpy as np
from numpy.typing import NDArray

MOST_DEGREES = 10.0
MOST_SCALE = 0.1
MOST_SHEAR = 0.15
MOST_SHIFT = 1.5
"""Pixels."""


def distorted(features: NDArray[np.float64], grid: tuple[int, int], seed: int) -> NDArray[np.float64]:
    """Each picture under an affine map drawn for it; what comes from outside of a picture is 0.

    Args:
        features: pixels row by row, ``[samples, rows * columns]``.
        grid: rows and columns.
        seed: of the maps.

    Returns:
        as ``features``, interpolated.
    """
    rng = np.random.default_rng(seed)
    count, (rows, columns) = len(features), grid
    angle = np.radians(rng.uniform(-MOST_DEGREES, MOST_DEGREES, count))
    scale = rng.uniform(1 - MOST_SCALE, 1 + MOST_SCALE, count)
    shear = rng.uniform(-MOST_SHEAR, MOST_SHEAR, count)
    cosine, sine = np.cos(angle) * scale, np.sin(angle) * scale
    maps = np.empty((count, 2, 3))
    maps[:, 0, 0], maps[:, 0, 1] = cosine, shear - sine
    maps[:, 1, 0], maps[:, 1, 1] = sine, cosine
    centre = np.array([(columns - 1) / 2, (rows - 1) / 2])
    maps[:, :, 2] = centre - maps[:, :, :2] @ centre + rng.uniform(-MOST_SHIFT, MOST_SHIFT, (count, 2))
    moved = np.empty_like(features)
    for picture, by, out in zip(features, maps, moved, strict=True):
        out[:] = cv2.warpAffine(picture.reshape(grid), by, (columns, rows), flags=cv2.INTER_LINEAR).ravel()
    return moved
