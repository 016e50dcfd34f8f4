"""Is a module a sum of tables? Proved by substitution, where a proof by SAT would take ages.

The claim is that a number of ``W`` bits equals, modulo ``2**W``, the sum of one table for each word that the
module reads, and a constant. The proof writes the number as a sum of signals with weights, at first its bits
with powers of two, and replaces signals by others as long as it can: where the weighted sum of some signals,
which are functions of the same few signals, is a weighted sum of these and a constant on all their values, it
takes its place. This is what the counters of an adder compute, in whatever order they add. What ends it are
signals that are functions of one word alone; their weighted sums are compared with the tables, code by code.

Every step is an equation that holds for all inputs and is checked on all values of what it reads. So nothing
is taken on trust of how the module was made, and a module for which the steps do not work out is not proved.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.signals import ZERO, Bit, Column, Signals

_MAX_LEAVES = 10
"""Signals that a step looks at together."""

_MAX_EXHAUSTIVE = 12
"""Input bits of a sum up to which it is evaluated on all inputs."""


@dataclass(frozen=True, eq=False)
class TableSum:
    """What a number has to be.

    Attributes:
        port: the output port that holds it.
        words: by number of a word, the table of what it adds, int64 ``[2**size]``.
        constant: is added to that.
    """

    port: str
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


def is_sum_of_tables(signals: Signals, sums: Sums) -> bool:
    """Whether all outputs of a module are proved to be the sums claimed, on all words that occur."""
    owners = {bit: place // sums.size for place, bit in enumerate(signals.inputs[sums.port])}
    words: dict[Bit, frozenset[int]] = {bit: frozenset({owner}) for bit, owner in owners.items()}
    for bit, gate in signals.gates.items():
        words[bit] = frozenset().union(*(words.get(x, frozenset()) for x in gate.reads))
    return all(_Sum(signals, sums, total, words).is_proved() for total in sums.totals)


def answers(signals: Signals, inputs: Mapping[str, Bits]) -> dict[str, Bits]:
    """What a module answers, as it was read.

    Args:
        signals: the module.
        inputs: values of its input ports, bool ``[samples, width]``.

    Returns:
        Values of its output ports.
    """
    known = {
        bit: column
        for port, bits in inputs.items()
        for bit, column in zip(signals.inputs[port], bits.T.astype(np.uint8), strict=True)
    }
    return {
        port: np.stack(signals.evaluate(bits, known), axis=1).astype(np.bool_)
        for port, bits in signals.outputs.items()
    }


class _Sum:
    """The proof of one number.

    Attributes:
        weights: signals that are left, by bit, and what each weighs.
        constant: what is added to them.
    """

    def __init__(
        self, signals: Signals, sums: Sums, total: TableSum, words: Mapping[Bit, frozenset[int]]
    ) -> None:
        self.signals, self.sums, self.total, self.words = signals, sums, total, words
        self.bits = signals.outputs[total.port]
        self.weights: Counter[Bit] = Counter()
        self.constant = 0

    def is_proved(self) -> bool:
        for place, bit in enumerate(self.bits):
            self._add(bit, 1 << place)
        read = sorted(set(self.total.words).union(*(self.words[bit] for bit in self.weights)))
        if len(read) * self.sums.size <= _MAX_EXHAUSTIVE:
            groups = [read] if read else []
        elif self._substitute():
            groups = [[word] for word in read]
        else:
            return False
        more = [self._beyond_tables(group) for group in groups]
        if None in more:
            return False
        left = self.constant + sum(each for each in more if each is not None) - self.total.constant
        return left % (1 << len(self.bits)) == 0

    def _add(self, bit: Bit, weight: int) -> None:
        if self.words.get(bit):
            self.weights[bit] += weight
        else:
            (value,) = self.signals.evaluate([bit], {ZERO: np.zeros(1, np.uint8)})
            self.constant += int(value[0]) * weight

    def _substitute(self) -> bool:
        """Replace all signals that are functions of several words; whether that succeeds."""
        leaves = {bit: set(read) for bit, read in self._cone().items()}
        while leaves:
            read = set().union(*leaves.values())
            ready = [bit for bit in leaves if bit not in read]
            for bit in sorted(ready, key=lambda x: -len(leaves[x])):
                group = [x for x in ready if leaves[x] <= leaves[bit]]
                if any(
                    self._replace([*group, *few], sorted(leaves[bit])) for few in self._few(leaves[bit], read)
                ):
                    break
            else:
                return False
            for replaced in group:
                del leaves[replaced]
        return True

    def _few(self, leaves: set[Bit], read: set[Bit]) -> list[list[Bit]]:
        """Signals of one word that a counter may drive too: those of its bits that read no other word."""
        found = [
            bit
            for bit in self.weights
            if bit in self.signals.leaves
            and len(self.words[bit]) == 1
            and bit not in read
            and leaves >= set(self.signals.leaves[bit])
        ]
        return [[], found, *([bit] for bit in found)]

    def _cone(self) -> dict[Bit, tuple[Bit, ...]]:
        """Named signals on the way to the number that are functions of several words, and what they read."""
        found: dict[Bit, tuple[Bit, ...]] = {}
        stack = list(self.weights)
        while stack:
            bit = stack.pop()
            if bit not in found and len(self.words[bit]) > 1:
                found[bit] = tuple(x for x in self.signals.leaves[bit] if self.words.get(x))
                stack += found[bit]
        return found

    def _replace(self, group: Sequence[Bit], leaves: Sequence[Bit]) -> bool:
        """Replace signals by those they read, if their weighted sum is one of these."""
        if len(leaves) > _MAX_LEAVES:
            return False
        codes = np.arange(1 << len(leaves))
        known = {leaf: (codes >> place & 1).astype(np.uint8) for place, leaf in enumerate(leaves)}
        values = self._weighted(group, known)
        steps = [int(values[1 << place] - values[0]) for place in range(len(leaves))]
        linear = values[0] + sum(
            step * known[leaf].astype(np.int64) for step, leaf in zip(steps, leaves, strict=True)
        )
        if ((values - linear) % (1 << len(self.bits))).any():
            return False
        for bit in group:
            del self.weights[bit]
        self.constant += int(values[0])
        for step, leaf in zip(steps, leaves, strict=True):
            self._add(leaf, step)
        return True

    def _weighted(self, bits: Sequence[Bit], known: Mapping[Bit, Column]) -> NDArray[np.int64]:
        """The weighted sum of signals for values of what they read, weights modulo the number's width."""
        size = 1 << len(self.bits)
        columns = self.signals.evaluate(bits, known)
        total = np.zeros(len(next(iter(known.values()))), dtype=np.int64)
        for bit, column in zip(bits, columns, strict=True):
            total += self.weights[bit] % size * column.astype(np.int64)
        return total

    def _beyond_tables(self, words: Sequence[int]) -> int | None:
        """By how much the signals that read these words exceed the tables; None if not always by as much."""
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
        read = [bit for bit in self.weights if self.words[bit] <= set(words)]
        more = (self._weighted(read, known) - wanted)[occurs] % (1 << len(self.bits))
        return int(more[0]) if (more == more[0]).all() else None
