"""Fixed-point words: the numbers that hardware reads."""

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

MAX_WORD_BITS = 48
"""The widest fixed-point word; a float64 holds each of its values exactly."""

MAX_FRACTION_BITS = 64

_NOTATION = re.compile(r"(U?)Q(\d{1,2})\.(\d{1,2})", re.ASCII)


@dataclass(frozen=True)
class FixedPoint:
    """Numbers as hardware reads them: word ``w`` stands for ``w / 2**fraction``.

    Q3.12 with a sign is ``FixedPoint(bits=16, fraction=12)``.

    Attributes:
        bits: of a word, its sign included, 1 to `MAX_WORD_BITS`.
        fraction: how many of them are behind the binary point, 0 to `MAX_FRACTION_BITS`.
        signed: whether words are in two's complement.
    """

    bits: int
    fraction: int
    signed: bool = True

    def __post_init__(self) -> None:
        if not 1 <= self.bits <= MAX_WORD_BITS:
            raise ValueError(f"a word has 1 to {MAX_WORD_BITS} bits, not {self.bits}")
        if not 0 <= self.fraction <= MAX_FRACTION_BITS:
            raise ValueError(f"a word has 0 to {MAX_FRACTION_BITS} fraction bits, not {self.fraction}")

    @property
    def lowest(self) -> int:
        """The lowest word."""
        return -(1 << (self.bits - 1)) if self.signed else 0

    @property
    def highest(self) -> int:
        """The highest word."""
        return (1 << (self.bits - 1 if self.signed else self.bits)) - 1

    def words(self, values: ArrayLike) -> NDArray[np.int64]:
        """Words of numbers of any shape: rounded down, which costs no hardware, and saturated.

        Raises:
            ValueError: a number is NaN, which is neither low nor high.
        """
        array = np.asarray(values, dtype=np.float64)
        if np.isnan(array).any():
            raise ValueError("a feature is NaN")
        # A number too large for float64 becomes infinite and saturates as it should.
        with np.errstate(over="ignore"):
            scaled = np.floor(np.ldexp(array, self.fraction))
        return np.asarray(np.clip(scaled, self.lowest, self.highest).astype(np.int64))

    def values(self, words: ArrayLike) -> NDArray[np.float64]:
        """The numbers that words stand for, exactly."""
        return np.asarray(np.ldexp(np.asarray(words, dtype=np.float64), -self.fraction))

    def level(self, threshold: float, *, strict: bool) -> int:
        """The lowest word whose number is above the threshold, or at it unless ``strict``.

        The answer lies between `lowest`, if every word is, and ``highest + 1``, if none is.
        """
        exact = Fraction(threshold) * (1 << self.fraction)
        word = math.floor(exact) + 1 if strict else math.ceil(exact)
        return min(max(word, self.lowest), self.highest + 1)

    def __str__(self) -> str:
        """As engineers write it: ``Q3.12`` with a sign bit, ``UQ8.0`` without."""
        whole = self.bits - self.fraction - self.signed
        return f"{'' if self.signed else 'U'}Q{whole}.{self.fraction}"

    @classmethod
    def parse(cls, text: str) -> Self:
        """The inverse of ``str``; raises ValueError on anything else."""
        match = _NOTATION.fullmatch(text)
        if match is None:
            raise ValueError(f"{text!r} is not a format of words, as Q3.12 or UQ8.0")
        signed, whole, fraction = not match[1], int(match[2]), int(match[3])
        return cls(whole + fraction + signed, fraction, signed)

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `from_json`."""
        return {"bits": self.bits, "fraction": self.fraction, "signed": self.signed}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The format that wrote ``data``."""
        return cls(data["bits"], data["fraction"], data["signed"])
