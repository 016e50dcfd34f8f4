"""How a picture is cut into windows: along squares, and along the blocks of its file where that can be."""

import math
from dataclasses import dataclass

WINDOW_SIDE = 2048
"""About the side of a window of a picture stored in tiles."""

WINDOW_PIXELS = 1 << 22
"""About the pixels of a window of a picture stored in rows."""

BAND_PIXELS = 1 << 26
"""Most pixels side by side in windows of the same rows: they are held until all of the windows are done."""


@dataclass(frozen=True)
class Window:
    """A rectangle of a picture.

    Attributes:
        index: its number, row by row.
        row: of its top left pixel.
        column: of its top left pixel.
        height: pixels.
        width: pixels.
    """

    index: int
    row: int
    column: int
    height: int
    width: int


def cut(height: int, width: int, block: tuple[int, int], side: int = 1) -> tuple[tuple[Window, ...], ...]:
    """Cut a picture into windows that cut no square.

    Args:
        height: pixels.
        width: pixels.
        block: height and width of the blocks that the picture is stored in.
        side: pixels of a square's side.

    Returns:
        rows of windows, top to bottom, each from left to right. All but the last of a row or column have
        the same size, a multiple of ``side``.
    """
    if block[1] >= width:
        # Rows of the whole width: reading a part of them decodes all of it.
        columns = _multiple(side, width)
        rows = _step(height, block[0], side, max(WINDOW_PIXELS // width, 1))
    else:
        columns = _step(width, block[1], side, WINDOW_SIDE)
        rows = _step(height, block[0], side, min(WINDOW_SIDE, max(BAND_PIXELS // width, 1)))
    across = -(-width // columns)
    return tuple(
        tuple(
            Window(down * across + right, row, column, min(rows, height - row), min(columns, width - column))
            for right, column in enumerate(range(0, width, columns))
        )
        for down, row in enumerate(range(0, height, rows))
    )


def _step(length: int, block: int, side: int, target: int) -> int:
    """A multiple of ``side``, and of ``block`` unless that goes far beyond ``target``."""
    both = math.lcm(block, side)
    unit = both if both <= 2 * target else side
    return min(unit * max(target // unit, 1), _multiple(side, length))


def _multiple(side: int, length: int) -> int:
    return -(-length // side) * side
