"""Context encoders: in how many pixels of a square a bit is set, beside bits of the pixel itself.

A bit of every pixel, such as ``3R>=2B``, makes a *plane*. Around a pixel the ones of a plane are counted in a
square, and compared with thresholds. In hardware a count is two running sums, down the columns and along the
line, whatever the size of the square; each pixel is compared once.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.codes import all_codes
from wnn2hdl.ir.pixel_bits import PIXEL_BIT_NAMES, NamedBits
from wnn2hdl.ir.relational import Comparison, pixel_codes

SIZES = (3, 7, 15, 31)
"""Sides of squares, each a power of two less one: so a sum that begins at a border is a shift."""

_PATTERN = re.compile(r"(?P<size>\d{1,2})x(?P=size)\((?P<plane>[^()]+)\)>=(?P<least>[1-9]\d{0,2})")


@dataclass(frozen=True)
class Count:
    """Whether a bit is set in enough pixels of a square: ``7x7(3R>=2B)>=13``, or ``3R>=2B`` of the pixel.

    Attributes:
        plane: the bit, as `wnn2hdl.ir.relational.Relational` names it.
        size: rows and columns of the square with the pixel in its middle: 1, or of `SIZES`.
        least: how many of its pixels, 1 to ``size**2``; fewer give 0, more give 1.
    """

    plane: str
    size: int = 1
    least: int = 1

    def __post_init__(self) -> None:
        if self.plane not in PIXEL_BIT_NAMES:
            Comparison.parse(self.plane)
        if self.size not in (1, *SIZES):
            raise ValueError(f"a square has a side of {', '.join(map(str, SIZES))} pixels, not {self.size}")
        if not 1 <= self.least <= self.size**2:
            raise ValueError(
                f"of {self.size**2} pixels 1 to {self.size**2} can be asked for, not {self.least}"
            )

    def __str__(self) -> str:
        return self.plane if self.size == 1 else f"{self.size}x{self.size}({self.plane})>={self.least}"

    @classmethod
    def parse(cls, text: str) -> Self:
        """The inverse of `str`.

        Raises:
            ValueError: it is no such name.
        """
        match = _PATTERN.fullmatch(text)
        if match is None:
            return cls(text)
        count = cls(match["plane"], int(match["size"]), int(match["least"]))
        if str(count) != text:
            raise ValueError(f"{text!r} is written {count}")
        return count


@dataclass(frozen=True)
class Context(NamedBits):
    """Bits of a pixel, and counts of such bits in the squares around it.

    Attributes:
        bits: names as `Count` writes them, at least one of a square. The first named is code bit 0.
    """

    kind: ClassVar[str] = "context"

    def __post_init__(self) -> None:
        if len(set(self.bits)) != len(self.bits):
            raise ValueError(f"a bit is named twice in {', '.join(self.bits)}")
        if not self.halo:
            raise ValueError("a context counts in a square at least once; use another kind for bits alone")

    @cached_property
    def counts(self) -> tuple[Count, ...]:
        """What each code bit stands for."""
        return tuple(map(Count.parse, self.bits))

    @property
    def halo(self) -> int:
        """Pixels of the largest square beyond the classified one, on each side."""
        return max(count.size for count in self.counts) // 2

    @property
    def planes(self) -> tuple[str, ...]:
        """The bits that every pixel has to have, in the order in which they are first named."""
        return tuple(dict.fromkeys(count.plane for count in self.counts))

    @cached_property
    def sums(self) -> tuple[tuple[str, int], ...]:
        """Plane and size of all that is compared: of the pixel alone, size 1, then of squares."""
        found = dict.fromkeys((count.plane, count.size) for count in self.counts)
        return tuple(sorted(found, key=lambda sum_of: sum_of[1] > 1))

    @property
    def widths(self) -> tuple[int, ...]:
        """Bits of each of `sums`."""
        return tuple((size * size).bit_length() for _, size in self.sums)

    @property
    def possible(self) -> NDArray[np.bool_]:
        """Which codes do not contradict themselves: bool ``[2**width]``.

        Where a square has many pixels with a bit, it has few, too. What planes have to do with one another
        is left open.
        """
        codes = all_codes(self.width)
        flags = np.ones(len(codes), dtype=np.bool_)
        for many, count in enumerate(self.counts):
            for few, other in enumerate(self.counts):
                same = (count.plane, count.size) == (other.plane, other.size)
                if same and other.least < count.least:
                    flags &= (codes >> few & 1) >= (codes >> many & 1)
        return flags

    def codes(self, pictures: ArrayLike) -> NDArray[np.uint32]:
        """Codes of all pixels whose largest square lies inside the pictures.

        Args:
            pictures: uint8 ``S + (height, width, 3)``; one smaller than a square has none.

        Returns:
            uint32 ``S + (height - 2 * halo, width - 2 * halo)``; bit ``i`` is ``bits[i]``.
        """
        array = np.asarray(pictures, dtype=np.uint8)
        height, width = (max(0, side - 2 * self.halo) for side in array.shape[-3:-1])
        if not height * width:
            return np.zeros((*array.shape[:-3], height, width), dtype=np.uint32)
        planes = {name: pixel_codes((name,), array) for name in self.planes}
        found = []
        for plane, size in self.sums:
            rim = self.halo - size // 2
            inner = slice(rim, rim + height + size - 1), slice(rim, rim + width + size - 1)
            found.append(box_sums(planes[plane][..., *inner], size))
        return self.compared(found)

    def compared(self, sums: Sequence[NDArray[np.integer]]) -> NDArray[np.uint32]:
        """Codes of pixels whose sums are known: one array for each of `sums`, all of the codes' shape."""
        codes = np.zeros(sums[0].shape, dtype=np.uint32)
        places = {sum_of: place for place, sum_of in enumerate(self.sums)}
        for position, count in enumerate(self.counts):
            bit = sums[places[count.plane, count.size]] >= count.least
            codes |= bit.astype(np.uint32) << position
        return codes


def box_sums(plane: NDArray[np.generic], size: int) -> NDArray[np.int32]:
    """Sums over all squares that lie inside planes.

    Args:
        plane: whole numbers below 256 or bools, ``S + (height, width)``, both at least ``size``.
        size: rows and columns of a square.

    Returns:
        int32 ``S + (height - size + 1, width - size + 1)``.
    """
    sums = plane.astype(np.int32)
    if size > 1:
        for axis in (-2, -1):
            sums = np.moveaxis(sums, axis, 0)
            ends = sums.cumsum(axis=0, dtype=np.int32)
            sums = ends[size - 1 :].copy()
            sums[1:] -= ends[:-size]
            sums = np.moveaxis(sums, 0, axis)
    return sums
