# amaranth: UnusedElaboratable=no
"""Match-and-count: in how many places two binary words agree."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Cat, Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates.compressor import Columns, MatchCompressor, add_columns
from hdl_templates.hierarchy import Part, place

PAIRS = 3
"""Pairs of bits that one 6-input LUT compares: the first stage takes two LUTs for three pairs."""


@dataclass(frozen=True)
class Parameters:
    """The width of the words, at least 2: nine for a 3x3 block."""

    width: int = 9

    def __post_init__(self) -> None:
        if self.width < 2:
            raise ValueError(f"words of at least 2 bits are matched, not of {self.width}")

    @property
    def count_width(self) -> int:
        """Bits of the count."""
        return self.width.bit_length()

    def compute(self, bits: ArrayLike, reference: ArrayLike) -> NDArray[np.int64]:
        """Golden model: int64 ``S`` for two arrays of bits, bool ``S + (width,)``."""
        same = np.asarray(bits, dtype=np.bool_) == np.asarray(reference, dtype=np.bool_)
        return np.asarray(np.sum(same, axis=-1, dtype=np.int64))

    def create(self) -> "BitMatch":
        """The hardware."""
        return BitMatch(parameters=self)


class BitMatch(Part):
    """Match-and-count: XNOR and population count; purely combinational, latency 0 cycles.

    Args:
        parameters: the width.

    Members:
        bits: In, the word.
        reference: In, the word it is compared with.
        match_count: Out, in how many places they agree.
    """

    module_name = "bit_match"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        width = parameters.width
        super().__init__(
            {"bits": In(width), "reference": In(width), "match_count": Out(parameters.count_width)}
        )

    def elaborate(self, platform: object) -> Module:
        """Compares three pairs at a time, then adds up."""
        m = Module()
        columns: Columns = {0: [], 1: []}
        for first in range(0, self.parameters.width, PAIRS):
            last = min(first + PAIRS, self.parameters.width)
            bits, reference = self.bits[first:last], self.reference[first:last]
            if last - first == 1:
                columns[0].append(~(bits ^ reference))
                continue
            unit = MatchCompressor(pairs=last - first)
            place(m, f"compare_{first // PAIRS}", unit, platform)
            m.d.comb += [unit.bits.eq(bits), unit.reference.eq(reference)]
            columns[0].append(unit.total[0])
            columns[1].append(unit.total[1])
        total = add_columns(m, columns, self.parameters.count_width, platform)
        m.d.comb += self.match_count.eq(Cat(total))
        return m
