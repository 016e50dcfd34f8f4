"""Majorities of squares of a frame, as its classes pass: a small picture of a few votes per square.

A square is what `wnn2hdl.evaluation.squares.vote` takes for one when all pixels vote: squares start at the
top left corner, those at the right and bottom borders are what is left there, and of classes with equally
many votes the one of the lowest index wins.

For each class but the first one a counter says by how many votes it is ahead of the first. A line of a square
is counted in registers and then added to the counters of the square, of which a block RAM keeps a row.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, signed
from amaranth.lib.memory import Memory

from hdl_templates.scan import Pixels
from hdl_templates.stream import CHAIN, Head, named, queued

LATENCY = 3
"""Cycles from a beat to the majority of the square that it completes."""


@dataclass(frozen=True)
class Squares:
    """How squares are made.

    Attributes:
        side: pixels of a square's side, a multiple of the pixels of a beat.
        classes: how many classes there are.
    """

    side: int
    classes: int

    @property
    def vote_bits(self) -> int:
        """Bits of a counter, which has a sign."""
        return (self.side**2).bit_length() + 1

    def memory(self, places: int, pixels: int) -> tuple[int, int]:
        """Words of the memory, a power of two, and bits of a word.

        Args:
            places: beats of the longest line.
            pixels: of a beat.
        """
        squares = -(-places // (self.side // pixels))
        return 1 << (max(squares, 2) - 1).bit_length(), self.vote_bits * (self.classes - 1)


def majorities(
    m: Module, squares: Squares, beat: Pixels, *, places: int, room: Value, ready: Signal, taken: Value
) -> Head:
    """Count the classes of pixels that pass, and queue the majorities.

    Args:
        m: the module under construction.
        squares: how they are made.
        beat: the classes that are offered; ``final`` marks the last line of a frame.
        places: beats of the longest line.
        room: whether the beat is taken otherwise; it passes where it is taken here as well.
        ready: driven here, by registers: whether a beat can pass.
        taken: whether the head is taken in this cycle, if there is one.

    Returns:
        The majorities, row by row: start of a frame, end of a row, class.
    """
    beats = squares.side // len(beat.values)
    passes, closes, lowest = (Signal(name=f"squares_{what}") for what in ("passes", "closes", "lowest"))
    column, place = (
        Signal(range(max(size, 2)), name=f"squares_{what}")
        for size, what in ((beats, "column"), (-(-places // beats), "place"))
    )
    line = Signal(range(squares.side), name="squares_line")
    topmost = Signal(name="squares_topmost")
    # A frame may have been given up anywhere.
    column_at, place_at, line_at = (Mux(beat.start, 0, register) for register in (column, place, line))
    m.d.comb += [
        passes.eq(beat.valid & room & ready),
        closes.eq(beat.last | (column_at == beats - 1)),
        lowest.eq(beat.final | (line_at == squares.side - 1)),
    ]
    with m.If(passes):
        m.d.sync += [
            column.eq(Mux(closes, 0, column_at + 1)),
            place.eq(Mux(beat.last, 0, place_at + closes)),
            line.eq(Mux(beat.last, Mux(lowest, 0, line_at + 1), line_at)),
            topmost.eq((beat.start | topmost) & ~(beat.last & lowest)),
        ]
    flags = _later(
        m,
        Cat(
            passes,
            closes,
            column_at == 0,
            line_at == 0,
            (beat.start | topmost) & (place_at == 0),
            beat.last,
        ),
    )
    totals = _totals(m, squares, beat.values, place_at, places=places, flags=flags)
    return queued(
        m,
        "squares",
        valid=beat.valid & room & closes & lowest,
        ready=ready,
        word=Cat(flags[-1][4:6], _winner(m, totals)),
        latency=LATENCY,
        taken=taken,
    )


def _later(m: Module, flags: Value) -> list[Signal]:
    """The flags of a beat after each of the cycles."""
    later = [Signal(len(flags), name=f"squares_flags_{cycle}") for cycle in range(1, LATENCY + 1)]
    m.d.sync += [after.eq(before) for after, before in zip(later, [flags, *later], strict=False)]
    return later


def _totals(
    m: Module,
    squares: Squares,
    values: Sequence[Value],
    place: Value,
    *,
    places: int,
    flags: Sequence[Signal],
) -> list[Signal]:
    """By how many votes each class but the first is ahead of it, in the square that a beat completes.

    Args:
        m: the module under construction.
        squares: how they are made.
        values: the classes of the beat's pixels.
        place: of the beat's square in its row.
        places: beats of the longest line.
        flags: after each cycle whether the beat passes, is the last of its line in a square, is the first
            one, and is in the first line of the square.
    """
    votes = signed(squares.vote_bits)
    words, bits = squares.memory(places, len(values))
    memory = Memory(shape=bits, depth=words, init=[], attrs={"ram_style": "block"})
    m.submodules.squares_memory = memory
    write, read = memory.write_port(), memory.read_port()
    # The memory is read while the beat is counted. A line has a square again three cycles later at the
    # soonest: then the memory holds it.
    raw = Signal(len(read.data), name="squares_read")
    above = Signal(len(raw), name="squares_above", reset_less=True)
    written = _delayed_place(m, place)
    m.d.comb += [
        read.addr.eq(place),
        raw.eq(read.data),
        write.addr.eq(written),
        write.en.eq(flags[1][:2].all()),
    ]
    m.d.sync += above.eq(raw)
    totals, sums = [], []
    for number in range(1, squares.classes):
        ahead = Signal(signed(len(values).bit_length() + 1), name=f"squares_ahead_{number}")
        of_line = Signal(signed(squares.side.bit_length() + 1), name=f"squares_of_line_{number}")
        total = Signal(votes, name=f"squares_total_{number}", reset_less=True)
        own, first = ([value == index for value in values] for index in (number, 0))
        m.d.sync += ahead.eq(_count(own) - _count(first))
        with m.If(flags[0][0]):
            m.d.sync += of_line.eq(Mux(flags[0][2], 0, of_line) + ahead)
        before = above.word_select(number - 1, votes.width).as_signed()
        added = Signal(votes, name=f"squares_added_{number}")
        m.d.comb += added.eq(Mux(flags[1][3], 0, before) + of_line)
        m.d.sync += total.eq(added)
        sums.append(added)
        totals.append(total)
    m.d.comb += write.data.eq(Cat(*sums))
    return totals


def _delayed_place(m: Module, place: Value) -> Signal:
    """The place of the beat's square two cycles later."""
    once, twice = (Signal(len(place), name=f"squares_place_{cycle}", reset_less=True) for cycle in (1, 2))
    m.d.sync += [once.eq(place), twice.eq(once)]
    return twice


def _count(bits: Sequence[Value]) -> Value:
    """How many bits are set."""
    return sum(bits[1:], bits[0])


def _winner(m: Module, totals: Sequence[Value]) -> Value:
    """The first of the classes that have most votes; the first class is ahead of itself by none."""
    most: Value = Const(0, totals[0].shape())
    winner: Value = Const(0, len(totals).bit_length())
    for number, total in enumerate(totals, start=1):
        ahead = Signal(name=f"squares_is_{number}")
        m.d.comb += ahead.eq(total > most)
        most, winner = Mux(ahead, total, most), Mux(ahead, number, winner)
        if number % CHAIN == 0:
            most = named(m, f"squares_most_{number}", most)
            winner = named(m, f"squares_winner_{number}", winner)
    return winner
