"""A scan of frames: from the values of pixels, in the order of a frame, to the columns of windows.

Values come in beats, one for each pixel clock, of one or more pixels. The window around a pixel extends as
many lines above and below it as pixels to each side, its *reach*: one for 3x3, two for 5x5. Of each place in
a line the block RAM keeps the bits of the lines above that windows see, and no more. `hdl_templates.across`
puts the columns of neighbouring pixels side by side.

The scan has two steps here, each behind registers. They move on together, whenever ``moves`` says so, and a
slot of the pipeline may be empty:

1. *Position.* A beat gets its place in the memory. Here it is known how many lines have passed, so here the
   repeated lines below the last one are put in, as many as the reach: slots without a beat, as many as a line
   has. No pixel has been looked at yet, and nothing about lengths of lines is known.
2. *Line.* The slot meets what the memory holds of its place, out of an output register: the lines above, and
   whether a line ended here. Malformed frames are found out.

What a slot writes can be read three cycles later. Nothing waits for that but the first slot of a line, while
one of the first two slots of the line before is in the first two steps; later ones cannot be overtaken.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import pairwise

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib.memory import Memory

from wnn2hdl.ir.video import HEIGHT_BITS


@dataclass(frozen=True)
class Pixels:
    """A beat of pixels that is offered to a scan, from registers.

    Attributes:
        valid: whether there is one.
        start: whether it is the first of a frame.
        last: whether it is the last of a line.
        final: whether its line is the last of its frame; None where that is found by counting lines.
        values: of the pixels, from left to right, all of one width.
    """

    valid: Value
    start: Value
    last: Value
    final: Value | None
    values: Sequence[Value]


@dataclass(frozen=True)
class Columns:
    """The columns that windows see of a beat, with all lines in them, as they arrive.

    The middle line of the window is the line that is answered; beyond the frame its nearest line is repeated.

    Attributes:
        valid: whether there is a slot, of any kind; all else is about a slot.
        whole: whether its lines are all of one frame that is well-formed as yet, so that it can be answered.
        first: whether it is the first of its line.
        last: whether it is the last of its line, of a slot that is ``whole``; of others it may be anything.
        start: whether it is the first one of a frame that can be answered.
        final: whether the line that is answered is the last one of its frame.
        bits: for each pixel, from left to right, and each bit of its value the bits of the lines, the newest,
            lowest one first: one more than are kept of it.
    """

    valid: Value
    whole: Value
    first: Value
    last: Value
    start: Value
    final: Value
    bits: list[list[Value]]


@dataclass(frozen=True)
class Slot:
    """A slot of the pipeline, in registers.

    Attributes:
        valid: whether it is used.
        start: whether its beat is the first of a frame.
        last: whether its beat is the last of a line.
        flush: whether it is used without a beat: for a repeated line below the last.
        final: whether that is the last one of these.
        first: whether it is the first of its line.
        over: whether the memory has no place for it.
        place: in the memory.
        values: of the beat's pixels.
    """

    valid: Signal
    start: Signal
    last: Signal
    flush: Signal
    final: Signal
    first: Signal
    over: Signal
    place: Signal
    values: Signal


def scan(
    m: Module,
    name: str,
    pixels: Pixels,
    *,
    reach: int,
    kept: Sequence[int],
    places: int,
    height: Value | None,
    reset: Value,
    moves: Value,
    taken: Signal,
) -> Columns:
    """Scan frames; see the module's docstring.

    A scan of answers of another scan needs no height: its beats say which line is the last one of a frame.

    Args:
        m: the module under construction.
        name: what the names of its signals begin with, for a second scan in a module; may be empty.
        pixels: the beats that come in.
        reach: lines of a window above its middle, and below.
        kept: for each bit of a value how many lines above the newest one the memory keeps of it, 1 to
            ``2 * reach``.
        places: of the memory, in beats: the longest line, a power of two.
        height: the most lines of a frame; None where ``pixels.final`` says which is the last.
        reset: clears all state.
        moves: whether what leaves the scan can be taken; if not, all of it stands still.
        taken: driven here: whether the beat that is offered is taken.
    """
    done = Signal(name=f"{name}done")
    # One bit more than an address says that a line goes on behind the end of the memory.
    column = Signal((places - 1).bit_length() + 1, name=f"{name}column", reset_less=True)
    early = _positions(m, name, pixels, reach, column, height, reset, moves, done, taken)
    slot = _later(m, name, early, reach, moves, done)
    return _lines(m, name, slot, column, len(pixels.values), reach, kept, moves, done)


def _positions(
    m: Module,
    name: str,
    pixels: Pixels,
    reach: int,
    column: Signal,
    height: Value | None,
    reset: Value,
    moves: Value,
    done: Value,
    taken: Signal,
) -> Slot:
    """The first step; ``done`` says that the second has seen the end of a repeated line."""

    def signal(what: str, *, init: int = 0) -> Signal:
        return Signal(name=f"{name}{what}", init=init)

    start, last = pixels.start, pixels.last
    # No frame is open: none has begun, or its last line is in.
    idle = signal("idle", init=1)
    flush = signal("flush")
    line_starts = signal("line_starts", init=1)
    line_goes_on = signal("line_goes_on")
    # A slot that the first of the next line must not follow too closely, in the first step or the second.
    young, marked, marks = signal("young"), signal("marked"), signal("marks")

    # What is open when a frame begins is closed first: a frame by its repeated lines, or by nothing, if it is
    # broken off inside a line; and a line that belongs to no frame.
    halts, waits, takes, step = (signal(what) for what in ("halts", "waits", "takes", "step"))
    closes, turns, repeats = signal("closes"), signal("turns"), signal("repeats")
    counted = None if height is None else _last_line(m, name, height, idle, moves & takes & last)
    last_line = pixels.final if counted is None else counted
    assert last_line is not None
    m.d.comb += [
        halts.eq(pixels.valid & start & ~flush & ~(idle & line_starts)),
        waits.eq(line_starts & (marked | young)),
        takes.eq(pixels.valid & ~flush & ~halts & ~waits),
        repeats.eq(flush & ~waits),
        step.eq(takes | repeats),
        taken.eq(moves & takes),
        closes.eq(takes & last & last_line & (start | ~idle)),
        # As `halts` or `takes` with the last of a line, written out to be two LUTs deep.
        turns.eq(done | (pixels.valid & ~flush & ((start & ~(idle & line_starts)) | (last & ~waits)))),
        marks.eq((step & (line_starts | line_goes_on | flush)) | halts),
    ]
    final: Value = flush
    ends = done
    if reach > 1:
        repeated = Signal(range(reach), name=f"{name}repeated")
        final = signal("final")
        m.d.comb += final.eq(flush & (repeated == reach - 1))
        ends = done & final
        with m.If(moves & done):
            m.d.sync += repeated.eq(Mux(final, 0, repeated + 1))
    # Where beats say which line is the last one, a frame that ends without it is malformed.
    cut = halts & line_starts if height is not None else Const(0)
    with m.If(moves):
        m.d.sync += [
            idle.eq(halts | closes | (idle & ~(takes & start))),
            flush.eq(closes | cut | (flush & ~ends)),
            line_starts.eq(turns | (line_starts & ~step)),
            line_goes_on.eq(Mux(step, line_starts, line_goes_on)),
            marked.eq(marks),
            young.eq(marked),
        ]
    with m.If(moves & step):
        m.d.sync += column.eq(column + 1)
    # A condition of its own: flip-flops that are reset by it need no logic for that.
    with m.If(reset | (moves & turns)):
        m.d.sync += column.eq(0)

    values = Cat(*pixels.values)
    slot = _slot(f"{name}early", len(column) - 1, len(values), reach)
    with m.If(moves):
        m.d.sync += [
            # Nothing of a repeated line comes behind its end if another one follows.
            slot.valid.eq(step & ~done if reach > 1 else step),
            slot.start.eq(start & ~flush),
            slot.last.eq(last),
            slot.flush.eq(repeats & ~done if reach > 1 else repeats),
            *([slot.final.eq(final)] if reach > 1 else []),
            slot.first.eq(line_starts),
            slot.over.eq(column[-1]),
            slot.place.eq(column[:-1]),
            slot.values.eq(values),
        ]
    return slot


def _last_line(m: Module, name: str, height: Value, idle: Value, ends: Value) -> Value:
    """Whether a frame has as many lines with the one that is open as ``height`` says.

    Lines are counted a cycle late, and compared a cycle later: no line ends sooner than three cycles after
    the one before.

    Args:
        m: the module under construction.
        name: what the names of its signals begin with.
        height: the most lines of a frame.
        idle: whether no frame is open.
        ends: whether a line ends.
    """
    last_line = Signal(name=f"{name}last_line")
    held = Signal(HEIGHT_BITS, name=f"{name}held_height", reset_less=True)
    line = Signal(HEIGHT_BITS, name=f"{name}line", init=1, reset_less=True)
    line_ended = Signal(name=f"{name}line_ended", reset_less=True)
    # In LUTs of six inputs, three places each: in one word Yosys takes two LUTs more.
    same = Signal(HEIGHT_BITS // 3, name=f"{name}same_lines", reset_less=True)
    m.d.comb += last_line.eq(same.all())
    m.d.sync += [
        line_ended.eq(ends),
        same.eq(Cat(line.word_select(i, 3) == held.word_select(i, 3) for i in range(len(same)))),
    ]
    with m.If(line_ended):
        m.d.sync += line.eq(line + 1)
    with m.If(idle):
        m.d.sync += [held.eq(height), line.eq(1)]
    return last_line


def _slot(name: str, place_bits: int, value_bits: int, reach: int) -> Slot:
    """The registers of a slot; a scan that repeats one line knows the last repeated one by ``flush``."""

    def register(what: str, bits: int = 1, *, reset_less: bool = True) -> Signal:
        return Signal(bits, name=f"{name}_{what}", reset_less=reset_less)

    flush = register("flush", reset_less=False)
    return Slot(
        valid=register("valid", reset_less=False),
        start=register("start"),
        last=register("last"),
        flush=flush,
        final=flush if reach == 1 else register("final"),
        first=register("first"),
        over=register("over"),
        place=register("place", place_bits),
        values=register("values", value_bits),
    )


def _later(m: Module, name: str, early: Slot, reach: int, moves: Value, done: Value) -> Slot:
    """The slot a step later."""
    late = _slot(f"{name}slot", len(early.place), len(early.values), reach)
    with m.If(moves):
        m.d.sync += [getattr(late, field.name).eq(getattr(early, field.name)) for field in fields(Slot)]
        if reach > 1:
            m.d.sync += [late.valid.eq(early.valid & ~done), late.flush.eq(early.flush & ~done)]
    return late


def _lines(
    m: Module,
    name: str,
    slot: Slot,
    column: Signal,
    pixels: int,
    reach: int,
    kept: Sequence[int],
    moves: Value,
    done: Signal,
) -> Columns:
    """The second step: the slot and the lines above."""
    word = Signal(1 + pixels * sum(kept), name=f"{name}kept")
    above = Signal(len(word), name=f"{name}above", reset_less=True)
    ended = above[0]
    # A line that was longer than the memory may have lost its end, since repeated lines write, too. Where one
    # line is repeated, slots that come behind its end are done as well; no beat follows as closely.
    m.d.comb += done.eq(slot.flush & (ended | slot.over))

    # The slots of a frame are in its first line, or in one that has a line above, or the frame was given up.
    # The memory keeps the ends of lines, so lengths are compared without a counter.
    first_line, adds = Signal(name=f"{name}first_line"), Signal(name=f"{name}adds")
    lined = [
        Signal(name=f"{name}lined" if count == 1 else f"{name}lined_{count}") for count in range(1, reach + 1)
    ]
    fresh = Signal(name=f"{name}fresh", reset_less=True)
    second = (slot.start | first_line) & slot.last
    m.d.comb += adds.eq(slot.valid & lined[0] & ~slot.start & (slot.flush | (slot.last == ended)))
    with m.If(moves & slot.valid):
        m.d.sync += [
            first_line.eq((slot.start | first_line) & ~slot.last & ~slot.over),
            lined[0].eq((second & ~slot.over) | (adds & ~(slot.final & ended))),
            *(more.eq(adds & (more | (ended & fewer))) for fewer, more in pairwise(lined)),
            fresh.eq(second if reach == 1 else adds & ended & lined[-2] & ~lined[-1]),
        ]

    lines = Memory(
        shape=len(word),
        depth=1 << len(slot.place),
        init=[],
        # Yosys takes 40 LUTs instead for lines of 640 pixels.
        attrs={"ram_style": "block"},
    )
    m.submodules[f"{name}lines"] = lines
    write, read = lines.write_port(), lines.read_port()
    has_above = lined[0] & ~slot.start
    bits: list[list[Value]] = []
    words: list[Value] = []
    position = 1
    for pixel in range(pixels):
        columns: list[Value] = []
        for bit, count in enumerate(kept):
            value = slot.values[pixel * len(kept) + bit]
            older = above[position : position + count]
            position += count
            # Below the last line it is repeated, and above the first.
            newest = Mux(slot.flush, older[0], value)
            columns.append(Cat(newest, older))
            next_above = [value if reach == 1 else newest]
            next_above += [Mux(has_above, older[line], value) for line in range(count - 1)]
            words += next_above
        bits.append(columns)
    m.d.comb += [
        read.addr.eq(column[:-1]),
        read.en.eq(moves),
        write.addr.eq(slot.place),
        word.eq(Cat(Mux(slot.flush, ended, slot.last) if reach > 1 else slot.last, *words)),
        write.data.eq(word),
        write.en.eq(moves & slot.valid),
    ]
    # The output register of the block RAM.
    raw = Signal(len(word), name=f"{name}read")
    m.d.comb += raw.eq(read.data)
    with m.If(moves):
        m.d.sync += above.eq(raw)
    return Columns(slot.valid, adds & lined[-1], slot.first, ended, fresh, slot.final, bits)
