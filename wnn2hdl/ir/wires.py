"""Wires: the words of bits that the nodes of a circuit read, and the ports through which bits come and go."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir.verilog_text import check_identifier

Bits = NDArray[np.bool_]
"""Values of a port or a word: bool ``[samples, width]``; element 0 of a row is the least significant."""

MAX_WORD = 1 << 20
"""The most bits of a port or a word."""

_SLICE = re.compile(r"([A-Za-z]\w*(?:\.\w+)?)\[(\d+):(\d+)\]", re.ASCII)


@dataclass(frozen=True)
class Port:
    """A port of a circuit: its name, an identifier of every HDL, and its width in bits.

    The name of the clock, which no circuit has as its own port, is ``clk``.
    """

    name: str
    width: int

    def __post_init__(self) -> None:
        check_identifier(self.name)
        if not 1 <= self.width <= MAX_WORD:
            raise ValueError(f"port {self.name} has {self.width} bits; it may have 1 to {MAX_WORD}")
        if self.name == "clk":
            raise ValueError("a port cannot be called clk, as the clock is")

    @property
    def word(self) -> "Word":
        """All bits of the port."""
        return (Slice(self.name, 0, self.width),)


@dataclass(frozen=True)
class Slice:
    """Consecutive bits of a net: ``net[low + width - 1 : low]``.

    Attributes:
        net: an input port of the circuit, or what a node drives.
        low: the least significant bit.
        width: how many bits.
    """

    net: str
    low: int = 0
    width: int = 1

    def __str__(self) -> str:
        return f"{self.net}[{self.low + self.width - 1}:{self.low}]"

    @classmethod
    def parse(cls, text: str) -> Self:
        """The inverse of ``str``; raises ValueError on anything else."""
        match = _SLICE.fullmatch(text)
        if match is None or int(match[2]) < int(match[3]):
            raise ValueError(f"{text!r} is not a slice of a net, as in window[23:0]")
        return cls(match[1], int(match[3]), int(match[2]) - int(match[3]) + 1)


Word = tuple[Slice, ...]
"""Bits put side by side; the first slice holds the least significant ones."""


def width_of(word: Word) -> int:
    """Bits of a word."""
    return sum(part.width for part in word)


def read_word(nets: Mapping[str, Bits], word: Word) -> Bits:
    """The values of a word, bool ``[samples, width]``, from those of the nets."""
    columns = [nets[part.net][:, part.low : part.low + part.width] for part in word]
    return columns[0] if len(columns) == 1 else np.concatenate(columns, axis=1)


def single_bits(word: Word) -> list[Slice]:
    """The bits of a word one by one, the least significant first."""
    return [Slice(part.net, part.low + i) for part in word for i in range(part.width)]


def word_values(bits: Bits) -> list[int]:
    """Words as numbers, one for each sample."""
    packed = np.packbits(bits, axis=1, bitorder="little")
    return [int.from_bytes(row.tobytes(), "little") for row in packed]


def word_to_json(word: Word) -> list[str]:
    """Slices as text, the least significant first."""
    return [str(part) for part in word]


def word_from_json(data: Any) -> Word:
    """The inverse of `word_to_json`; raises ValueError or TypeError on anything else."""
    word = tuple(Slice.parse(text) for text in data)
    if width_of(word) > MAX_WORD:
        raise ValueError(f"a word has {width_of(word)} bits; it may have {MAX_WORD}")
    return word
