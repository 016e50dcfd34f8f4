"""The signed mass of every code: how many pixels, and how surely, speak for the second class."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import BitSelect
from wnn2hdl.training.bitselect.drift import Colours
from wnn2hdl.training.bitselect.reference import Probability

POOL = BitSelect(
    (
        "R7",
        "R6",
        "R5",
        "R4",
        "R3",
        "R2",
        "G7",
        "G6",
        "G5",
        "G4",
        "G3",
        "G2",
        "B7",
        "B6",
        "B5",
        "B4",
        "B3",
        "B2",
    )
)
"""The bits that may be chosen; the lowest two of a channel are noise."""

CUBE_SHARE = 1e-4
"""Share of the mass spread over the colour cube, so that codes never seen get the reference's answer."""

CUBE_STEP = 4

WHOLE = 1 << 40
"""The mass of all pixels together: whole numbers, so that sums are exact and equal in any order."""


def signed_mass(colours: Colours, probability: Probability) -> NDArray[np.int64]:
    """``weight * (2 p - 1)`` summed over the colours of each code of `POOL`.

    What a table that answers 1 on some codes is expected to get right, less what it gets wrong, is the mass
    of those codes less that of the others.

    Args:
        colours: training colours, blurred.
        probability: the reference, fitted to them.

    Returns:
        int64 ``[2**POOL.width]``; the magnitudes sum to about `WHOLE` at most.
    """
    weight = colours.weights.sum(axis=0)
    # The middle of each cell of the grid, which is finer than the bits of the pool or as fine.
    levels = np.arange(CUBE_STEP // 2, 256, CUBE_STEP)
    cube = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    mass = _by_code(colours.rgb, weight / weight.sum(), probability)
    mass += _by_code(cube, np.full(len(cube), CUBE_SHARE / len(cube)), probability)
    return np.rint(mass * WHOLE).astype(np.int64)


def _by_code(
    rgb: NDArray[np.int64], weight: NDArray[np.float64], probability: Probability
) -> NDArray[np.float64]:
    masses = weight * (2 * probability(rgb) - 1)
    return np.bincount(POOL.codes(rgb), masses, 1 << POOL.width).astype(np.float64)
