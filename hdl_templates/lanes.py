"""The lanes of a match engine: rows of the template against a row of the segment that passes by.

A row of the segment shifts through a window that all lanes see. The next row of the template collects in a
shift register, from where it goes to the first lane when the row of the segment ends; the lanes pass on
theirs. So lane j holds the row of the template before that of lane j - 1, and scores the row of positions
below that lane's.

What a lane has counted so far for each of its positions lies in one word of a memory with the counts of all
other lanes. In its last row a lane's sums are scores; only one lane is in its last row at a time.
"""

from collections.abc import Sequence
from functools import reduce
from operator import or_

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib.memory import Memory

from hdl_templates.hierarchy import Part, place
from hdl_templates.walk import Row, Steps
from wnn2hdl.ir.engine import EngineFormat


def scores(
    m: Module,
    engine: EngineFormat,
    lanes: Sequence[Part],
    steps: Steps,
    segment_bit: Value,
    template_bit: Value,
    platform: object,
) -> tuple[Value, Value]:
    """Count, and add up what was counted in each row.

    Args:
        m: the module under construction.
        engine: sizes.
        lanes: the circuits that compare, `EngineFormat.lanes` of them.
        steps: what the bits are.
        segment_bit: the bit of the segment that comes.
        template_bit: that of the template.
        platform: the platform of ``m``.

    Returns:
        Whether there is a score, and the score; all of them row by row.
    """
    window, next_row = (Signal(engine.columns, name=name, reset_less=True) for name in ("window", "next_row"))
    with m.If(steps.shifts):
        m.d.sync += window.eq(Cat(window[1:], segment_bit))
    with m.If(steps.loads):
        m.d.sync += next_row.eq(Cat(next_row[1:], template_bit))

    # Whether the window lies inside: when the lanes look at it, and later.
    latency = lanes[0].latency
    inside = [Signal(name=f"inside_{cycle}") for cycle in range(latency + 2)]
    begins = [Signal(name=f"begins_{cycle}") for cycle in range(latency)]
    m.d.sync += [later.eq(now) for now, later in zip((steps.inside, *inside), inside, strict=False)]
    m.d.sync += [later.eq(now) for now, later in zip((steps.begins, *begins), begins, strict=False)]

    # Counts are read a cycle before what is added to them is there, and written a cycle after.
    columns = engine.positions[1]
    width = engine.score_bits
    counts = Memory(shape=engine.lanes * width, depth=columns, init=[])
    m.submodules.counts = counts
    write, read = counts.write_port(), counts.read_port()
    place_1, place_2 = (Signal(range(columns), name=f"place_{cycle}", reset_less=True) for cycle in (1, 2))
    at = Signal(range(columns), name="place")
    with m.If(inside[latency - 1]):
        m.d.sync += at.eq(Mux(at == columns - 1, 0, at + 1))
    m.d.sync += [place_1.eq(at), place_2.eq(place_1)]
    m.d.comb += [read.addr.eq(at), write.addr.eq(place_2), write.en.eq(inside[latency + 1])]

    sums, finished, finishes = [], [], []
    row, known = next_row, steps.row
    for number, lane in enumerate(lanes):
        held_row = Signal(engine.columns, name=f"row_{number}", reset_less=True)
        held = Signal(3, name=f"holds_{number}")
        with m.If(steps.begins):
            m.d.sync += [held_row.eq(row), held.eq(known.word())]
        place(m, f"lane_{number}", lane, platform)
        pairs = Cat(*(Cat(window[column], held_row[column]) for column in range(engine.columns)))
        m.d.comb += lane.pairs.eq(pairs)
        # What the lane knows of what it counts now, which it looked at some cycles ago.
        then = Signal(3, name=f"held_{number}")
        with m.If(begins[latency - 1]):
            m.d.sync += then.eq(held)
        was = Row.of(then)
        count = Signal(len(lane.count), name=f"count_{number}", reset_less=True)
        before = Signal(width, name=f"before_{number}", reset_less=True)
        last = Signal(name=f"last_{number}")
        m.d.sync += [
            count.eq(Mux(was.held, lane.count, 0)),
            before.eq(Mux(was.first, 0, read.data.word_select(number, width))),
            last.eq(was.last & was.held),
        ]
        total = Signal(width, name=f"sum_{number}")
        done = Signal(width, name=f"score_{number}", reset_less=True)
        m.d.comb += total.eq(before + count)
        m.d.sync += done.eq(Mux(last, total, 0))
        sums.append(total)
        finished.append(done)
        finishes.append(last)
        row, passed = held_row, Row.of(held)
        known = Row(passed.held & ~steps.alone, passed.first, passed.last)
    m.d.comb += write.data.eq(Cat(*sums))
    any_done, valid = Signal(name="any_done"), Signal(name="score_valid")
    score = Signal(width, name="score", reset_less=True)
    m.d.sync += [
        any_done.eq(inside[latency + 1] & Cat(*finishes).any()),
        valid.eq(any_done),
        score.eq(reduce(or_, finished)),
    ]
    return valid, score
