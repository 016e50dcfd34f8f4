"""Counts of bits in the squares around a pixel: down the columns, then along the line.

What comes is the columns of a scan, one pixel a beat. The ones in a column are counted; along the line a sum
for each square gains the column that enters the square and loses the one that leaves it. Beyond the ends of
a line its first and its last column are repeated: at the beginning a sum starts as if all its columns were
the first, which is a shift and a subtraction since sides are powers of two less one; at the end the scan
waits for as many cycles as a square reaches to the right.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from amaranth.hdl import Cat, Module, Mux, Signal, Value, signed

from hdl_templates.compressor import add_columns
from hdl_templates.hierarchy import Part
from hdl_templates.scan import Columns


@dataclass(frozen=True)
class Counting:
    """How a pixel is classified by counts in the squares around it.

    Attributes:
        own: bits of a pixel's value of which the pixel's own is read.
        squares: for each count which bit of a value is counted, and the rows and columns of the square, a
            power of two less one.
        parts: the circuit that classifies, once for the one pixel of a beat: one input, the own bits and
            above them the counts, each of as many bits as all pixels of its square take, and one output.
    """

    own: Sequence[int]
    squares: Sequence[tuple[int, int]]
    parts: Sequence[Part]

    @property
    def sizes(self) -> list[int]:
        """Rows and columns of each square."""
        return [size for _, size in self.squares]

    @property
    def size(self) -> int:
        """Rows and columns of the largest square."""
        return max(self.sizes)

    def kept(self, bits: int) -> list[int]:
        """For each of the bits of a value how many lines above the newest one are kept, at least one."""
        reach = self.size // 2
        lines = {(bit, reach) for bit in self.own} | {(bit, reach + size // 2) for bit, size in self.squares}
        return [max((line for seen, line in lines if seen == bit), default=1) for bit in range(bits)]


@dataclass(frozen=True)
class Counted:
    """What was counted for a pixel, in registers.

    Attributes:
        valid: whether there is a pixel.
        start: whether it is the first of a frame.
        last: whether it is the last of a line.
        final: whether its line is the last of its frame.
        own: the pixel's own bits.
        counts: for each square how many of its pixels have the bit set.
    """

    valid: Signal
    start: Signal
    last: Signal
    final: Signal
    own: Signal
    counts: Sequence[Signal]


def count_around(
    m: Module,
    name: str,
    columns: Columns,
    counting: Counting,
    *,
    advances: Signal,
    moves: Value,
    platform: object,
) -> Counted:
    """Count in squares.

    Args:
        m: the module under construction.
        name: what the names of its signals begin with.
        columns: the slots that come, of one pixel each, with the lines that `Counting.kept` says.
        counting: what is counted.
        advances: driven here: whether the scan moves on.
        moves: whether what leaves can be taken; if not, all of it stands still.
        platform: the platform of ``m``.
    """
    reach, lines = counting.size // 2, columns.bits[0]

    def register(what: str, bits: int = 1, *, reset_less: bool = True) -> Signal:
        return Signal(bits, name=f"{name}{what}", reset_less=reset_less)

    def delayed(what: str, value: Value, steps: int) -> Value:
        """The value so many columns before."""
        for step in range(steps):
            later = register(f"{what}_{step}", len(value))
            with m.If(takes):
                m.d.sync += later.eq(value)
            value = later
        return value

    # The newest column, and how often it was repeated behind the end of the line.
    valid = register("newest_valid", reset_less=False)
    first, last, start, final = (register(f"newest_{what}") for what in ("first", "last", "start", "final"))
    own = [register(f"newest_own_{bit}") for bit in counting.own]
    repeated = Signal(range(reach + 1), name=f"{name}columns_repeated", reset_less=True)
    holds, takes = Signal(name=f"{name}holds"), Signal(name=f"{name}takes")
    m.d.comb += [
        holds.eq(valid & last & (repeated != reach)),
        advances.eq(moves & ~holds),
        takes.eq(moves & valid),
    ]
    with m.If(moves):
        m.d.sync += first.eq(columns.first & ~holds)
    with m.If(moves & holds):
        m.d.sync += repeated.eq(repeated + 1)
    with m.If(advances):
        m.d.sync += [
            repeated.eq(0),
            valid.eq(columns.whole),
            last.eq(columns.last),
            start.eq(columns.start),
            final.eq(columns.final),
            *(bit.eq(lines[place][reach]) for bit, place in zip(own, counting.own, strict=True)),
        ]

    # How many columns of the line came before it, up to as many as the largest square has.
    before = register("before", counting.size.bit_length())
    begins, emits = register("begins"), register("emits")
    starts, ends, closes = register("starts"), register("ends"), register("closes")
    with m.If(takes):
        m.d.sync += [
            before.eq(Mux(first, 1, before + ~before.all())),
            begins.eq(Mux(first, start, begins)),
            emits.eq(~first & (before >= reach)),
            starts.eq(begins & (before == reach)),
            ends.eq(last & (repeated == reach)),
            closes.eq(final),
        ]
    changed, restarts = register("changed", reset_less=False), register("restarts")
    counted = Counted(
        register("counted_valid", reset_less=False),
        register("counted_start"),
        register("counted_last"),
        register("counted_final"),
        register("counted_own", len(own)),
        [register(f"counted_{place}", (size**2).bit_length()) for place, size in enumerate(counting.sizes)],
    )
    middle = register("changed_own", len(own))
    with m.If(takes):
        m.d.sync += [restarts.eq(first), middle.eq(delayed("own", Cat(*own), reach))]
    with m.If(moves):
        m.d.sync += [
            changed.eq(valid),
            counted.valid.eq(changed & emits),
            counted.start.eq(starts),
            counted.last.eq(ends),
            counted.final.eq(closes),
            counted.own.eq(middle),
        ]

    for place, (bit, size) in enumerate(counting.squares):
        half = size // 2
        column = {0: list(lines[bit][reach - half : reach + half + 1])}
        bits = size.bit_length()
        ones = register(f"newest_ones_{place}", bits)
        count = add_columns(m, column, bits, name=f"{name}ones_{place}", platform=platform)
        with m.If(advances):
            m.d.sync += ones.eq(Cat(*count))
        # Where the square lies beyond the beginning of the line, the first column is repeated. Of what is
        # added one operand is always a register: a carry chain takes the other with all that selects it.
        of_first = register(f"first_ones_{place}", bits)
        entering = delayed(f"entering_{place}", ones, reach - half)
        leaving = delayed(f"leaving_{place}", entering, size)
        gained: Value = ones
        if half < reach:
            gained = Mux(first, ones, Mux(before >= reach - half, entering, of_first))
        lost = Mux(before >= reach + half + 1, leaving, of_first)
        change = Signal(signed(bits + 1), name=f"{name}change_{place}", reset_less=True)
        with m.If(takes):
            m.d.sync += change.eq(gained - Mux(first, ones << 1, lost))
        with m.If(takes & first):
            m.d.sync += of_first.eq(ones)
        total = counted.counts[place]
        with m.If(moves & changed):
            m.d.sync += total.eq(change + Mux(restarts, of_first << bits, total))
    return counted
