# amaranth: UnusedElaboratable=no
"""3x3 edge filter on binary windows: a table of the patterns that count as an edge."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.lookup import Lookup
from hdl_templates.ports import tie_off

WINDOW_BITS = 9
"""Bits of a window; bit ``3 * row + column``."""


@dataclass(frozen=True)
class Parameters:
    """The patterns, as a lookup of nine inputs (input ``i`` is bit ``i`` of the window) and one output."""

    lookup: Lookup

    def __post_init__(self) -> None:
        shape = len(self.lookup.inputs), len(self.lookup.outputs)
        if shape != (WINDOW_BITS, 1):
            raise ValueError(
                f"an edge filter looks up {WINDOW_BITS} bits for 1, not {shape[0]} for {shape[1]}"
            )

    def compute(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Golden model: edge bit, bool ``S``, of window codes of shape ``S``."""
        return self.lookup.compute(codes)[..., 0]

    def create(self) -> "EdgeFilter":
        """The hardware."""
        return EdgeFilter(parameters=self)


class EdgeFilter(Part):
    """3x3 edge filter; purely combinational, latency 0 cycles.

    Args:
        parameters: the patterns.

    Members:
        bits: In, 9 bits, the binary window.
        edge_bit: Out, 1 where the window is one of the patterns.
    """

    module_name = "edge_filter"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        super().__init__({"bits": In(WINDOW_BITS), "edge_bit": Out(1)})

    def elaborate(self, platform: object) -> Module:
        """Draws the lookup over the nine bits."""
        m = Module()
        lookup = self.parameters.lookup
        (edge_bit,) = lookup.draw(m, list(self.bits), platform)
        m.d.comb += self.edge_bit.eq(edge_bit)
        tie_off(m, [self.bits[i] for i in range(WINDOW_BITS) if not lookup.used >> i & 1], platform)
        return m
