"""Pictures under more or less light."""

import numpy as np
from numpy.typing import NDArray


def exposed(pixels: NDArray[np.uint8], factor: float) -> NDArray[np.uint8]:
    """Pixels as a camera shows them with ``factor`` times the light.

    Levels are multiplied and rounded, halves upwards, and stop at 255, where a camera saturates.

    Args:
        pixels: uint8 of any shape.
        factor: above 0.
    """
    levels = np.floor(np.arange(256) * factor + 0.5)
    return np.take(np.minimum(levels, 255).astype(np.uint8), pixels)
