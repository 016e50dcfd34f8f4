"""Winner-takes-all: the index of the largest of several words, by a tree of comparators."""

from collections.abc import Sequence
from typing import Literal

from amaranth.hdl import Const, Module, Mux, Value

from hdl_templates.ports import named


def draw_winner(
    m: Module, words: Sequence[Value], *, tie: Literal["first", "last"], name: str, platform: object
) -> Value:
    """Compare neighbours and pass on the larger one; combinational, latency 0 cycles.

    Args:
        m: the module under construction.
        words: at least two unsigned words.
        tie: which of equal words wins.
        name: what the names of the signals begin with.
        platform: the platform of ``m``.

    Returns:
        The index of the winner, ``(len(words) - 1).bit_length()`` bits.
    """
    width = (len(words) - 1).bit_length()
    candidates: list[tuple[Value, Value]] = [(word, Const(i, width)) for i, word in enumerate(words)]
    level = 0
    while len(candidates) > 1:
        above = []
        for pair in range(len(candidates) // 2):
            (low, low_index), (high, high_index) = candidates[2 * pair : 2 * pair + 2]
            later = high > low if tie == "first" else high >= low
            wins = named(m, f"{name}_later_{level}_{pair}", later, platform)
            index = named(
                m, f"{name}_index_{level}_{pair}", Mux(wins, high_index, low_index)[:width], platform
            )
            best = named(m, f"{name}_best_{level}_{pair}", Mux(wins, high, low), platform)
            above.append((best, index))
        if len(candidates) % 2:
            above.append(candidates[-1])
        candidates, level = above, level + 1
    return candidates[0][1]
