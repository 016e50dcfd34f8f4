"""What comes in by a stream of AXI4-Stream Video: whole pictures and malformed ones, and where they begin."""

from dataclasses import dataclass

from amaranth.hdl import Module, Mux, Signal, Value


@dataclass(frozen=True)
class Beat:
    """A beat that passes.

    Attributes:
        taken: whether there is one.
        start: whether it is the first one of a picture.
        last: whether it is the last one of a line.
    """

    taken: Value
    start: Value
    last: Value


@dataclass(frozen=True)
class Arrivals:
    """What is known of pictures, from the beats before this cycle.

    Attributes:
        open: whether one has begun, is not malformed so far, and lacks lines.
        begins: whether one begins with this beat.
        whole: whether one is complete with this beat.
        malformed: whether one turns out malformed with this beat.
        width: beats of the last picture's first line.
    """

    open: Value
    begins: Value
    whole: Value
    malformed: Value
    width: Value


def later(m: Module, name: str, *, taken: Value, start: Value, last: Value) -> Beat:
    """The beat of the cycle before, from registers: what watches a stream makes no path of it longer."""
    beat = Beat(*(Signal(name=f"{name}_{what}") for what in ("taken", "start", "last")))
    m.d.sync += [beat.taken.eq(taken), beat.start.eq(start), beat.last.eq(last)]
    return beat


def arrivals(m: Module, beat: Beat, *, height: Value, longest: int, width: int | None = None) -> Arrivals:
    """Watch the pictures of a stream.

    A picture is malformed if another one begins before all its lines are there, or with a line of another
    length than the others.

    Args:
        m: the module under construction.
        beat: what passes.
        height: lines of a picture; 0 stands for as many as it has no bits for.
        longest: beats of the longest line.
        width: beats of each line; None where the first one of a picture decides.
    """
    bits = max(1, (longest - 1).bit_length())
    is_open, first = Signal(name="open"), Signal(name="first_line", reset_less=True)
    column, ends_at = (Signal(bits, name=name, reset_less=True) for name in ("column", "ends_at"))
    at = Signal(bits, name="column_at")
    last_line = countdown(m, "lines_to_come", beat, height)
    names = ("begins", "runs", "learns", "fault", "whole", "malformed_now")
    begins, runs, learns, fault, whole, malformed = (Signal(name=name) for name in names)
    at_end = Signal(name="at_end")
    m.d.comb += [
        begins.eq(beat.taken & beat.start),
        runs.eq(beat.taken & (beat.start | is_open)),
        at.eq(Mux(beat.start, 0, column)),
        learns.eq(beat.start | first if width is None else 0),
        at_end.eq(at == (Mux(learns, longest - 1, ends_at) if width is None else width - 1)),
        fault.eq((beat.last ^ at_end) & ~(learns & beat.last)),
        whole.eq(runs & ~fault & beat.last & last_line),
        malformed.eq((runs & fault) | (begins & is_open)),
    ]
    with m.If(beat.taken):
        m.d.sync += [
            column.eq(Mux(beat.last, 0, at + 1)),
            first.eq(learns & ~beat.last),
        ]
    with m.If(runs):
        m.d.sync += is_open.eq(~fault & ~whole)
    with m.If(runs & learns & beat.last):
        m.d.sync += ends_at.eq(at)
    return Arrivals(is_open, begins, whole, malformed, ends_at + 1)


def countdown(m: Module, name: str, beat: Beat, height: Value) -> Value:
    """Count the lines of pictures; whether the beat belongs to the last one of its picture.

    Args:
        m: the module under construction.
        name: of the register.
        beat: what passes.
        height: lines of the picture that begins with the beat; 0 as of `arrivals`.
    """
    lines = Signal(len(height), name=name, reset_less=True)
    with m.If(beat.taken):
        m.d.sync += lines.eq(Mux(beat.start, height, lines) - beat.last)
    return Mux(beat.start, height == 1, lines == 1)


def counted(m: Module, count: Signal, event: Value) -> None:
    """Count events, modulo 2 to the bits of the counter."""
    with m.If(event):
        m.d.sync += count.eq(count + 1)
