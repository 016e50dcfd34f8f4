# amaranth: UnusedElaboratable=no
"""The block with the matcher on its nine bits: everything the reference design computes from one window."""

from dataclasses import dataclass, field

import numpy as np
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates import bit_match, block
from hdl_templates.discriminator import PIXEL_BITS
from hdl_templates.edge_filter import WINDOW_BITS
from hdl_templates.hierarchy import Part, place


@dataclass(frozen=True)
class Parameters:
    """The parts: the block, and a matcher of nine bits."""

    block: block.Parameters
    match: bit_match.Parameters = field(default_factory=bit_match.Parameters)

    def __post_init__(self) -> None:
        if self.match.width != WINDOW_BITS:
            raise ValueError(f"a block matches {WINDOW_BITS} bits, not {self.match.width}")

    def compute(self, windows: ArrayLike, references: ArrayLike) -> dict[str, NDArray[np.int64]]:
        """Golden model.

        Args:
            windows: 24-bit pixel words, ``S + (9,)``, row by row.
            references: binary windows as codes, ``S``.

        Returns:
            int64 ``S`` for each output: ``bits``, ``edge_bit``, ``match_count``.
        """
        answers = self.block.compute(windows)
        bits, reference = (
            np.asarray(codes, dtype=np.int64)[..., np.newaxis] >> np.arange(WINDOW_BITS) & 1
            for codes in (answers["bits"], references)
        )
        return {**answers, "match_count": self.match.compute(bits, reference)}

    def create(self) -> "BlockMatch":
        """The hardware."""
        return BlockMatch(parameters=self)


class BlockMatch(Part):
    """A block, and the matcher on its nine bits; combinational, latency 0 cycles.

    Args:
        parameters: the parts.

    Members:
        window: In, 216 bits; pixel ``i`` (``3 * row + column``) is ``window[24 * i +: 24]``.
        reference: In, 9 bits, the binary window that the pixels' bits are compared with.
        bits: Out, 9 bits; bit ``i`` is 1 where pixel ``i`` is not of class 0, the background.
        edge_bit: Out, the edge filter's answer for ``bits``.
        match_count: Out, in how many places ``bits`` and ``reference`` agree.
    """

    module_name = "block_match"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        super().__init__(
            {
                "window": In(WINDOW_BITS * PIXEL_BITS),
                "reference": In(WINDOW_BITS),
                "bits": Out(WINDOW_BITS),
                "edge_bit": Out(1),
                "match_count": Out(parameters.match.count_width),
            }
        )

    def elaborate(self, platform: object) -> Module:
        """Wires the parts."""
        m = Module()
        block, match = self.parameters.block.create(), self.parameters.match.create()
        place(m, "classifiers", block, platform)
        place(m, "matcher", match, platform)
        m.d.comb += [
            block.window.eq(self.window),
            self.bits.eq(block.bits),
            self.edge_bit.eq(block.edge_bit),
            match.bits.eq(block.bits),
            match.reference.eq(self.reference),
            self.match_count.eq(match.match_count),
        ]
        return m
