"""Winner-takes-all: the index of the largest of several words, by a tree of comparators."""

from collections.abc import Sequence
from functools import cache
from typing import Literal

from hdl_templates.builder import Function, NetworkBuilder, choose, function
from wnn2hdl.ir import CONSTANTS, LutNetwork

Word = list[str]
"""Signals, the least significant first."""


@cache
def winner_network(widths: tuple[int, ...], *, tie: Literal["first", "last"]) -> LutNetwork:
    """Neighbours are compared and the larger one is passed on.

    Two bits of both words are compared in one LUT, with the answer for the bits below. The highest bits of
    the larger word do not depend on the bits below, so that they can share a LUT with the comparison.

    Args:
        widths: bits of each of at least two unsigned words.
        tie: which of equal words wins.

    Returns:
        A network that reads the words one after the other and gives the index of the winner,
        ``(len(widths) - 1).bit_length()`` bits, the least significant first.
    """
    inputs = [f"w{word}_{bit}" for word, width in enumerate(widths) for bit in range(width)]
    builder = NetworkBuilder(inputs)
    size = (len(widths) - 1).bit_length()
    indices = [[Function((), (index >> bit & 1,)) for bit in range(size)] for index in range(len(widths))]
    words = [[f"w{word}_{bit}" for bit in range(width)] for word, width in enumerate(widths)]
    candidates = list(zip(words, indices, strict=True))
    while len(candidates) > 1:
        above = []
        for place in range(0, len(candidates) - 1, 2):
            (low, low_index), (high, high_index) = candidates[place : place + 2]
            is_last = len(candidates) == 2
            later, best = _compare(builder, low, high, tie=tie, needs_larger=not is_last)
            index = [_select(builder, later, *pair) for pair in zip(low_index, high_index, strict=True)]
            above.append((best, index))
        if len(candidates) % 2:
            above.append(candidates[-1])
        candidates = above
    outputs = [(f"index{bit}", builder.signal(found)) for bit, found in enumerate(candidates[0][1])]
    return builder.network(outputs)


def _compare(
    builder: NetworkBuilder, low: Word, high: Word, *, tie: Literal["first", "last"], needs_larger: bool
) -> tuple[str, Word]:
    """Whether the word with the higher index wins, and the larger word if it is needed."""
    width = max(len(low), len(high))
    low, high = ([*word, *[CONSTANTS[0]] * (width - len(word))] for word in (low, high))
    later = CONSTANTS[tie == "last"]
    # The lowest LUT reads no answer from below, so that it has room for three bits.
    ends = [width, *range(width - 2, 1 if width > 1 else 0, -2)][::-1]
    start = 0
    for end in ends:
        later = builder.add([*low[start:end], *high[start:end], later], _is_later)
        start = end
    if not needs_larger:
        return later, []
    top = ends[-2] if len(ends) > 1 else 0
    best = [
        builder.add([low[bit], high[bit], later], lambda a, b, wins: b if wins else a) for bit in range(top)
    ]
    for bit in range(top, width):
        place = bit - top
        best.append(
            builder.add([*low[top:], *high[top:]], lambda *bits, place=place: _larger(bits) >> place & 1)
        )
    return later, best


def _is_later(*bits: int) -> int:
    """Whether the second number is larger, or equal and the last bit is set."""
    *numbers, below = bits
    low, high = _numbers(numbers)
    return high > low or (high == low and below == 1)


def _larger(bits: Sequence[int]) -> int:
    return max(_numbers(bits))


def _numbers(bits: Sequence[int]) -> tuple[int, int]:
    """Two numbers whose bits stand one after the other."""
    half = len(bits) // 2
    low, high = (sum(bit << place for place, bit in enumerate(part)) for part in (bits[:half], bits[half:]))
    return low, high


def _select(builder: NetworkBuilder, select: str, low: Function, high: Function) -> Function:
    found = choose(select, low, high)
    if found is None:
        signals = [builder.signal(low), builder.signal(high), select]
        found = function(signals, lambda a, b, wins: b if wins else a)
    return found
