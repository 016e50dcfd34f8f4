# amaranth: UnusedElaboratable=no
"""Classifier of a pixel and its neighbours: tables at pixels of a window, and a table over their bits."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Cat, Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates import discriminator
from hdl_templates.discriminator import PIXEL_BITS
from hdl_templates.hierarchy import Part, place
from hdl_templates.lookup import Lookup
from hdl_templates.ports import tie_off


@dataclass(frozen=True)
class Parameters:
    """What is read, and how it is decided.

    Attributes:
        size: rows and columns of the window.
        taps: for each bit of the code, least significant first, a pixel's place in the window
            (``size * row + column``) and its table, a pixel classifier of two classes.
        lookup: the table over the code; output ``j`` is bit ``j`` of the class index.
    """

    size: int
    taps: tuple[tuple[int, discriminator.Parameters], ...]
    lookup: Lookup

    def __post_init__(self) -> None:
        if len(self.taps) != len(self.lookup.inputs):
            raise ValueError(
                f"a lookup of {len(self.lookup.inputs)} inputs cannot read {len(self.taps)} taps"
            )
        for where, table in self.taps:
            if not 0 <= where < self.size**2:
                raise ValueError(f"a window has pixels 0 to {self.size**2 - 1}, not {where}")
            if table.class_count != 2:
                raise ValueError(f"a tap gives one bit, so it tells 2 classes apart, not {table.class_count}")

    def compute(self, windows: ArrayLike) -> NDArray[np.int64]:
        """Golden model: class index, int64 ``S``, of windows of pixel words, ``S + (size * size,)``."""
        words = np.asarray(windows, dtype=np.int64)
        codes = np.zeros(words.shape[:-1], dtype=np.int64)
        for i, (where, table) in enumerate(self.taps):
            codes |= table.compute(words[..., where]) << i
        weights = 1 << np.arange(len(self.lookup.outputs))
        return np.asarray(self.lookup.compute(codes) @ weights, dtype=np.int64)

    def create(self) -> "Neighbourhood":
        """The hardware."""
        return Neighbourhood(parameters=self)


class Neighbourhood(Part):
    """Classifier of a pixel and its neighbours; purely combinational, latency 0 cycles.

    Args:
        parameters: what it reads and how it decides.

    Members:
        window: In, 24 bits a pixel; pixel ``i`` (``size * row + column``) is ``window[24 * i +: 24]``.
        class_bits: Out, index of the class of the pixel in the middle, in binary.
    """

    module_name = "neighbourhood"

    def __init__(self, *, parameters: Parameters) -> None:
        self.parameters = parameters
        super().__init__(
            {
                "window": In(parameters.size**2 * PIXEL_BITS),
                "class_bits": Out(len(parameters.lookup.outputs)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        """Places the tables at their pixels and draws the lookup over their bits."""
        m = Module()
        bits = []
        for i, (where, parameters) in enumerate(self.parameters.taps):
            table = parameters.create(f"tap_{i}")
            place(m, f"place_{i}", table, platform)
            m.d.comb += table.rgb.eq(self.window.word_select(where, PIXEL_BITS))
            bits.append(table.class_bits)
        m.d.comb += self.class_bits.eq(Cat(self.parameters.lookup.draw(m, bits, platform)))
        read = {where for where, _ in self.parameters.taps}
        rest = [i for i in range(self.parameters.size**2) if i not in read]
        tie_off(m, [self.window.word_select(i, PIXEL_BITS) for i in rest], platform)
        return m
