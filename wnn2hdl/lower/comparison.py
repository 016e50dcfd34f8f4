"""Searches in look-up tables: comparisons with constants that earlier answers select.

A comparison is a chain of tables from the low end. None of them reads more than it has to: what the answers
so far rule out is a don't-care, so that often a few bits of the word tell all that its higher bits would.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS, TruthTable
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.packing import Gate, pairs
from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.search import Shape
from wnn2hdl.minimise.support import members, minimum_supports, restrict

_MAX_VARIABLES = 11
"""Signals among which the ones that a table reads are chosen; time doubles with each."""

Flags = NDArray[np.bool_]


@dataclass
class Tables:
    """Tables under construction, each of at most `LUT_INPUTS` inputs.

    Attributes:
        prefix: what the names of the tables begin with.
        nodes: the tables.
    """

    prefix: str
    nodes: list[Table] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._known: dict[tuple[tuple[Slice, ...], bytes], Slice] = {}

    def add(self, signals: Sequence[Slice], on: Flags, off: Flags) -> Slice:
        """A signal that is set on all codes of ``on`` and on none of ``off``, both bool ``[2**signals]``.

        It reads as few of the signals as can be.
        """
        return self.add_on(minimum_supports(on, off)[0], signals, on)

    def add_on(self, support: int, signals: Sequence[Slice], on: Flags) -> Slice:
        """As `add`, for a known support: the mask of the signals that are read.

        Equal tables become one, and none is needed for a wire.
        """
        values = restrict(on, support)
        read = tuple(signals[place] for place in members(support)) or tuple(signals[:1])
        if not support:
            values = np.repeat(values, 2)
        if values.tolist() == [False, True]:
            return read[0]
        key = (read, values.tobytes())
        if key not in self._known:
            name = f"{self.prefix}_{len(self.nodes)}"
            names = tuple(f"i{place}" for place in range(len(read)))
            self.nodes.append(Table(name, read, TruthTable.exact(names, ("o",), values[:, np.newaxis])))
            self._known[key] = Slice(name)
        return self._known[key]

    def luts(self) -> int:
        """LUTs that the tables take, two in a LUT6_2 where they can be."""
        gates = [Gate(frozenset(node.word), (Slice(node.name),), True) for node in self.nodes]
        return len(gates) - len(pairs(gates))


@dataclass(frozen=True)
class Number:
    """The word that is compared.

    Attributes:
        word: its bits, the least significant first.
        signed: whether it is in two's complement; its sign bit is then inverted, so that it is compared as
            an unsigned number that counts from the lowest one.
    """

    word: tuple[Slice, ...]
    signed: bool

    @property
    def width(self) -> int:
        """Bits of the word."""
        return len(self.word)


@dataclass(frozen=True)
class _Window:
    """A signal that says whether the highest ``bits`` bits of the word are among ``prefixes``."""

    signal: Slice
    bits: int
    prefixes: tuple[int, ...]


class Search:
    """A search in tables.

    Args:
        number: what is compared.
        shape: with which constants.
        prefix: what the names of the tables begin with.
    """

    def __init__(self, number: Number, shape: Shape, prefix: str) -> None:
        self.number, self.shape = number, shape
        self.width = number.width
        self.tables = Tables(prefix)
        self.window: _Window | None = None
        self.answers: list[Slice] = []

    def add_window(self, bits: int, prefixes: tuple[int, ...]) -> None:
        """Make a signal that says whether the highest bits are among the prefixes, for comparisons to read.

        Args:
            bits: how many bits, at most six.
            prefixes: their values.
        """
        on = np.isin(np.arange(1 << bits) ^ self._sign(bits), prefixes)
        signal = self.tables.add(self.number.word[-bits:], on, ~on)
        self.window = _Window(signal, bits, prefixes)

    def build(self, levels: tuple[int, ...]) -> list[Slice]:
        """For each of the levels that the shape is for, a bit: whether the number is at least that."""
        for intervals, constants in zip(self.shape.intervals, self.shape.constants, strict=True):
            self.answers.append(self._compared(intervals, constants))
        starts = np.array([low for low, _ in self.shape.leaves])
        return [self.tables.add(self.answers, starts >= level, starts < level) for level in levels]

    def _sign(self, bits: int) -> int:
        """What to invert in the highest ``bits`` bits of the word."""
        return 1 << (bits - 1) if self.number.signed else 0

    def _compared(self, intervals: tuple[tuple[int, int], ...], constants: tuple[int | None, ...]) -> Slice:
        """One level's answer: tables that each take as many bits of the word as they can, from the top."""
        alive = [code for code, constant in enumerate(constants) if constant is not None]
        cases = _Cases(
            np.array(alive),
            np.array([intervals[code][0] for code in alive]),
            np.array([intervals[code][1] for code in alive]),
            np.array([constants[code] for code in alive]),
        )
        end = int(np.bitwise_or.reduce(cases.constants))
        end = (end & -end).bit_length() - 1
        chunks: list[_Chunk] = []
        top = self.width
        while top > end:
            chunks.append(self._widest(cases, top, end))
            top = chunks[-1].low
        carry: Slice | None = None
        for chunk in reversed(chunks):
            signals = [*chunk.signals, carry] if carry is not None else chunk.signals
            carry = self.tables.add_on(chunk.support, signals, chunk.on)
        assert carry is not None, "a constant above 0 has a bit to look at"
        return carry

    def _widest(self, cases: "_Cases", top: int, end: int) -> "_Chunk":
        """The table that looks at most bits below ``top``, but not below ``end``."""
        # With four answers and the carry, a table still has room for one bit.
        best = self._chunk(cases, max(top - LUT_INPUTS + len(self.answers) + 1, end), top, end)
        for low in range(best.low - 1, end - 1, -1):
            if top - low + len(self.answers) + 2 > _MAX_VARIABLES:
                break
            chunk = self._chunk(cases, low, top, end)
            if chunk.fits():
                best = chunk
            elif not (self.window and self.width - low < self.window.bits <= top):
                break
        return best

    def _chunk(self, cases: "_Cases", low: int, top: int, end: int) -> "_Chunk":
        """The comparison of the bits from ``low`` to below ``top``, given the answer for those below."""
        size = top - low
        signals = [*self.number.word[low:top], *self.answers]
        window = self.window if self.window and top == self.width and size >= self.window.bits else None
        if window is not None:
            signals.append(window.signal)
        has_carry = low > end
        digits = np.arange(1 << size)
        seen = digits ^ self._sign(size) if top == self.width else digits
        if window is not None:
            within = np.isin(digits >> (size - window.bits), window.prefixes)
            seen = seen | within.astype(np.int64) << (size + len(self.answers))
        places = seen | cases.codes[:, np.newaxis] << size
        starts = (cases.constants >> top << top)[:, np.newaxis] + (digits << low)
        possible = (starts < cases.ends[:, np.newaxis]) & (starts + (1 << low) > cases.starts[:, np.newaxis])
        own = (cases.constants >> low & ((1 << size) - 1))[:, np.newaxis]
        on, off = (np.zeros(1 << len(signals) + has_carry, dtype=np.bool_) for _ in range(2))
        for carry in (0, 1) if has_carry else (1,):
            reached = (digits > own) | (digits == own) & (carry == 1)
            shifted = places | (carry << len(signals) if has_carry else 0)
            on[shifted[possible & reached]] = True
            off[shifted[possible & ~reached]] = True
        return _Chunk(low, signals, on, off)


@dataclass(frozen=True, eq=False)
class _Cases:
    """The codes of the answers so far after which a comparison matters, all int64 ``[cases]``.

    Attributes:
        codes: the codes.
        starts: the lowest number that the word can be.
        ends: the lowest number above all that it can be.
        constants: what the word is compared with.
    """

    codes: NDArray[np.int64]
    starts: NDArray[np.int64]
    ends: NDArray[np.int64]
    constants: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class _Chunk:
    """A table of a comparison.

    Attributes:
        low: the lowest bit of the word that it looks at.
        signals: what it may read besides the answer of the table below, which comes last.
        on: on which codes it is set, bool ``[2**n]`` for ``n`` signals.
        off: on which codes it is not.
    """

    low: int
    signals: list[Slice]
    on: Flags
    off: Flags

    @cached_property
    def support(self) -> int:
        """A smallest set of signals that it can do with, as a mask."""
        return minimum_supports(self.on, self.off)[0]

    def fits(self) -> bool:
        """Whether it can be one LUT."""
        return self.support.bit_count() <= LUT_INPUTS
