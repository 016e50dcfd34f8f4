"""Squares of a class picture, labelled by the majority of a random share of their pixels.

The reference design classifies half of the pixels of squares of 20x20 and gives each square to the class of
most of them. Which pixels are counted depends on the seed and on the square alone, so a picture may be cut
into windows in any way that cuts no square.
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", np.uint8, np.bool_)

MAX_SIDE = 4096
"""The largest side that commands offer: smaller pictures are padded to one square, some 170 MB of memory."""

_GOLDEN = 0x9E3779B97F4A7C15


def vote(
    classes: NDArray[np.uint8],
    valid: NDArray[np.bool_] | None,
    *,
    side: int,
    share: float,
    seed: int,
    count: int,
    row: int = 0,
    column: int = 0,
) -> NDArray[np.uint8]:
    """Give every pixel the class of most of the counted pixels of its square.

    Squares start at the whole picture's top left corner; those at its right and bottom borders are what is
    left there. Of a square's ``v`` valid pixels, ``round(share * v)`` (halves to even) but at least one are
    counted, drawn without replacement. Among classes with equally many votes the one of the lowest index
    wins, so a draw of two classes goes to the background. A square without a valid pixel becomes class 0.

    Args:
        classes: class of each pixel of a window, uint8 ``[height, width]``.
        valid: which pixels may be counted, bool ``[height, width]``; None for all.
        side: pixels of a square's side.
        share: above 0, at most 1.
        seed: at least 0; its lowest 64 bits are used.
        count: number of classes.
        row: the whole picture's row where the window starts, a multiple of ``side``.
        column: its column where the window starts, a multiple of ``side``.

    Returns:
        uint8 ``[height, width]``.
    """
    if row % side or column % side:
        raise ValueError(f"a window at row {row}, column {column} cuts squares of {side}")
    height, width = classes.shape
    result = np.empty_like(classes)
    across = -(-width // side)
    # One row of squares at a time: its temporaries stay in the cache.
    for top in range(0, height, side):
        rows = slice(top, min(top + side, height))
        keys = _square_keys(seed, (row + top) // side, column // side, across)
        strip = _Strip(classes[rows], None if valid is None else valid[rows], side)
        majority = strip.majority(strip.drawn(keys, share), count)
        result[rows] = np.repeat(majority, side)[:width]
    return result


class _Strip:
    """One row of squares, its pixels regrouped: arrays ``[squares, side * side]``, padded at the borders."""

    def __init__(self, classes: NDArray[np.uint8], valid: NDArray[np.bool_] | None, side: int) -> None:
        height, width = classes.shape
        self._side = side
        self._short = (side - height, -width % side)
        self._classes = self._grouped(classes)
        if valid is None and not any(self._short):
            self._valid: NDArray[np.bool_] | None = None
        else:
            self._valid = self._grouped(np.ones(classes.shape, np.bool_) if valid is None else valid)

    def _grouped(self, pixels: NDArray[Scalar]) -> NDArray[Scalar]:
        if any(self._short):
            pixels = np.pad(pixels, [(0, short) for short in self._short])
        squares = pixels.reshape(self._side, -1, self._side).swapaxes(0, 1)
        return squares.reshape(len(squares), self._side**2)

    def drawn(self, keys: NDArray[np.uint32], share: float) -> NDArray[np.bool_] | None:
        """Which pixels of each square are counted; None for all."""
        pixels = self._side**2
        voters = np.full(len(keys), pixels) if self._valid is None else self._valid.sum(axis=1)
        wanted = np.where(voters > 0, np.maximum(np.rint(share * voters).astype(np.int64), 1), 0)
        if np.array_equal(wanted, voters):
            return self._valid
        numbers = _pixel_numbers(keys, pixels)
        if self._valid is not None:
            numbers[~self._valid] = np.iinfo(np.uint32).max
        last = np.maximum(wanted - 1, 0)
        # As quick as a partition by one rank (1.9 and 1.7 thousand million numbers per second, measured), and
        # ranks differ between squares with invalid pixels.
        limits = np.take_along_axis(np.sort(numbers, axis=1), last[:, np.newaxis], axis=1)
        counted = numbers <= limits
        return counted if self._valid is None else counted & self._valid

    def majority(self, counted: NDArray[np.bool_] | None, count: int) -> NDArray[np.uint8]:
        """The class of most counted pixels of each square, uint8 ``[squares]``."""
        votes = np.empty((count, len(self._classes)), dtype=np.int64)
        for index in range(count):
            of_class = self._classes == index
            if counted is not None:
                of_class &= counted
            votes[index] = np.count_nonzero(of_class, axis=1)
        return np.asarray(votes.argmax(axis=0), dtype=np.uint8)


def _square_keys(seed: int, row: int, column: int, squares: int) -> NDArray[np.uint32]:
    """A random number for each of ``squares`` squares from ``column`` on, by seed and place: uint32."""
    place = np.arange(column, column + squares, dtype=np.uint64) | np.uint64(row << 32)
    start = np.array([seed & 0xFFFFFFFFFFFFFFFF], dtype=np.uint64)
    return (_mix64(_mix64(start) ^ place) >> np.uint64(32)).astype(np.uint32)


def _mix64(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The output function of SplitMix64 (Steele, Lea, Flood 2014)."""
    mixed = values + np.uint64(_GOLDEN)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed ^= mixed >> np.uint64(shift)
        mixed *= np.uint64(factor)
    return mixed ^ mixed >> np.uint64(31)


def _pixel_numbers(keys: NDArray[np.uint32], pixels: int) -> NDArray[np.uint32]:
    """A random number for each pixel of each square: uint32 ``[squares, pixels]``.

    Every step is one to one (the finaliser of MurmurHash3), so no two pixels of a square share a number and
    the lowest ones are exactly as many as are asked for.
    """
    numbers: NDArray[np.uint32] = np.add.outer(keys, np.arange(pixels, dtype=np.uint32))
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        numbers ^= numbers >> np.uint32(shift)
        numbers *= np.uint32(factor)
    numbers ^= numbers >> np.uint32(16)
    return numbers
