"""The nodes of a circuit: what each kind reads, drives and computes.

Every kind has its golden evaluation here, its hardware in `wnn2hdl.elaborate`, its cost in LUTs by synthesis,
and is covered by the proof of the circuit that it stands in.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from wnn2hdl.ir.codes import bits_to_codes, codes_to_bits
from wnn2hdl.ir.models.logic import LogicModel
from wnn2hdl.ir.network import LutNetwork
from wnn2hdl.ir.tables import TruthTable
from wnn2hdl.ir.wires import Bits, Word, width_of

MAX_NUMBER = 63
"""The most bits of a word that is read as a number."""

MAX_CYCLES = 1 << 16
"""The longest delay."""

Function = TruthTable | LogicModel | LutNetwork
"""What a `Table` computes: as it was extracted, as gates, or mapped to LUTs."""


@dataclass(frozen=True, eq=False)
class Table:
    """A Boolean function of several outputs; as a truth table it has at most `MAX_TABLE_INPUTS` inputs.

    Attributes:
        name: of the node and of the net it drives, one bit for each output of the function.
        word: the inputs; bit ``i`` is input ``i`` of the function.
        function: the function.
    """

    kind: ClassVar[str] = "table"
    name: str
    word: Word
    function: Function

    def __post_init__(self) -> None:
        if width_of(self.word) != len(self.function.inputs):
            raise ValueError(f"{self.name} reads {width_of(self.word)} bits for {self.function.inputs}")

    @property
    def reads(self) -> tuple[Word, ...]:
        """The words that the node reads."""
        return (self.word,)

    @property
    def drives(self) -> Mapping[str, int]:
        """Width of each net that the node drives, by name."""
        return {self.name: len(self.function.outputs)}

    @property
    def latency(self) -> int:
        """Cycles from what the node reads to what it drives."""
        return 0

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """The nets that the node drives, from the values of the words that it reads."""
        if isinstance(self.function, LutNetwork):
            return {self.name: self.function.evaluate_bits(values[0])}
        if isinstance(self.function, LogicModel):
            return {self.name: self.function.evaluate(values[0])}
        return {self.name: self.function.evaluate(bits_to_codes(values[0]))}


@dataclass(frozen=True)
class Threshold:
    """One bit: whether an unsigned word of at most `MAX_NUMBER` bits is at least a constant."""

    kind: ClassVar[str] = "threshold"
    name: str
    word: Word
    at_least: int

    def __post_init__(self) -> None:
        if width_of(self.word) > MAX_NUMBER:
            raise ValueError(f"{self.name} compares words of more than {MAX_NUMBER} bits")

    @property
    def constant(self) -> bool | None:
        """The answer, where it is the same for every word."""
        if self.at_least <= 0:
            return True
        return False if self.at_least >= 1 << width_of(self.word) else None

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`."""
        return (self.word,)

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {self.name: 1}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return 0

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`."""
        return {self.name: (bits_to_codes(values[0]) >= self.at_least)[:, np.newaxis]}


@dataclass(frozen=True)
class Sum:
    """The number of set bits of a word, or the sum of the weights of its set bits, and a constant.

    Attributes:
        name: of the node and of the net it drives.
        word: the bits that are added, at least one.
        weights: of each bit, not 0; all of them 1 if left out.
        offset: is added to every sum.
        modulus_bits: if given, sums are taken modulo ``2**modulus_bits``, and have that many bits; if left
            out, they have as many bits as the largest needs, and none may be negative.
    """

    kind: ClassVar[str] = "sum"
    name: str
    word: Word
    weights: tuple[int, ...] = field(default=())
    offset: int = 0
    modulus_bits: int | None = None

    def __post_init__(self) -> None:
        if not self.weights:
            object.__setattr__(self, "weights", (1,) * width_of(self.word))
        lowest, highest = self._range
        fits = self.word and len(self.weights) == width_of(self.word) and all(self.weights)
        if not fits or max(highest, -lowest).bit_length() > MAX_NUMBER:
            raise ValueError(f"{self.name} adds {width_of(self.word)} bits with the weights {self.weights}")
        if self.modulus_bits is None and lowest < 0:
            raise ValueError(f"{self.name} adds the constant {self.offset}, so that sums may be negative")
        if self.modulus_bits is not None and not 1 <= self.modulus_bits <= MAX_NUMBER:
            raise ValueError(f"{self.name} adds modulo 2**{self.modulus_bits}")

    @property
    def _range(self) -> tuple[int, int]:
        """The lowest and the highest sum."""
        negative = sum(weight for weight in self.weights if weight < 0)
        return self.offset + negative, self.offset + sum(self.weights) - negative

    @property
    def width(self) -> int:
        """Bits of the sum."""
        return self._range[1].bit_length() if self.modulus_bits is None else self.modulus_bits

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`."""
        return (self.word,)

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {self.name: self.width}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return 0

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`."""
        total = values[0] @ np.array(self.weights, dtype=np.int64) + self.offset
        return {self.name: codes_to_bits(total & (1 << self.width) - 1, self.width)}


@dataclass(frozen=True)
class Match:
    """In how many places two words of equal width agree."""

    kind: ClassVar[str] = "match"
    name: str
    word: Word
    other: Word

    def __post_init__(self) -> None:
        if width_of(self.word) != width_of(self.other):
            raise ValueError(f"{self.name} compares {width_of(self.word)} with {width_of(self.other)} bits")

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`."""
        return (self.word, self.other)

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {self.name: width_of(self.word).bit_length()}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return 0

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`."""
        same = np.sum(values[0] == values[1], axis=1, dtype=np.int64)
        return {self.name: codes_to_bits(same, self.drives[self.name])}


@dataclass(frozen=True)
class ArgMax:
    """The index of the largest of several unsigned words.

    Attributes:
        name: of the node and of the net it drives: the index in binary.
        words: at least two, each of at most `MAX_NUMBER` bits.
        tie: which of equal words wins: the ``first`` or the ``last``.
    """

    kind: ClassVar[str] = "argmax"
    name: str
    words: tuple[Word, ...]
    tie: Literal["first", "last"] = "first"

    def __post_init__(self) -> None:
        if len(self.words) < 2 or self.tie not in ("first", "last"):
            raise ValueError(f"{self.name} cannot choose among {len(self.words)} words, ties: {self.tie}")
        if max(map(width_of, self.words)) > MAX_NUMBER:
            raise ValueError(f"{self.name} compares words of more than {MAX_NUMBER} bits")

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`."""
        return self.words

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {self.name: (len(self.words) - 1).bit_length()}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return 0

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`."""
        totals = np.stack([bits_to_codes(word) for word in values], axis=1)
        if self.tie == "first":
            winner = totals.argmax(axis=1)
        else:
            winner = len(values) - 1 - totals[:, ::-1].argmax(axis=1)
        return {self.name: codes_to_bits(winner, self.drives[self.name])}


@dataclass(frozen=True)
class Register:
    """A word delayed by flip-flops that start at 0.

    Attributes:
        name: of the node and of the net it drives.
        word: what is delayed.
        cycles: by how many clock cycles, 1 to `MAX_CYCLES`.
    """

    kind: ClassVar[str] = "register"
    name: str
    word: Word
    cycles: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.cycles <= MAX_CYCLES:
            raise ValueError(f"{self.name} delays by {self.cycles} cycles; it may be 1 to {MAX_CYCLES}")

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`."""
        return (self.word,)

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {self.name: width_of(self.word)}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return self.cycles

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`; the delay is stated by `latency`, the values are those of the same sample."""
        return {self.name: values[0]}


Leaf = Table | Threshold | Sum | Match | ArgMax | Register
"""A node that holds no circuit."""
