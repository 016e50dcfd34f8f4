"""Random fields on a pixel grid: smooth noise of a chosen scale, and random numbers that belong to a cell."""

import cv2
import numpy as np
from numpy.typing import NDArray

Field = NDArray[np.float32]


def smooth(rng: np.random.Generator, shape: tuple[int, int], scale: int, octaves: int = 1) -> Field:
    """Fractal noise: a coarse random grid drawn up smoothly, and finer ones of half the height on top.

    Args:
        rng: where the numbers come from.
        shape: height and width in pixels.
        scale: pixels between the coarsest grid's points; each octave halves it, down to one pixel.
        octaves: how many grids are added.

    Returns:
        float32 ``shape``, zero mean and a standard deviation of about 1 over large pictures.
    """
    total = np.zeros(shape, dtype=np.float32)
    energy = 0.0
    for octave in range(octaves):
        step = max(scale >> octave, 1)
        rows, columns = (side // step + 4 for side in shape)
        grid = rng.standard_normal((rows, columns), dtype=np.float32)
        field = cv2.resize(grid, (columns * step, rows * step), interpolation=cv2.INTER_CUBIC)
        # The first and last grid cells carry the interpolation's border.
        field = field[step : step + shape[0], step : step + shape[1]]
        total += field * np.float32(0.5**octave)
        energy += 0.25**octave
    # Cubic interpolation between independent points keeps 0.86 of their standard deviation (measured).
    return total / np.float32(0.86 * energy**0.5)


def grains(rng: np.random.Generator, shape: tuple[int, int], size: float) -> Field:
    """Round grains of one size without a grid: blurred white noise, its slow part removed.

    Args:
        rng: where the numbers come from.
        shape: height and width in pixels.
        size: standard deviation of the blur in pixels, about a third of a grain's width.

    Returns:
        float32 ``shape``, zero mean, a standard deviation of 1.
    """
    white = rng.standard_normal(shape, dtype=np.float32)
    fine = np.subtract(cv2.GaussianBlur(white, (0, 0), size), cv2.GaussianBlur(white, (0, 0), 2.5 * size))
    fine = fine.reshape(shape)
    return np.asarray(fine / np.float32(max(float(fine.std()), 1e-6)))


def cell_random(seed: int, salt: int, row: NDArray[np.int32], column: NDArray[np.int32]) -> Field:
    """A number from 0 to 1 for every pixel that depends on its cell alone.

    Args:
        seed: picture's seed; ``salt`` distinguishes the numbers of one cell.
        salt: any small number.
        row: cell row of each pixel, any sign.
        column: cell column of each pixel, any sign.
        column: cell column of each pixel.

    Returns:
        float32 of the cells' shape, uniform in ``[0, 1)``.
    """
    # An integer hash (the finaliser of MurmurHash3) instead of a table: cells are unbounded.
    mixed = row.astype(np.uint32) * np.uint32(0x9E3779B1) ^ column.astype(np.uint32) * np.uint32(0x85EBCA77)
    mixed ^= np.uint32((seed * 0xC2B2AE3D + salt * 0x27D4EB2F) & 0xFFFFFFFF)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        mixed ^= mixed >> np.uint32(shift)
        mixed *= np.uint32(factor)
    mixed ^= mixed >> np.uint32(16)
    return (mixed >> np.uint32(8)).astype(np.float32) / np.float32(1 << 24)
