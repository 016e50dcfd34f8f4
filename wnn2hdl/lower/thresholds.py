"""All thresholds of one number in few look-up tables: binary search in hardware.

Each level of a search compares the word with a constant that the answers of the levels before select; the
answers together say between which two thresholds the word lies, and each threshold's bit is a function of
them. Many thresholds are parted into several searches.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np

from wnn2hdl.ir import LUT_INPUTS
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.comparison import Number, Search, Tables
from wnn2hdl.lower.search import shape

MAX_LEVELS = 5
"""Levels of one search: two functions of five answers share a LUT6_2."""

_WINDOW_BITS = range(LUT_INPUTS, 2, -1)
_STEPS = (-4, -2, -1, 1, 2, 4)


def compare(
    word: Sequence[Slice], levels: Sequence[int], *, signed: bool, name: str
) -> tuple[list[Table], list[Slice]]:
    """Compare a word with constants.

    Args:
        word: the bits, the least significant first.
        levels: the constants, at least one, from 1 to ``2**len(word) - 1``, ascending, no two of them equal.
        signed: whether the word is a number in two's complement; it is then compared with its sign bit
            inverted, so that ``levels`` count from the lowest number.
        name: what the names of the tables begin with.

    Returns:
        The tables, and for each constant a bit: whether the word is at least that.
    """
    number, all_levels = Number(tuple(word), signed), tuple(levels)

    @cache
    def group(start: int, end: int) -> tuple[int, Tables, list[Slice]]:
        return _cheapest(number, all_levels[start:end], f"{name}_{start}")

    def cost(cuts: Sequence[int]) -> float:
        if any(not 0 < end - start < 1 << MAX_LEVELS for start, end in pairwise(cuts)):
            return np.inf
        return sum(group(start, end)[0] for start, end in pairwise(cuts))

    fewest = -(-len(levels) // ((1 << MAX_LEVELS) - 1))
    tries = [
        _moved([round(len(levels) * group / groups) for group in range(groups + 1)], cost)
        for groups in (fewest, fewest + 1)
        if groups <= len(levels)
    ]
    cuts = min(tries, key=cost)
    found = [group(start, end) for start, end in pairwise(cuts)]
    return [node for _, tables, _ in found for node in tables.nodes], [
        bit for *_, bits in found for bit in bits
    ]


def _moved(cuts: list[int], cost: Callable[[Sequence[int]], float]) -> list[int]:
    """Where to part the thresholds into searches: cuts moved as long as that saves LUTs."""
    improved = True
    while improved:
        improved = False
        for place in range(1, len(cuts) - 1):
            for step in _STEPS:
                moved = [*cuts[:place], cuts[place] + step, *cuts[place + 1 :]]
                if cost(moved) < cost(cuts):
                    cuts, improved = moved, True
    return cuts


def _cheapest(number: Number, levels: tuple[int, ...], name: str) -> tuple[int, Tables, list[Slice]]:
    """The cheapest of several searches: its LUTs, its tables and the bits of the levels."""
    least = len(levels).bit_length()
    windows: list[tuple[int, tuple[int, ...]] | None] = [None]
    for bits in _WINDOW_BITS:
        prefixes = tuple(
            sorted({level >> (number.width - bits) for level in levels} if bits < number.width else ())
        )
        if 0 < len(prefixes) <= 2:
            windows.append((bits, prefixes))
            break
    found = []
    for depth in range(least, min(least + 1, MAX_LEVELS) + 1):
        shapes = dict.fromkeys(shape(number.width, levels, depth, rounds) for rounds in range(depth))
        for form in filter(None, shapes):
            for window in windows:
                search = Search(number, form, name)
                if window is not None:
                    search.add_window(*window)
                bits_found = search.build(levels)
                found.append((search.tables.luts(), search.tables, bits_found))
    return min(found, key=lambda item: item[0])
