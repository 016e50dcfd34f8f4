"""Winner-takes-all: the index of the largest of several words, by a tree of comparators."""

from collections.abc import Sequence
from typing import Literal

from amaranth.hdl import Const, Module, Mux, Signal, Value


def draw_winner(m: Module, words: Sequence[Value], *, tie: Literal["first", "last"], name: str) -> Value:
    """Compare neighbours and pass on the larger one; combinational, latency 0 cycles.

    Args:
        m: the module under construction.
        words: at least two unsigned words.
        tie: which of equal words wins.
        name: what the names of the signals begin with.

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
            # Signals, in simulation too: expressions would double in size from level to level.
            later = Signal(name=f"{name}_later_{level}_{pair}")
            index = Signal(width, name=f"{name}_index_{level}_{pair}")
            best = Signal(max(len(low), len(high)), name=f"{name}_best_{level}_{pair}")
            m.d.comb += [
                later.eq(high > low if tie == "first" else high >= low),
                index.eq(Mux(later, high_index, low_index)),
                best.eq(Mux(later, high, low)),
            ]
            above.append((best, index))
        if len(candidates) % 2:
            above.append(candidates[-1])
        candidates, level = above, level + 1
    return candidates[0][1]
