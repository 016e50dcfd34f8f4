# amaranth: UnusedElaboratable=no
"""The block of the reference design: nine pixel classifiers and the edge filter on their bits."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Cat, Module, Value
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates import discriminator, edge_filter
from hdl_templates.discriminator import PIXEL_BITS
from hdl_templates.edge_filter import WINDOW_BITS
from hdl_templates.hierarchy import Part, place
from hdl_templates.ports import named


@dataclass(frozen=True)
class Parameters:
    """The parts: one pixel classifier (used nine times) and the edge filter."""

    pixel: discriminator.Parameters
    edges: edge_filter.Parameters

    def compute(self, windows: ArrayLike) -> dict[str, NDArray[np.int64]]:
        """Golden model.

        Args:
            windows: 24-bit pixel words, ``S + (9,)``, row by row.

        Returns:
            int64 ``S`` for each output: ``bits``, ``edge_bit``.
        """
        flags = self.pixel.compute(windows) != 0
        bits = np.asarray(flags @ (1 << np.arange(WINDOW_BITS)), dtype=np.int64)
        return {"bits": bits, "edge_bit": self.edges.compute(bits).astype(np.int64)}

    def create(self) -> "Block":
        """The hardware."""
        return Block(parameters=self)


class Block(Part):
    """Nine pixel classifiers in parallel and an edge filter; combinational, latency 0 cycles.

    Args:
        parameters: the parts.

    Members:
        window: In, 216 bits; pixel ``i`` (``3 * row + column``) is ``window[24 * i +: 24]``.
        bits: Out, 9 bits; bit ``i`` is 1 where pixel ``i`` is not of class 0, the background.
        edge_bit: Out, the edge filter's answer for ``bits``.
    """

    module_name = "block"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        super().__init__(
            {"window": In(WINDOW_BITS * PIXEL_BITS), "bits": Out(WINDOW_BITS), "edge_bit": Out(1)}
        )

    def elaborate(self, platform: object) -> Module:
        """Wires the parts."""
        m = Module()
        flags: list[Value] = []
        for i in range(WINDOW_BITS):
            pixel = self.parameters.pixel.create()
            place(m, f"pixel_{i}", pixel, platform)
            m.d.comb += pixel.rgb.eq(self.window.word_select(i, PIXEL_BITS))
            if len(pixel.class_bits) == 1:
                flags.append(pixel.class_bits)
            else:
                flags.append(named(m, f"foreground_{i}", pixel.class_bits.any(), platform))
        edges = self.parameters.edges.create()
        place(m, "edges", edges, platform)
        m.d.comb += [
            self.bits.eq(Cat(flags)),
            edges.bits.eq(Cat(flags)),
            self.edge_bit.eq(edges.edge_bit),
        ]
        return m
