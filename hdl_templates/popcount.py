# amaranth: UnusedElaboratable=no
"""Population count of a word as a tree of compressors."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Cat, Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates.compressor import add_columns
from hdl_templates.hierarchy import Part


@dataclass(frozen=True)
class Parameters:
    """The width of the word, at least 1."""

    width: int

    def __post_init__(self) -> None:
        if self.width < 1:
            raise ValueError(f"a word has at least 1 bit, not {self.width}")

    @property
    def count_width(self) -> int:
        """Bits of the count."""
        return self.width.bit_length()

    def compute(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Golden model: int64 ``S`` for bits, bool ``S + (width,)``."""
        return np.asarray(np.sum(np.asarray(bits, dtype=np.bool_), axis=-1, dtype=np.int64))

    def create(self) -> "Popcount":
        """The hardware."""
        return Popcount(parameters=self)


class Popcount(Part):
    """Population count; purely combinational, latency 0 cycles.

    Args:
        parameters: the width.

    Members:
        bits: In, the word.
        count: Out, how many of its bits are set.
    """

    module_name = "popcount"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        super().__init__({"bits": In(parameters.width), "count": Out(parameters.count_width)})

    def elaborate(self, platform: object) -> Module:
        """The tree of compressors."""
        m = Module()
        total = add_columns(m, {0: list(self.bits)}, self.parameters.count_width, platform)
        m.d.comb += self.count.eq(Cat(total))
        return m
