"""What a core is made of between its streams, for a drawing of it: steps, widths, memories and cycles."""

from dataclasses import dataclass
from typing import Literal

Kind = Literal["stream", "circuit", "memory"]


@dataclass(frozen=True)
class Step:
    """A step of a core.

    Attributes:
        name: what it is called; no two steps of a core have the same name.
        kind: ``stream`` of the core's ports, ``circuit`` of LUTs, or ``memory`` with what reads it.
        reads: the steps that it takes its words from.
        bits: that leave it in a cycle.
        cycles: registers that a word passes in it, where nothing holds it back.
        part: the circuit that it is made of, as the report calls it; None of all other steps.
        count: how many of them work side by side.
        words: of its memory; 0 if it has none.
        word_bits: of such a word.
        lines: whole lines that a word waits for.
        beats: beats of the same line that it waits for.
    """

    name: str
    kind: Kind
    reads: tuple[str, ...]
    bits: int
    cycles: int = 0
    part: str | None = None
    count: int = 1
    words: int = 0
    word_bits: int = 0
    lines: int = 0
    beats: int = 0
