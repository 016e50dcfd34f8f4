"""Encoders of feature vectors: thermometers, and words taken as they are."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.fixed_point import FixedPoint


@dataclass(frozen=True)
class Thermometer:
    """Each feature compared with its own thresholds.

    Attributes:
        thresholds: per feature, its thresholds, none lower than the one before. Bit ``t`` of a feature is
            ``x >= thresholds[t]``, or ``x > thresholds[t]`` if ``strict``; bits are feature-major: all of
            feature 0, then all of feature 1.
        strict: whether a feature at its threshold leaves the bit unset.
        input: the words hardware reads; features are turned into words first. None: features are real
            numbers, and hardware needs a format before it can be made.
    """

    kind: ClassVar[str] = "thermometer"
    thresholds: tuple[tuple[float, ...], ...]
    strict: bool = False
    input: FixedPoint | None = None

    def __post_init__(self) -> None:
        for feature, levels in enumerate(self.thresholds):
            if not all(np.isfinite(levels)) or any(a > b for a, b in pairwise(levels)):
                raise ValueError(f"the thresholds of feature {feature} do not rise: {levels}")
        if self.width == 0:
            raise ValueError("a thermometer needs at least one threshold")

    @property
    def features(self) -> int:
        """Numbers in a feature vector."""
        return len(self.thresholds)

    @cached_property
    def width(self) -> int:
        """Bits of a code."""
        return sum(len(levels) for levels in self.thresholds)

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each code bit: ``x3_t0`` is feature 3 against its first threshold."""
        return tuple(f"x{f}_t{t}" for f, levels in enumerate(self.thresholds) for t in range(len(levels)))

    @cached_property
    def levels(self) -> tuple[tuple[int, ...], ...]:
        """Per feature, the lowest word that sets each of its bits (see `FixedPoint.level`).

        Raises:
            ValueError: features are real numbers.
        """
        if self.input is None:
            raise ValueError("the thermometer reads real numbers; it has no levels of words")
        of = self.input.level
        return tuple(tuple(of(t, strict=self.strict) for t in feature) for feature in self.thresholds)

    def bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """Bits of feature vectors.

        Args:
            features: numbers, ``[samples, features]``.

        Returns:
            bool ``[samples, width]``.
        """
        if self.input is not None:
            return self.bits_of_words(self.input.words(features))
        array = _matrix(features, self.features, np.float64)
        compare = np.greater if self.strict else np.greater_equal
        columns = [compare(array[:, f, np.newaxis], np.asarray(t)) for f, t in enumerate(self.thresholds)]
        return np.concatenate(columns, axis=1)

    def bits_of_words(self, words: ArrayLike) -> NDArray[np.bool_]:
        """Bits of the words that hardware reads.

        Args:
            words: whole numbers, ``[samples, features]``, in the range of ``input``.

        Returns:
            bool ``[samples, width]``, those of ``input.values(words)`` compared as real numbers.
        """
        array = _matrix(words, self.features, np.int64)
        columns = [
            array[:, f, np.newaxis] >= np.asarray(t, dtype=np.int64) for f, t in enumerate(self.levels)
        ]
        return np.concatenate(columns, axis=1)

    def port_bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """What hardware reads: the words of all features side by side, each the least significant bit first.

        Args:
            features: numbers, ``[samples, features]``.

        Returns:
            bool ``[samples, features * input.bits]``.

        Raises:
            ValueError: features are real numbers to the thermometer.
        """
        if self.input is None:
            raise ValueError("the thermometer reads real numbers, not words")
        words = self.input.words(_matrix(features, self.features, np.float64))
        digits = words[..., np.newaxis] >> np.arange(self.input.bits) & 1
        return digits.astype(np.bool_).reshape(len(words), -1)

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `encoder_from_json`."""
        data = {
            "kind": self.kind,
            "thresholds": [list(levels) for levels in self.thresholds],
            "strict": self.strict,
        }
        return data if self.input is None else data | {"input": self.input.to_json()}


@dataclass(frozen=True)
class Words:
    """Features that are whole numbers from 0, taken bit by bit: pure wiring, no logic.

    With words of one bit a network reads its bits as they are; so do models whose file holds no thresholds.

    Attributes:
        features: numbers in a feature vector.
        word_bits: bits of each, 1 to 16. Code bit ``f * word_bits + b`` is bit ``b`` of feature ``f``, 0 the
            least significant.
    """

    kind: ClassVar[str] = "words"
    features: int
    word_bits: int = 1

    def __post_init__(self) -> None:
        if self.features < 1 or not 1 <= self.word_bits <= 16:
            raise ValueError(f"no words: {self.features} of {self.word_bits} bits")

    @property
    def width(self) -> int:
        """Bits of a code."""
        return self.features * self.word_bits

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each code bit: ``x3`` of one bit, ``x3_b0`` of several."""
        if self.word_bits == 1:
            return tuple(f"x{f}" for f in range(self.features))
        return tuple(f"x{f}_b{b}" for f in range(self.features) for b in range(self.word_bits))

    def bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """Bits of feature vectors.

        Args:
            features: whole numbers from 0 to ``2**word_bits - 1``, or bool, ``[samples, features]``.

        Returns:
            bool ``[samples, width]``.

        Raises:
            ValueError: other numbers.
        """
        array = _matrix(features, self.features, None)
        with np.errstate(invalid="ignore"):  # NaN becomes some number, which is then not equal to it
            words = array.astype(np.int64)
        whole = np.array_equal(words, array)
        if not whole or words.min(initial=0) < 0 or words.max(initial=0) >> self.word_bits:
            raise ValueError(f"features must be whole numbers from 0 to {(1 << self.word_bits) - 1}")
        split = words[..., np.newaxis] >> np.arange(self.word_bits) & 1
        return split.astype(np.bool_).reshape(len(words), self.width)

    def port_bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """What hardware reads, which is `bits`."""
        return self.bits(features)

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `encoder_from_json`."""
        return {"kind": self.kind, "features": self.features, "word_bits": self.word_bits}


@dataclass(frozen=True)
class ThermometerBits:
    """Bits of thermometers that stand outside of the model: pure wiring, no logic.

    Bit ``t * thermometers + i`` says whether number ``i`` reaches its threshold ``t``. The thresholds rise,
    so a set bit of a thermometer is preceded by set bits only; nothing else is an input.

    Attributes:
        thermometers: numbers that were compared.
        levels: thresholds of each.
    """

    kind: ClassVar[str] = "thermometer-bits"
    thermometers: int
    levels: int

    def __post_init__(self) -> None:
        if self.thermometers < 1 or self.levels < 1:
            raise ValueError(f"no thermometers: {self.thermometers} of {self.levels} bits")

    @property
    def features(self) -> int:
        """Numbers in a feature vector: a bit is one."""
        return self.width

    @property
    def width(self) -> int:
        """Bits of a code."""
        return self.thermometers * self.levels

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each code bit: ``x3_t0`` is number 3 against its first threshold."""
        return tuple(f"x{f}_t{t}" for t in range(self.levels) for f in range(self.thermometers))

    @property
    def falling(self) -> tuple[tuple[int, ...], ...]:
        """The positions of each thermometer's bits, the lowest threshold first."""
        return tuple(tuple(range(f, self.width, self.thermometers)) for f in range(self.thermometers))

    def bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """The bits that were given.

        Args:
            features: 0 and 1, or bool, ``[samples, width]``.

        Returns:
            bool ``[samples, width]``.

        Raises:
            ValueError: other numbers, or a set bit after one that is not set.
        """
        array = _matrix(features, self.width, None)
        flags: NDArray[np.bool_] = array == 1
        if not (flags | (array == 0)).all():
            raise ValueError("thermometer bits must be 0 or 1")
        levels = flags.reshape(len(flags), self.levels, self.thermometers)
        if (levels[:, 1:] & ~levels[:, :-1]).any():
            raise ValueError("a number reaches a threshold, but not the one before")
        return flags

    def port_bits(self, features: ArrayLike) -> NDArray[np.bool_]:
        """What hardware reads, which is `bits`."""
        return self.bits(features)

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `encoder_from_json`."""
        return {"kind": self.kind, "thermometers": self.thermometers, "levels": self.levels}


FeatureEncoder = Thermometer | Words | ThermometerBits


def _matrix(values: ArrayLike, features: int, dtype: type[np.generic] | None) -> NDArray[Any]:
    array = np.asarray(values, dtype=dtype)
    if array.ndim != 2 or array.shape[1] != features:
        raise ValueError(f"features must be [samples, {features}], not of shape {list(array.shape)}")
    return array
