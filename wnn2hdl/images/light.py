"""Pictures under more or less light, through haze, and by cameras of other white balance and gamma."""

import numpy as np
from numpy.typing import NDArray

AIRLIGHT = 255
"""The level of air that hides the ground altogether, in all channels: white."""


def exposed(pixels: NDArray[np.uint8], factor: float) -> NDArray[np.uint8]:
    """Pixels as a camera shows them with ``factor`` times the light.

    Levels are multiplied and rounded, halves upwards, and stop at 255, where a camera saturates.

    Args:
        pixels: uint8 of any shape.
        factor: above 0.
    """
    return _mapped(pixels, np.arange(256) * factor)


def hazed(pixels: NDArray[np.uint8], share: float) -> NDArray[np.uint8]:
    """Pixels as they are seen through haze, of which ``share`` of the light comes from the air.

    The rest is the ground's, as in Koschmieder's law; the air's level is `AIRLIGHT`, and halves are rounded
    upwards.

    Args:
        pixels: uint8 of any shape.
        share: 0 for clear air, to 1.
    """
    return _mapped(pixels, (1 - share) * np.arange(256) + share * AIRLIGHT)


def balanced(pixels: NDArray[np.uint8], gain: float) -> NDArray[np.uint8]:
    """Pixels of a camera of another white balance: red times ``gain``, blue divided by it.

    Levels are rounded, halves upwards, and stop at 255.

    Args:
        pixels: uint8 of any shape whose last axis is red, green, blue.
        gain: above 0; warmer above 1.
    """
    warm = pixels.copy()
    for channel, factor in (0, gain), (2, 1 / gain):
        warm[..., channel] = exposed(pixels[..., channel], factor)
    return warm


def curved(pixels: NDArray[np.uint8], gamma: float) -> NDArray[np.uint8]:
    """Pixels whose levels, as shares of 255, are raised to the power ``gamma``; halves are rounded upwards.

    Args:
        pixels: uint8 of any shape.
        gamma: above 0; darker above 1.
    """
    return _mapped(pixels, 255 * (np.arange(256) / 255) ** gamma)


def _mapped(pixels: NDArray[np.uint8], levels: NDArray[np.floating]) -> NDArray[np.uint8]:
    rounded = np.minimum(np.floor(levels + 0.5), 255).astype(np.uint8)
    return np.take(rounded, pixels)
