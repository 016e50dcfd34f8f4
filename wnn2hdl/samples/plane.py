"""Random fields over an unbounded plane: a point's value depends on the seed and its place alone.

So a large picture can be made in tiles without seams, and a small piece of it again without the rest.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.samples.noise import Field, cell_random


@dataclass(frozen=True)
class Window:
    """A rectangle of pixels on the plane.

    Attributes:
        top: row of its first pixel, of any sign.
        left: column of its first pixel.
        height: rows, at least 1.
        width: columns, at least 1.
    """

    top: int
    left: int
    height: int
    width: int

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width."""
        return self.height, self.width

    @cached_property
    def rows(self) -> NDArray[np.int32]:
        """int32 ``[height]``."""
        return np.arange(self.top, self.top + self.height, dtype=np.int32)

    @cached_property
    def columns(self) -> NDArray[np.int32]:
        """int32 ``[width]``."""
        return np.arange(self.left, self.left + self.width, dtype=np.int32)

    def padded(self, by: int) -> "Window":
        """The window with ``by`` more pixels on each side."""
        return Window(self.top - by, self.left - by, self.height + 2 * by, self.width + 2 * by)


def plane_noise(seed: int, salt: int, window: Window, scale: float, octaves: int = 1) -> Field:
    """Fractal noise: random numbers on a lattice, smoothed by cubic B-splines, and finer ones on top.

    Args:
        seed: the plane's; ``salt`` distinguishes its fields.
        salt: any small number; a field of several octaves takes ``salt`` alone.
        window: where.
        scale: pixels between the coarsest lattice's points, at least 1; each octave halves it.
        octaves: how many lattices are added, each at half the last one's amplitude.

    Returns:
        float32 ``window.shape``, zero mean and a standard deviation of about 1 over large windows.
    """
    total = np.zeros(window.shape, dtype=np.float32)
    energy = 0.0
    for octave in range(octaves):
        first_row, rows = _taps(window.rows, scale / 2**octave)
        first_column, columns = _taps(window.columns, scale / 2**octave)
        knots_y = np.arange(first_row[0], first_row[-1] + 4, dtype=np.int32)[:, np.newaxis]
        knots_x = np.arange(first_column[0], first_column[-1] + 4, dtype=np.int32)
        lattice = cell_random(seed, salt + 1009 * octave, knots_y, knots_x) - np.float32(0.5)
        from_row, from_column = first_row - first_row[0], first_column - first_column[0]
        # Taps are summed in one order everywhere, so that overlapping windows agree to the last bit.
        drawn = sum(rows[tap][:, np.newaxis] * lattice[from_row + tap] for tap in range(4))
        total += np.float32(0.5**octave) * sum(columns[tap] * drawn[:, from_column + tap] for tap in range(4))
        energy += 0.25**octave
    # A uniform number deviates by 1/sqrt(12); the weights' squares sum to 151/315 an axis on average.
    return total * np.float32(12**0.5 / (151 / 315) / energy**0.5)


def _taps(places: NDArray[np.int32], scale: float) -> tuple[NDArray[np.int32], list[Field]]:
    """First of the four lattice points around each place, and the cubic B-spline's weights of all four."""
    along = places / scale
    cell = np.floor(along)
    t = along - cell
    weights = (
        (1 - t) ** 3 / 6,
        (3 * t**3 - 6 * t**2 + 4) / 6,
        (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6,
        t**3 / 6,
    )
    return cell.astype(np.int32) - 1, [weight.astype(np.float32) for weight in weights]
