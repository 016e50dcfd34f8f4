# amaranth: UnusedElaboratable=no
"""Pixel classifier: chosen bits of a pixel, looked up in the table of a trained set of discriminators."""

from dataclasses import dataclass

import numpy as np
from amaranth.hdl import Cat, Module
from amaranth.lib.wiring import In, Out
from numpy.typing import ArrayLike, NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.lookup import Lookup
from hdl_templates.ports import named, tie_off

PIXEL_BITS = 24
"""Bits of a pixel: red in 23…16, green in 15…8, blue in 7…0."""


def pixel_words(pixels: ArrayLike) -> NDArray[np.int64]:
    """24-bit pixel words, int64 ``S``, of pixels, uint8 ``S + (3,)`` in the order red, green, blue."""
    channels = np.asarray(pixels, dtype=np.int64)
    return np.asarray(channels @ np.array([1 << 16, 1 << 8, 1]), dtype=np.int64)


@dataclass(frozen=True)
class Parameters:
    """What a pixel classifier reads and how it decides.

    Attributes:
        positions: for each code bit, least significant first, its position in the pixel word.
        lookup: the table over those bits; output ``j`` is bit ``j`` of the class index.
        class_count: classes told apart, at least 2; class 0 is the background.
    """

    positions: tuple[int, ...]
    lookup: Lookup
    class_count: int = 2

    def __post_init__(self) -> None:
        if len(self.positions) != len(self.lookup.inputs) or len(set(self.positions)) != len(self.positions):
            raise ValueError(
                f"a lookup of {len(self.lookup.inputs)} inputs needs as many different pixel bits, "
                f"not {self.positions}"
            )
        if not all(0 <= position < PIXEL_BITS for position in self.positions):
            raise ValueError(f"a pixel has bits 0 to {PIXEL_BITS - 1}, not {self.positions}")
        if self.class_count < 2:
            raise ValueError(f"at least 2 classes can be told apart, not {self.class_count}")
        if len(self.lookup.outputs) != self.class_width:
            raise ValueError(
                f"{self.class_count} classes need {self.class_width} outputs, not {len(self.lookup.outputs)}"
            )

    @property
    def class_width(self) -> int:
        """Bits of a class index."""
        return (self.class_count - 1).bit_length()

    def compute(self, pixels: ArrayLike) -> NDArray[np.int64]:
        """Golden model: class index, int64 ``S``, of 24-bit pixel words of shape ``S``."""
        words = np.asarray(pixels, dtype=np.int64)
        codes = np.zeros(words.shape, dtype=np.int64)
        for i, position in enumerate(self.positions):
            codes |= (words >> position & 1) << i
        weights = 1 << np.arange(self.class_width)
        return np.asarray(self.lookup.compute(codes) @ weights, dtype=np.int64)

    def create(self, name: str = "pixel") -> "Discriminator":
        """The hardware, as a module of this name."""
        return Discriminator(parameters=self, name=name)


class Discriminator(Part):
    """Pixel classifier; purely combinational, latency 0 cycles.

    Args:
        parameters: what it reads and how it decides.
        name: of its module; classifiers that differ need different ones.

    Members:
        rgb: In, 24 bits, the pixel.
        class_bits: Out, index of the class in binary.
    """

    def __init__(self, *, parameters: Parameters, name: str) -> None:
        self.parameters = parameters
        self.module_name = name
        super().__init__({"rgb": In(PIXEL_BITS), "class_bits": Out(parameters.class_width)})

    def elaborate(self, platform: object) -> Module:
        """Names the chosen bits and draws the lookup over them."""
        m = Module()
        positions, lookup = self.parameters.positions, self.parameters.lookup
        bits = [self.rgb[position] for position in positions]
        used = {position for i, position in enumerate(positions) if lookup.used >> i & 1}
        for i, name in enumerate(lookup.inputs):
            if positions[i] in used:
                bits[i] = named(m, name, bits[i], platform)
        m.d.comb += self.class_bits.eq(Cat(lookup.draw(m, bits, platform)))
        rest = [self.rgb[position] for position in range(PIXEL_BITS) if position not in used]
        tie_off(m, rest, platform)
        return m
