"""Relational encoders: bits that compare channels of a pixel with one another, beside bits of the channels.

More light multiplies all channels of a pixel by nearly the same factor, so that ``3R >= 2B``, which compares
a ratio with a constant, answers alike in shade and sun, where a bit of one channel does not. Differences and
ladders of ratios are several such bits; the greatest or the least of channels is a function of them that
costs nothing beyond the table that reads them.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.codes import MAX_TABLE_INPUTS
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS, CHANNELS, PIXEL_BIT_NAMES, BitSelect, NamedBits

MAX_WEIGHT = 99
"""The largest weight of a channel."""

MAX_OFFSET = 99_999
"""The largest offset, of either sign."""

_TERM = r"(?:[1-9]\d?)?[RGB](?:\[[0-7]:[0-7]\])?"
_SIDE = rf"{_TERM}(?:\+{_TERM})*"
_PATTERN = re.compile(
    rf"(?P<left>{_SIDE})>=(?:(?P<right>{_SIDE})(?P<offset>[+-]\d{{1,5}})?|(?P<alone>-?\d{{1,5}}))"
)


@dataclass(frozen=True)
class Weighted:
    """A channel times a weight.

    Attributes:
        channel: of `CHANNELS`.
        weight: 1 to `MAX_WEIGHT`.
        low: the lowest bit of the channel that is read.
        high: the highest; bits ``high`` to ``low`` are the number. Without the bits above, a level of
            ``2**(high + 1)`` counts as 0: what reads the comparison has to read those bits, too.
    """

    channel: str
    weight: int = 1
    low: int = 0
    high: int = CHANNEL_BITS - 1

    def __str__(self) -> str:
        return (
            f"{self.weight if self.weight > 1 else ''}{self.channel}"
            f"{f'[{self.high}:{self.low}]' if (self.high, self.low) != (CHANNEL_BITS - 1, 0) else ''}"
        )

    @classmethod
    def parse(cls, text: str) -> Self:
        """The inverse of `str`."""
        digits = re.match(r"\d*", text)
        assert digits is not None
        channel = text[digits.end()]
        high, low = (int(text[-4]), int(text[-2])) if text.endswith("]") else (CHANNEL_BITS - 1, 0)
        return cls(channel, int(digits.group() or 1), low, high)

    @property
    def bits(self) -> tuple[str, ...]:
        """The pixel bits that are read, the least significant first."""
        return tuple(f"{self.channel}{bit}" for bit in range(self.low, self.high + 1))

    @cached_property
    def levels(self) -> NDArray[np.int64]:
        """The value for each level of the channel: int64 ``[256]``."""
        whole = np.arange(1 << CHANNEL_BITS)
        return self.weight * ((whole & (2 << self.high) - 1) >> self.low)


@dataclass(frozen=True)
class Comparison:
    """Whether a weighted sum of channels is at least another, and an offset: ``3R[7:1]>=2B[7:2]+4``.

    Numbers are compared as they are, without wrap-around: the sums take as many bits as they need.

    Attributes:
        left: at least one term.
        right: any number of terms; no channel occurs twice in left and right together.
        offset: is added to the right, -`MAX_OFFSET` to `MAX_OFFSET`.
    """

    left: tuple[Weighted, ...]
    right: tuple[Weighted, ...] = ()
    offset: int = 0

    def __post_init__(self) -> None:
        terms = self.left + self.right
        if not self.left or len({term.channel for term in terms}) != len(terms):
            raise ValueError(f"{self} needs a channel on its left, and each channel once at most")
        for term in terms:
            if not (1 <= term.weight <= MAX_WEIGHT and 0 <= term.low <= term.high < CHANNEL_BITS):
                raise ValueError(f"{term} has a weight beyond {MAX_WEIGHT}, or reads no bits")
        if abs(self.offset) > MAX_OFFSET:
            raise ValueError(f"the offset of {self} is beyond {MAX_OFFSET}")
        if len(self.bits) > MAX_TABLE_INPUTS:
            raise ValueError(f"{self} reads {len(self.bits)} bits; a table reads {MAX_TABLE_INPUTS} at most")

    def __str__(self) -> str:
        left, right = ("+".join(map(str, terms)) for terms in (self.left, self.right))
        if not right:
            return f"{left}>={self.offset}"
        return f"{left}>={right}{f'{self.offset:+d}' if self.offset else ''}"

    @classmethod
    def parse(cls, text: str) -> Self:
        """The comparison of a name.

        Raises:
            ValueError: it is no such name, or not the one that the comparison would have.
        """
        match = _PATTERN.fullmatch(text)
        if match is None:
            raise ValueError(f"{text!r} compares no channels; write it as in 3R>=2B+16 or 3R[7:1]>=2B[7:2]")
        left, right = (
            tuple(map(Weighted.parse, side.split("+"))) if side else ()
            for side in match.group("left", "right")
        )
        comparison = cls(left, right, int(match["offset"] or match["alone"] or 0))
        if str(comparison) != text:
            raise ValueError(f"{text!r} is written {comparison}")
        return comparison

    @property
    def bits(self) -> tuple[str, ...]:
        """The pixel bits that are read: channel by channel as they are named, the least significant first."""
        return tuple(bit for term in self.left + self.right for bit in term.bits)

    def evaluate(self, pixels: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """The answer for pixels of shape ``S + (3,)``: bool ``S``."""
        return self.slack(pixels) >= 0

    def slack(self, pixels: NDArray[np.uint8]) -> NDArray[np.int64]:
        """By how much the left exceeds the right, for pixels of shape ``S + (3,)``: int64 ``S``."""
        slack = np.full(pixels.shape[:-1], -self.offset, dtype=np.int64)
        for terms, sign in (self.left, 1), (self.right, -1):
            for term in terms:
                slack += np.take(sign * term.levels, pixels[..., CHANNELS.index(term.channel)])
        return slack

    def table(self) -> NDArray[np.bool_]:
        """The answer for every code of `bits`: bool ``[2**len(bits)]``."""
        codes = np.arange(1 << len(self.bits))
        pixels = np.zeros((len(codes), len(CHANNELS)), dtype=np.uint8)
        for position, name in enumerate(self.bits):
            pixels[:, CHANNELS.index(name[0])] |= (codes >> position & 1).astype(np.uint8) << int(name[1])
        return self.evaluate(pixels)


def pixel_codes(names: Sequence[str], pixels: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Codes of pixels by named bits, comparisons among them or not.

    Args:
        names: as in `Relational.bits`.
        pixels: uint8 ``S + (3,)``.

    Returns:
        uint32 ``S``; bit ``i`` is ``names[i]``.
    """
    codes = np.zeros(pixels.shape[:-1], dtype=np.uint32)
    for position, name in enumerate(names):
        if name in PIXEL_BIT_NAMES:
            bit = pixels[..., CHANNELS.index(name[0])] >> int(name[1]) & 1 > 0
        else:
            bit = Comparison.parse(name).evaluate(pixels)
        codes |= bit.astype(np.uint32) << position
    return codes


@dataclass(frozen=True)
class Relational(NamedBits):
    """Comparisons of channels, and bits of channels.

    Attributes:
        bits: names such as ``R7``, as in `BitSelect`, or ``3R>=2B+16``, as `Comparison` writes them. The
            first named is code bit 0.
    """

    kind: ClassVar[str] = "relational"

    def __post_init__(self) -> None:
        if not self.comparisons:
            raise ValueError("a relational encoder compares something; use another kind for bits alone")
        if len(set(self.bits)) != len(self.bits):
            raise ValueError(f"a bit is named twice in {', '.join(self.bits)}")

    @cached_property
    def comparisons(self) -> dict[int, Comparison]:
        """The code bits that compare, and what."""
        return {
            position: Comparison.parse(name)
            for position, name in enumerate(self.bits)
            if name not in PIXEL_BIT_NAMES
        }

    def codes(self, pixels: ArrayLike) -> NDArray[np.uint32]:
        """Codes of pixels.

        Args:
            pixels: uint8 ``S + (3,)``, channels in the order of `CHANNELS`.

        Returns:
            uint32 ``S``; bit ``i`` is ``bits[i]``.
        """
        return pixel_codes(self.bits, np.asarray(pixels, dtype=np.uint8))


def signal_name(name: str) -> str:
    """The name of a code bit as an identifier: ``is_3R_7_1_ge_2B_plus_4`` for ``3R[7:1]>=2B+4``.

    That of a count in a square (`wnn2hdl.ir.context`) likewise: ``is_7x7_R7_ge_13`` for ``7x7(R7)>=13``.
    """
    if ">=" not in name:
        return name
    words = {">=": "_ge_", "+": "_plus_", "-": "_minus_", "[": "_", ":": "_", "]": "", "(": "_", ")": ""}
    for sign, word in words.items():
        name = name.replace(sign, word)
    return f"is_{name.replace('__', '_')}"


PixelEncoder = BitSelect | Relational
"""What makes codes of single pixels."""


@lru_cache(maxsize=32)
def examples(encoder: Relational) -> dict[int, tuple[int, int, int]]:
    """One pixel of every code that occurs at all, of all ``2**24``: code to red, green and blue.

    Comparisons exclude one another, as ``R>=40`` does ``R>=20``: most codes of a ladder cannot occur.
    """
    side = 1 << CHANNEL_BITS
    plane = np.zeros((side, side, len(CHANNELS)), dtype=np.uint8)
    plane[..., 1], plane[..., 2] = np.arange(side)[:, np.newaxis], np.arange(side)
    found: dict[int, tuple[int, int, int]] = {}
    for red in range(side):
        plane[..., 0] = red
        codes, places = np.unique(encoder.codes(plane), return_index=True)
        for code, place in zip(codes.tolist(), places.tolist(), strict=True):
            found.setdefault(code, (red, place // side, place % side))
    return found


def grey_codes(encoder: PixelEncoder) -> NDArray[np.bool_]:
    """Which codes occur on grey pixels, whose channels are equal: bool ``[2**width]``."""
    greys = np.repeat(np.arange(1 << CHANNEL_BITS, dtype=np.uint8)[:, np.newaxis], len(CHANNELS), axis=1)
    flags = np.zeros(1 << encoder.width, dtype=np.bool_)
    flags[encoder.codes(greys)] = True
    return flags


def occurring(encoder: PixelEncoder) -> NDArray[np.bool_]:
    """Which codes occur on any pixel: bool ``[2**width]``; all of a `BitSelect`."""
    if isinstance(encoder, BitSelect):
        return np.ones(1 << encoder.width, dtype=np.bool_)
    flags = np.zeros(1 << encoder.width, dtype=np.bool_)
    flags[list(examples(encoder))] = True
    return flags
