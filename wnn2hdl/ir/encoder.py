"""Encoders of pictures: how a pixel, or a pixel and its neighbours, becomes the bits that a network reads."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.codes import MAX_TABLE_INPUTS
from wnn2hdl.ir.context import Context
from wnn2hdl.ir.features import FeatureEncoder, Thermometer, ThermometerBits, Words
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.pixel_bits import BitSelect
from wnn2hdl.ir.relational import PixelEncoder, Relational
from wnn2hdl.ir.tables import pack_contents, unpack_contents


@dataclass(frozen=True)
class Tap:
    """A table that reads one pixel of a window and gives one bit.

    Attributes:
        row: of the pixel in the window, 0 at the top.
        column: of the pixel in the window, 0 at the left.
        pixel: the bits of the pixel that are read.
        contents: bit ``c`` is the answer for code ``c`` of ``pixel``.
    """

    row: int
    column: int
    pixel: BitSelect
    contents: int

    def __post_init__(self) -> None:
        if not 1 <= self.pixel.width <= MAX_TABLE_INPUTS:
            raise ValueError(f"a tap reads 1 to {MAX_TABLE_INPUTS} bits, not {self.pixel.width}")
        if not 0 <= self.contents < 1 << (1 << self.pixel.width):
            raise ValueError(f"the contents of a tap do not fit {self.pixel.width} bits")

    @cached_property
    def table(self) -> NDArray[np.bool_]:
        """The answer for every code of ``pixel``: bool ``[2**pixel.width]``."""
        return unpack_contents(self.contents, self.pixel.width)

    @classmethod
    def of(cls, row: int, column: int, pixel: BitSelect, table: NDArray[np.bool_]) -> Self:
        """The tap whose answers are ``table``, bool ``[2**pixel.width]``."""
        return cls(row, column, pixel, pack_contents(table))


@dataclass(frozen=True)
class Neighbourhood:
    """Bits of a pixel and its neighbours: each is a small table's answer for one pixel of a square window.

    In hardware each tap is a pixel circuit. Where pixels come as a stream, each table answers once
    per pixel, and its answers are delayed to their place in the window, one bit wide.

    Attributes:
        size: rows and columns of the window, odd; the classified pixel is in its middle.
        taps: the tables; tap ``i`` gives code bit ``i``. Several may read one pixel.
    """

    kind: ClassVar[str] = "neighbourhood"
    size: int
    taps: tuple[Tap, ...]

    def __post_init__(self) -> None:
        if self.size < 1 or self.size % 2 == 0:
            raise ValueError(f"a window has a pixel in its middle, so an odd size, not {self.size}")
        if not self.taps:
            raise ValueError("a neighbourhood needs at least one tap")
        for tap in self.taps:
            if not (0 <= tap.row < self.size and 0 <= tap.column < self.size):
                raise ValueError(f"row {tap.row}, column {tap.column} is outside of {self.size}x{self.size}")

    @property
    def width(self) -> int:
        """Bits of a code."""
        return len(self.taps)

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each code bit."""
        return tuple(f"tap{position}" for position in range(len(self.taps)))

    @cached_property
    def tables(self) -> tuple[Tap, ...]:
        """One tap for each different table: all that has to be found of a pixel, wherever it is seen."""
        found: dict[tuple[BitSelect, int], Tap] = {}
        for tap in self.taps:
            found.setdefault((tap.pixel, tap.contents), tap)
        return tuple(found.values())

    @cached_property
    def sources(self) -> tuple[int, ...]:
        """For each tap which of `tables` it is."""
        places = {(tap.pixel, tap.contents): place for place, tap in enumerate(self.tables)}
        return tuple(places[tap.pixel, tap.contents] for tap in self.taps)

    @property
    def halo(self) -> int:
        """Pixels of the window beyond the classified one, on each side."""
        return self.size // 2

    def codes(self, pictures: ArrayLike) -> NDArray[np.uint32]:
        """Codes of all windows that lie wholly inside pictures.

        Args:
            pictures: uint8 ``S + (height, width, 3)``; one smaller than a window has none.

        Returns:
            uint32 ``S + (height - size + 1, width - size + 1)``; bit ``i`` is the answer of ``taps[i]``.
        """
        array = np.asarray(pictures, dtype=np.uint8)
        height, width = (max(0, side - self.size + 1) for side in array.shape[-3:-1])
        codes = np.zeros((*array.shape[:-3], height, width), dtype=np.uint32)
        for position, tap in enumerate(self.taps):
            seen = array[..., tap.row : tap.row + height, tap.column : tap.column + width, :]
            codes |= np.take(tap.table, tap.pixel.codes(seen)).astype(np.uint32) << position
        return codes

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `encoder_from_json`; contents are hexadecimal."""
        taps = [
            {
                "row": tap.row,
                "column": tap.column,
                "bits": list(tap.pixel.bits),
                "contents": f"{tap.contents:x}",
            }
            for tap in self.taps
        ]
        return {"kind": self.kind, "size": self.size, "taps": taps}


PictureEncoder = PixelEncoder | Neighbourhood | Context
"""What makes codes of pictures; its ``halo`` is how many pixels at a picture's rim have none."""

Encoder = PictureEncoder | FeatureEncoder


def encoder_from_json(data: dict[str, Any]) -> Encoder:
    """The encoder that wrote ``data`` (already checked against the model schema).

    Raises:
        ValueError: bits, taps or thresholds that no encoder can have.
    """
    if data["kind"] == BitSelect.kind:
        return BitSelect(tuple(data["bits"]))
    if data["kind"] == Relational.kind:
        return Relational(tuple(data["bits"]))
    if data["kind"] == Context.kind:
        return Context(tuple(data["bits"]))
    if data["kind"] == Neighbourhood.kind:
        taps = (
            Tap(tap["row"], tap["column"], BitSelect(tuple(tap["bits"])), int(tap["contents"], 16))
            for tap in data["taps"]
        )
        return Neighbourhood(data["size"], tuple(taps))
    if data["kind"] == Words.kind:
        return Words(data["features"], data["word_bits"])
    if data["kind"] == ThermometerBits.kind:
        return ThermometerBits(data["thermometers"], data["levels"])
    thresholds = tuple(tuple(float(x) for x in levels) for levels in data["thresholds"])
    words = FixedPoint.from_json(data["input"]) if "input" in data else None
    return Thermometer(thresholds, data["strict"], words)
