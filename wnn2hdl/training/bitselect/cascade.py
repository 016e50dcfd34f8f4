"""Cascades of two and three LUTs: one or two inner LUTs read six bits, the last reads them and other bits.

Two LUTs are ``f(g(A), B)`` with five bits in B, three are ``f(g(A), h(A), B)`` with four. So each value of A
gets one of two or four labels. Given the labels the best f is known, and given f the best labels: both are
improved in turn. Which bits A and B hold is improved by exchanges.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS, bits_to_codes, codes_to_bits
from wnn2hdl.training.bitselect.single import best_subset

SHORTLIST = 15
"""Bits that take part in the search for a cascade: the best ones together, by `best_subset`."""

STARTS = 6
"""Random choices of bits from which exchanges start."""

GUESSES = 7
"""Random labellings from which each alternation starts, beside one that ranks the values of A."""


@dataclass(frozen=True, eq=False)
class Table:
    """A LUT of a cascade.

    Attributes:
        inputs: bit positions of the code; position ``width + t`` is the output of table ``t``. The first is
            the least significant bit of the address.
        contents: bool ``[2**len(inputs)]``.
    """

    inputs: tuple[int, ...]
    contents: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Cascade:
    """Tables in the order of evaluation, over codes of ``width`` bits; the last is the answer."""

    width: int
    tables: tuple[Table, ...]

    @property
    def bits(self) -> tuple[int, ...]:
        """The positions of code bits that are read, ascending."""
        return tuple(sorted({x for table in self.tables for x in table.inputs if x < self.width}))

    def evaluate(self, codes: NDArray[np.int64]) -> NDArray[np.bool_]:
        """The answer for codes of shape ``[m]``: bool ``[m]``."""
        signals = codes_to_bits(codes, self.width)
        for table in self.tables:
            output = table.contents[bits_to_codes(signals[:, table.inputs])]
            signals = np.concatenate([signals, output[:, np.newaxis]], axis=1)
        return signals[:, -1]


@dataclass(frozen=True, eq=False)
class _Split:
    """The best labels and f found for one choice of A and B.

    Attributes:
        score: mass that is right less mass that is wrong.
        a: the bits of A, ascending.
        b: the bits of B, ascending.
        label: int64 ``[2**len(a)]``.
        f: bool ``[labels, 2**len(b)]``.
    """

    score: float
    a: tuple[int, ...]
    b: tuple[int, ...]
    label: NDArray[np.int64]
    f: NDArray[np.bool_]


def find_cascade(
    mass: NDArray[np.int64], luts: int, seed: int, progress: Callable[[int, int], None] | None = None
) -> Cascade:
    """The cascade of ``luts`` LUTs with the most mass right, as far as the search finds it.

    Args:
        mass: signed mass, int64 ``[2**width]``; sums of magnitudes are below 2**53.
        luts: 1, 2 or 3. One is exact.
        seed: decides the starts of the search.
        progress: called with (starts done, starts in all).
    """
    width = len(mass).bit_length() - 1
    if luts == 1:
        only = best_subset(mass, min(LUT_INPUTS, width))
        return Cascade(width, (Table(only.bits, only.mass > 0),))
    short = best_subset(mass, min(SHORTLIST, width))
    wires = luts - 1
    search = _Search(short.mass, 1 << wires, LUT_INPUTS - wires, np.random.default_rng(seed))
    best = search.climb()
    for start in range(1, STARTS):
        if progress:
            progress(start, STARTS)
        best = max(best, search.climb(), key=lambda split: split.score)
    if progress:
        progress(STARTS, STARTS)
    a, b = (tuple(short.bits[x] for x in positions) for positions in (best.a, best.b))
    inner = tuple(Table(a, (best.label >> wire & 1).astype(np.bool_)) for wire in range(wires))
    last = Table((*b, *range(width, width + wires)), best.f.ravel())
    return Cascade(width, (*inner, last))


class _Search:
    """Exchanges of bits between A, B and the rest; what was found for a choice is kept."""

    def __init__(self, mass: NDArray[np.int64], labels: int, free: int, rng: np.random.Generator) -> None:
        self.width = len(mass).bit_length() - 1
        # One axis per bit, the highest first. The numbers are whole and below 2**53, so floating-point sums
        # are exact, and BLAS does the work.
        self.mass = mass.astype(np.float64).reshape((2,) * self.width)
        self.labels = labels
        self.free = free
        self.rng = rng
        self.found: dict[tuple[tuple[int, ...], tuple[int, ...]], _Split] = {}

    def climb(self) -> _Split:
        """Start anywhere and take the first exchange that improves, until none does."""
        order = tuple(self.rng.permutation(self.width).tolist())
        best = self.split(order[:LUT_INPUTS], order[LUT_INPUTS : LUT_INPUTS + self.free])
        while True:
            moves = self._moves(best.a, best.b)
            others = (self.split(*moves[x]) for x in self.rng.permutation(len(moves)))
            improved = next((split for split in others if split.score > best.score), None)
            if improved is None:
                return best
            best = improved

    def _moves(self, a: tuple[int, ...], b: tuple[int, ...]) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
        idle = [x for x in range(self.width) if x not in a and x not in b]
        moves = [(_put(a, i, x), b) for i in range(len(a)) for x in idle]
        moves += [(a, _put(b, j, x)) for j in range(len(b)) for x in idle]
        moves += [(_put(a, i, b[j]), _put(b, j, a[i])) for i in range(len(a)) for j in range(len(b))]
        return moves

    def split(self, a: tuple[int, ...], b: tuple[int, ...]) -> _Split:
        key = tuple(sorted(a)), tuple(sorted(b))
        if key not in self.found:
            self.found[key] = self._alternate(*key)
        return self.found[key]

    def _alternate(self, a: tuple[int, ...], b: tuple[int, ...]) -> _Split:
        rows, columns = 1 << len(a), 1 << len(b)
        chart = self._chart(a, b).reshape(columns, rows)
        lean = chart.sum(axis=0) / np.maximum(np.abs(chart).sum(axis=0), 1)
        ranked = lean.argsort(kind="stable").argsort(kind="stable") * self.labels // rows
        guesses = self.rng.integers(self.labels, size=(GUESSES, rows))
        label, last = np.concatenate([ranked[np.newaxis], guesses]), -1.0
        best, f = label[0], np.zeros((self.labels, columns), dtype=np.bool_)
        while True:
            member = label[:, np.newaxis] == np.arange(self.labels)[:, np.newaxis]
            sums = member.astype(np.float64) @ chart.T  # [guess, label, column]
            scores = np.abs(sums).sum(axis=(1, 2))
            top = int(scores.argmax())
            if scores[top] <= last:
                return _Split(last, a, b, best, f)
            last, best, f = float(scores[top]), label[top], sums[top] > 0
            label = (np.sign(sums) @ chart).argmax(axis=1)

    def _chart(self, a: tuple[int, ...], b: tuple[int, ...]) -> NDArray[np.float64]:
        """The mass by B and A, the idle bits summed over; one axis per bit, from the highest of B down."""
        kept = sorted(a + b, reverse=True)
        idle = tuple(self.width - 1 - x for x in range(self.width) if x not in kept)
        order = [kept.index(x) for x in (*reversed(b), *reversed(a))]
        return np.asarray(self.mass.sum(axis=idle).transpose(order))


def _put(values: tuple[int, ...], position: int, value: int) -> tuple[int, ...]:
    return (*values[:position], value, *values[position + 1 :])
