"""A scan of frames: from the values of pixels, in the order of a frame, to the 3x3 windows around them.

Values come in beats, one for each pixel clock, of one or more pixels. Two memories' worth of lines are kept
in one block RAM: of each place the value in the line above, and of the value above that what a window sees.

The scan has three steps, each behind registers. They move on together, whenever ``moves`` says so, and a slot
of the pipeline may be empty:

1. *Position.* A beat gets its place in the memory. Here it is known how many lines have passed, so here the
   repeated line below the last one is put in: slots without a beat, as many as a line has. No pixel has been
   looked at yet, and nothing about lengths of lines is known.
2. *Line.* The slot meets what the memory holds of its place, out of an output register: one line above, and
   whether a line ended here. Malformed frames are found out.
3. *Window.* A beat waits for its right neighbour, unless it is the last of a line.

What a slot writes can be read three cycles later. Nothing waits for that but the first slot of a line, while
one of the first two slots of the line before is in the first two steps; later ones cannot be overtaken.
"""

from dataclasses import dataclass, fields

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib.memory import Memory

from hdl_templates.stream import Head
from wnn2hdl.ir.video import MAX_HEIGHT
from wnn2hdl.ir.window import SIDE

HEIGHT_BITS = (MAX_HEIGHT - 1).bit_length()
"""A height of 0 stands for `MAX_HEIGHT` lines."""


@dataclass(frozen=True)
class Beat:
    """A beat of windows, from registers.

    Attributes:
        valid: whether there is one.
        start: whether it is the first of a frame.
        last: whether it is the last of a line.
        windows: for each pixel what its window sees, row by row.
        values: the value of each pixel.
    """

    valid: Value
    start: Value
    last: Value
    windows: list[Value]
    values: list[Value]


@dataclass(frozen=True)
class Slot:
    """A slot of the pipeline, in registers.

    Attributes:
        valid: whether it is used.
        start: whether its beat is the first of a frame.
        last: whether its beat is the last of a line.
        flush: whether it has no beat, but belongs to the repeated line below the last.
        first: whether it is the first of its line.
        over: whether the memory has no place for it.
        place: in the memory.
        values: of the beat's pixels.
    """

    valid: Signal
    start: Signal
    last: Signal
    flush: Signal
    first: Signal
    over: Signal
    place: Signal
    values: Signal


@dataclass(frozen=True)
class Rows:
    """What a slot meets, pixel by pixel.

    Attributes:
        ended: whether the line above ended here.
        adds: whether the slot continues a line that has one above, so that windows can be looked at.
        arriving: what the windows see, three rows each, the upper first.
        centre: the values in the middle row.
        fresh: whether this is the first slot of a frame with ``adds``.
    """

    ended: Value
    adds: Value
    arriving: list[Value]
    centre: list[Value]
    fresh: Value


def scan(
    m: Module,
    head: Head,
    *,
    pixels: int,
    depth: int,
    places: int,
    height: Value,
    reset: Value,
    moves: Value,
    taken: Signal,
) -> Beat:
    """Scan frames; see the module's docstring.

    Args:
        m: the module under construction.
        head: the beats that come in: start of frame, end of line, the pixels' values.
        pixels: of a beat.
        depth: bits of a value that a window sees: all, or one that says whether the value is not 0.
        places: of the memory, in beats: the longest line.
        height: the most lines of a frame.
        reset: clears all state.
        moves: whether the beat that is answered can be taken.
        taken: driven here: whether the head is taken.
    """
    done = Signal(name="done")
    # One bit more than an address says that a line goes on behind the end of the memory.
    column = Signal((places - 1).bit_length() + 1, name="column", reset_less=True)
    early = _positions(m, head, column, height, reset, moves, done, taken)
    slot = _later(m, early, moves)
    rows = _lines(m, slot, column, pixels, depth, moves)
    m.d.comb += done.eq(slot.valid & slot.flush & rows.ended)
    return _windows(m, slot, rows, pixels, depth, moves)


def _positions(
    m: Module,
    head: Head,
    column: Signal,
    height: Value,
    reset: Value,
    moves: Value,
    done: Value,
    taken: Signal,
) -> Slot:
    """The first step; ``done`` says that the second has seen the end of the repeated line."""
    start, last, values = head.word[0], head.word[1], head.word[2:]
    # No frame is open: none has begun, or its last line is in.
    idle = Signal(name="idle", init=1)
    flush = Signal(name="flush")
    line_starts = Signal(name="line_starts", init=1)
    line_goes_on = Signal(name="line_goes_on")
    # A slot that the first of the next line must not follow too closely, in the first step or the second.
    young, marked, marks = Signal(name="young"), Signal(name="marked"), Signal(name="marks")

    # What is open when a frame begins is closed first: a frame by its repeated line, or by nothing, if it is
    # broken off inside a line; and a line that belongs to no frame.
    halts, waits, takes, step = (Signal(name=name) for name in ("halts", "waits", "takes", "step"))
    closes, turns = Signal(name="closes"), Signal(name="turns")
    last_line = Signal(name="last_line", reset_less=True)
    m.d.comb += [
        halts.eq(head.valid & start & ~flush & ~(idle & line_starts)),
        waits.eq(line_starts & young),
        takes.eq(head.valid & ~flush & ~halts & ~waits),
        step.eq(takes | (flush & ~waits)),
        taken.eq(moves & takes),
        closes.eq(takes & last & last_line & (start | ~idle)),
        # As `halts` or `takes` with the last of a line, written out to be two LUTs deep.
        turns.eq(done | (head.valid & ~flush & ((start & ~(idle & line_starts)) | (last & ~waits)))),
        marks.eq((step & (line_starts | line_goes_on | flush)) | halts),
    ]
    with m.If(moves):
        m.d.sync += [
            idle.eq(halts | closes | (idle & ~(takes & start))),
            flush.eq(closes | (halts & line_starts) | (flush & ~done)),
            line_starts.eq(turns | (line_starts & ~step)),
            line_goes_on.eq(Mux(step, line_starts, line_goes_on)),
            marked.eq(marks),
            young.eq(marks | marked),
        ]
    with m.If(moves & step):
        m.d.sync += column.eq(column + 1)
    # A condition of its own: flip-flops that are reset by it need no logic for that.
    with m.If(reset | (moves & turns)):
        m.d.sync += column.eq(0)

    # Lines are counted a cycle late, and compared a cycle later: no line ends sooner than three cycles after
    # the one before.
    held = Signal(HEIGHT_BITS, name="held_height", reset_less=True)
    line = Signal(HEIGHT_BITS, name="line", init=1, reset_less=True)
    line_ended = Signal(name="line_ended", reset_less=True)
    m.d.sync += [line_ended.eq(moves & takes & last), last_line.eq(line == held)]
    with m.If(line_ended):
        m.d.sync += line.eq(line + 1)
    with m.If(idle):
        m.d.sync += [held.eq(height), line.eq(1)]

    slot = _slot("early", len(column) - 1, len(values))
    with m.If(moves):
        m.d.sync += [
            slot.valid.eq(step),
            slot.start.eq(start & ~flush),
            slot.last.eq(last),
            slot.flush.eq(flush),
            slot.first.eq(line_starts),
            slot.over.eq(column[-1]),
            slot.place.eq(column[:-1]),
            slot.values.eq(values),
        ]
    return slot


def _slot(name: str, place_bits: int, value_bits: int) -> Slot:
    def register(what: str, bits: int = 1, *, reset_less: bool = True) -> Signal:
        return Signal(bits, name=f"{name}_{what}", reset_less=reset_less)

    return Slot(
        valid=register("valid", reset_less=False),
        start=register("start"),
        last=register("last"),
        flush=register("flush"),
        first=register("first"),
        over=register("over"),
        place=register("place", place_bits),
        values=register("values", value_bits),
    )


def _later(m: Module, early: Slot, moves: Value) -> Slot:
    """The slot a step later."""
    late = _slot("slot", len(early.place), len(early.values))
    with m.If(moves):
        m.d.sync += [getattr(late, field.name).eq(getattr(early, field.name)) for field in fields(Slot)]
    return late


def _look(value: Value, depth: int) -> Value:
    """What a window sees of a value."""
    return value if len(value) == depth else value.any()


def _lines(m: Module, slot: Slot, column: Signal, pixels: int, depth: int, moves: Value) -> Rows:
    """The second step: the slot and the lines above."""
    bits = len(slot.values) // pixels
    kept = Signal(1 + pixels * (depth + bits), name="kept")
    above = Signal(len(kept), name="above", reset_less=True)
    ended, upper = above[0], above[1:]
    centre = [upper.word_select(pixel, depth + bits)[depth:] for pixel in range(pixels)]
    top = [upper.word_select(pixel, depth + bits)[:depth] for pixel in range(pixels)]
    values = [slot.values.word_select(pixel, bits) for pixel in range(pixels)]

    # The slots of a frame are in its first line, or in one that has a line above, or the frame was given up.
    # The memory keeps the ends of lines, so lengths are compared without a counter.
    first_line, lined, adds = Signal(name="first_line"), Signal(name="lined"), Signal(name="adds")
    fresh = Signal(name="fresh", reset_less=True)
    m.d.comb += adds.eq(slot.valid & lined & ~slot.start & (slot.flush | (slot.last == ended)))
    with m.If(moves & slot.valid):
        m.d.sync += [
            first_line.eq((slot.start | first_line) & ~slot.last & ~slot.over),
            lined.eq(((slot.start | first_line) & slot.last & ~slot.over) | (adds & ~(slot.flush & ended))),
            fresh.eq((slot.start | first_line) & slot.last),
        ]

    lines = Memory(
        shape=len(kept),
        depth=1 << len(slot.place),
        init=[],
        # Yosys takes 40 LUTs instead for lines of 640 pixels.
        attrs={"ram_style": "block"},
    )
    m.submodules.lines = lines
    write, read = lines.write_port(), lines.read_port()
    # Above the first line it is repeated.
    seen = [
        Mux(lined & ~slot.start, _look(middle, depth), _look(value, depth))
        for middle, value in zip(centre, values, strict=True)
    ]
    words = [Cat(see, value) for see, value in zip(seen, values, strict=True)]
    m.d.comb += [
        read.addr.eq(column[:-1]),
        read.en.eq(moves),
        write.addr.eq(slot.place),
        kept.eq(Cat(slot.last, *words)),
        write.data.eq(kept),
        write.en.eq(moves & slot.valid & ~slot.flush),
    ]
    # The output register of the block RAM.
    raw = Signal(len(kept), name="read")
    m.d.comb += raw.eq(read.data)
    with m.If(moves):
        m.d.sync += above.eq(raw)
    arriving = [
        Cat(up, _look(middle, depth), Mux(slot.flush, _look(middle, depth), _look(value, depth)))
        for up, middle, value in zip(top, centre, values, strict=True)
    ]
    return Rows(ended, adds, arriving, centre, fresh)


def _windows(m: Module, slot: Slot, rows: Rows, pixels: int, depth: int, moves: Value) -> Beat:
    """The third step: the columns of the newest beat wait for the one to their right."""
    side = SIDE * depth
    columns = [Signal(side, name=f"newest_{pixel}", reset_less=True) for pixel in range(pixels)]
    values = [
        Signal(len(value), name=f"newest_value_{i}", reset_less=True) for i, value in enumerate(rows.centre)
    ]
    valid = Signal(name="newest_valid")
    first, start, last = (
        Signal(name=f"newest_{what}", reset_less=True) for what in ("first", "start", "last")
    )
    with m.If(moves):
        m.d.sync += valid.eq(rows.adds | (valid & ~slot.valid & ~last))
    with m.If(moves & slot.valid):
        m.d.sync += [
            *(column.eq(arriving) for column, arriving in zip(columns, rows.arriving, strict=True)),
            *(value.eq(centre) for value, centre in zip(values, rows.centre, strict=True)),
            first.eq(slot.first),
            start.eq(rows.fresh),
            last.eq(Mux(slot.flush, rows.ended, slot.last)),
        ]

    left, right = Signal(side, name="left", reset_less=True), Signal(side, name="right", reset_less=True)
    middle = [Signal(side, name=f"middle_{pixel}", reset_less=True) for pixel in range(pixels)]
    middle_values = [Signal.like(value, name=f"middle_value_{i}") for i, value in enumerate(values)]
    middle_valid = Signal(name="middle_valid")
    middle_start, middle_last = (Signal(name=f"middle_{what}", reset_less=True) for what in ("start", "last"))
    with m.If(moves):
        m.d.sync += middle_valid.eq(valid & (last | rows.adds))
    with m.If(moves & (last | slot.valid)):
        m.d.sync += [
            left.eq(Mux(first, columns[0], middle[-1])),
            *(later.eq(column) for later, column in zip(middle, columns, strict=True)),
            right.eq(Mux(last, columns[-1], rows.arriving[0])),
            *(later.eq(value) for later, value in zip(middle_values, values, strict=True)),
            middle_start.eq(start),
            middle_last.eq(last),
        ]
    around = [left, *middle, right]
    windows = [
        Cat(
            *(
                column.word_select(row, depth)
                for row in range(SIDE)
                for column in around[pixel : pixel + SIDE]
            )
        )
        for pixel in range(pixels)
    ]
    return Beat(middle_valid, middle_start, middle_last, windows, middle_values)
