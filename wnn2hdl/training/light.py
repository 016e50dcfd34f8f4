"""Training pixels under other light, seen through other air and by other cameras than they were taken in."""

import numpy as np
from numpy.typing import NDArray

LEAST, MOST = 0.7, 1.5
"""The least and the most light, as a factor; between them every ratio is equally likely."""

WHITE_BALANCE = 0.03
"""Standard deviation of each channel's own factor, as a share."""

GAMMA = 0.05
"""Standard deviation of the exponent, as a share."""

HAZE = 1.5
"""Standard deviation, in levels, of what the air adds to or takes from all channels alike."""

NOISE = 0.5
"""Standard deviation of each channel's own noise, in levels."""


def varied(
    pixels: NDArray[np.uint8], rng: np.random.Generator, *, together: bool = False
) -> NDArray[np.uint8]:
    """Each pixel under light of its own: haze, gamma, exposure and white balance, noise, and saturation.

    Args:
        pixels: uint8 ``[n, 3]``.
        rng: draws the light.
        together: all pixels are under the same light, and have noise of their own.
    """
    lights = 1 if together else len(pixels)
    each, channels = (lights, 1), (lights, 3)
    ground = np.clip(pixels + rng.normal(0, HAZE, each), 0, 255) / 255
    curved = ground ** np.exp(rng.normal(0, GAMMA, each))
    light = np.exp(rng.uniform(np.log(LEAST), np.log(MOST), each) + rng.normal(0, WHITE_BALANCE, channels))
    levels = 255 * curved * light + rng.normal(0, NOISE, pixels.shape)
    return np.asarray(np.clip(np.floor(levels + 0.5), 0, 255).astype(np.uint8))
