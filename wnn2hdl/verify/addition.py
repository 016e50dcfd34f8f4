"""Is a module a sum of tables? Proved by substitution, where a proof by SAT would take ages.

The claim is that a number of ``W`` bits equals, modulo ``2**W``, the sum of one table for each word that the
module reads, and a constant; a sum of weighted bits is one whose words are bits. The proof writes the number
as a sum of signals with weights, at first its bits with powers of two, and replaces signals by others as long
as it can: where the weighted sum of some signals, which are functions of the same few signals, is a weighted
sum of these and a constant on all their values, it takes its place. This is what the counters of an adder
compute, in whatever order they add: of a full adder, ``s + 2 * carry = a + b + c``. What ends it are signals
that are functions of one word alone; their weighted sums are compared with the tables, code by code.

Every step is an equation that holds for all inputs and is checked on all values of what it reads. So nothing
is taken on trust of how the module was made, and a module for which the steps do not work out is not proved.
That signals have names in the text only says where to look. In a pipeline all ways from inputs to the number
have to pass as many registers as it has cycles.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.verify.signals import ZERO, Bit, Column, Signals

_MAX_LEAVES = 10
"""Signals that a step looks at together."""

_MAX_EXHAUSTIVE = 12
"""Input bits of a sum up to which it is evaluated on all inputs."""


_MAX_BITS = 40
"""Bits of a number: sums of so many signals with weights of so many bits fit in 64."""

_SAMPLES = 4096


@dataclass(frozen=True, eq=False)
class TableSum:
    """What a number has to be.

    Attributes:
        port: the output port that holds it.
        bits: of the port.
        words: by number of a word, the table of what it adds, int64 ``[2**size]``.
        constant: is added to that.
    """

    port: str
    bits: int
    words: Mapping[int, NDArray[np.int64]]
    constant: int


@dataclass(frozen=True, eq=False)
class Sums:
    """What all output ports of a module have to be.

    Attributes:
        port: the input port that holds the words side by side, word 0 in the lowest bits.
        size: bits of a word.
        occurring: for each word the codes that matter, bool ``[2**size]``.
        totals: one for each output port.
    """

    port: str
    size: int
    occurring: Sequence[NDArray[np.bool_]]
    totals: tuple[TableSum, ...]

    @classmethod
    def of_bits(cls, weights: Sequence[int], offset: int) -> Self:
        """``total``, the weights of those of the ``bits`` that are set and an offset, none below 0."""
        words = {place: np.array([0, weight]) for place, weight in enumerate(weights)}
        total = TableSum("total", (sum(weights) + offset).bit_length(), words, offset)
        return cls("bits", 1, [np.ones(2, dtype=np.bool_)] * len(weights), (total,))

    def fit(self, signals: Signals) -> bool:
        """Whether a module has these ports."""
        outputs = {port: len(bits) for port, bits in signals.outputs.items()}
        inputs = {port: len(bits) for port, bits in signals.inputs.items()}
        return inputs == {self.port: self.size * len(self.occurring)} and outputs == {
            total.port: total.bits for total in self.totals
        }


def is_sum_of_tables(signals: Signals, sums: Sums, latency: int = 0) -> bool:
    """Whether all outputs of a module are proved to be the sums claimed, on all words that occur.

    Args:
        signals: the module.
        sums: the claim.
        latency: cycles that the outputs are later than the inputs.
    """
    if not sums.fit(signals) or not signals.latencies <= {latency}:
        return False
    words = {bit: 1 << place // sums.size for place, bit in enumerate(signals.inputs[sums.port])}
    for bit, gate in signals.gates.items():
        read = 0
        for each in gate.reads:
            read |= words.get(each, 0)
        words[bit] = read
    return all(
        total.bits <= _MAX_BITS and _Sum(signals, sums, total, words).is_proved() for total in sums.totals
    )


def is_wrong_on_samples(signals: Signals, sums: Sums) -> bool:
    """Whether outputs of a module are not the sums claimed on some of a few thousand random words that occur.

    What a pipeline answers is what it answers while they stand still. Ports that do not fit show nothing.
    """
    if not sums.fit(signals):
        return False
    rng = np.random.default_rng(0)
    words = [rng.choice(np.flatnonzero(codes), _SAMPLES) for codes in sums.occurring]
    inputs = {sums.port: np.concatenate([codes_to_bits(codes, sums.size) for codes in words], axis=1)}
    found = signals.answers(inputs)
    for total in sums.totals:
        value = np.full(_SAMPLES, total.constant)
        for word, table in total.words.items():
            value += table[words[word]]
        if not np.array_equal(found[total.port], codes_to_bits(value % (1 << total.bits), total.bits)):
            return True
    return False


class _Sum:
    """The proof of one number.

    Attributes:
        words: for each signal the words that it is a function of, bit by bit of a number.
        weights: signals that are left, by bit, and what each weighs.
        constant: what is added to them.
    """

    def __init__(self, signals: Signals, sums: Sums, total: TableSum, words: Mapping[Bit, int]) -> None:
        self.signals, self.sums, self.total, self.words = signals, sums, total, words
        self.weights: Counter[Bit] = Counter()
        self.constant = 0
        self._modulus = 1 << total.bits

    def is_proved(self) -> bool:
        for place, bit in enumerate(self.signals.outputs[self.total.port]):
            self._add(bit, 1 << place)
        mask = 0
        for bit in self.weights:
            mask |= self.words[bit]
        read = sorted({*self.total.words, *(word for word in range(mask.bit_length()) if mask >> word & 1)})
        if len(read) * self.sums.size <= _MAX_EXHAUSTIVE:
            groups = [(read, list(self.weights))] if read else []
        elif self._substitute():
            own: defaultdict[int, list[Bit]] = defaultdict(list)
            for bit in self.weights:
                own[self.words[bit]].append(bit)
            groups = [([word], own[1 << word]) for word in read]
        else:
            return False
        more = [self._beyond_tables(*group) for group in groups]
        if None in more:
            return False
        left = self.constant + sum(each for each in more if each is not None) - self.total.constant
        return left % self._modulus == 0

    def _add(self, bit: Bit, weight: int) -> None:
        if self.words.get(bit):
            self.weights[bit] += weight
        else:
            (value,) = self.signals.evaluate([bit], {ZERO: np.zeros(1, np.uint8)})
            self.constant += int(value[0]) * weight

    def _substitute(self) -> bool:
        """Replace all signals that are functions of several words; whether that succeeds."""
        leaves = {bit: set(read) for bit, read in self._cone().items()}
        readers = Counter(leaf for read in leaves.values() for leaf in read)
        ready = [bit for bit in leaves if not readers[bit]]
        while ready:
            for bit in sorted(ready, key=lambda x: -len(leaves[x])):
                group = [x for x in ready if leaves[x] <= leaves[bit]]
                if self._replace(group, leaves[bit]) or any(
                    self._replace([*group, *few], leaves[bit]) for few in self._few(leaves[bit], readers)
                ):
                    break
            else:
                return False
            for replaced in group:
                ready.remove(replaced)
                for leaf in leaves[replaced]:
                    readers[leaf] -= 1
                    if not readers[leaf] and leaf in leaves:
                        ready.append(leaf)
        return True

    def _few(self, leaves: set[Bit], readers: Mapping[Bit, int]) -> list[list[Bit]]:
        """Signals of one word that a counter may drive too: those of its bits that read no other word."""
        found = [
            bit
            for bit in self.weights
            if bit in self.signals.leaves
            and self.words[bit].bit_count() == 1
            and not readers[bit]
            and leaves >= set(self.signals.leaves[bit])
        ]
        return [found, *([bit] for bit in found)]

    def _cone(self) -> dict[Bit, tuple[Bit, ...]]:
        """Named signals on the way to the number that are functions of several words, and what they read."""
        found: dict[Bit, tuple[Bit, ...]] = {}
        stack = list(self.weights)
        while stack:
            bit = stack.pop()
            if bit not in found and self.words[bit].bit_count() > 1:
                found[bit] = tuple(x for x in self.signals.leaves[bit] if self.words.get(x))
                stack += found[bit]
        return found

    def _replace(self, group: Sequence[Bit], read: Iterable[Bit]) -> bool:
        """Replace signals by those they read, if their weighted sum is one of these."""
        leaves = sorted(read)
        if len(leaves) > _MAX_LEAVES:
            return False
        codes = np.arange(1 << len(leaves))
        known = {leaf: (codes >> place & 1).astype(np.uint8) for place, leaf in enumerate(leaves)}
        values = self._weighted(group, known)
        steps = [int(values[1 << place] - values[0]) for place in range(len(leaves))]
        linear = values[0] + sum(
            step * known[leaf].astype(np.int64) for step, leaf in zip(steps, leaves, strict=True)
        )
        if ((values - linear) % self._modulus).any():
            return False
        for bit in group:
            del self.weights[bit]
        self.constant += int(values[0])
        for step, leaf in zip(steps, leaves, strict=True):
            self._add(leaf, step)
        return True

    def _weighted(self, bits: Sequence[Bit], known: Mapping[Bit, Column]) -> NDArray[np.int64]:
        """The weighted sum of signals for values of what they read, weights modulo the number's width."""
        columns = self.signals.evaluate(bits, known)
        total = np.zeros(len(next(iter(known.values()))), dtype=np.int64)
        for bit, column in zip(bits, columns, strict=True):
            total += self.weights[bit] % self._modulus * column.astype(np.int64)
        return total

    def _beyond_tables(self, words: Sequence[int], read: Sequence[Bit]) -> int | None:
        """By how much signals that read these words exceed the tables; None if not always by as much."""
        sums, size = self.sums, self.sums.size
        codes = np.arange(1 << size * len(words))
        occurs = np.ones(len(codes), dtype=np.bool_)
        known: dict[Bit, Column] = {}
        wanted = np.zeros(len(codes), dtype=np.int64)
        for place, word in enumerate(words):
            own = codes >> place * size & (1 << size) - 1
            occurs &= sums.occurring[word][own]
            if word in self.total.words:
                wanted += self.total.words[word][own]
            bits = self.signals.inputs[sums.port][word * size : (word + 1) * size]
            known |= {bit: (own >> position & 1).astype(np.uint8) for position, bit in enumerate(bits)}
        more = (self._weighted(read, known) - wanted)[occurs] % self._modulus
        return int(more[0]) if (more == more[0]).all() else None
