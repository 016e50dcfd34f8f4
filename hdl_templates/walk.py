"""How a match engine walks through template and segment: rows of both, the template's a step ahead."""

from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from hdl_templates.buffered import READ_CYCLES, Buffer
from wnn2hdl.ir.engine import EngineFormat


@dataclass(frozen=True)
class Row:
    """What a lane knows of the row of the template that it holds.

    Attributes:
        held: whether it holds one.
        first: whether it is the first one that is compared, of the first group of columns.
        last: whether it is the last one that is compared, of the last group.
    """

    held: Value
    first: Value
    last: Value

    def word(self) -> Value:
        """All of it."""
        return Cat(self.held, self.first, self.last)

    @classmethod
    def of(cls, word: Value) -> "Row":
        """The inverse of `word`."""
        return cls(word[0], word[1], word[2])


@dataclass(frozen=True)
class Steps:
    """What is said of the bits that come out of the memories.

    Attributes:
        shifts: whether a bit of a row of the segment comes.
        inside: whether with it the window lies inside the segment.
        begins: whether it is the first one of its row.
        row: the row of the template that the first lane gets with it.
        alone: whether all other lanes forget then what they hold.
        loads: whether a bit of the template comes, for the next step.
    """

    shifts: Value
    inside: Value
    begins: Value
    row: Row
    alone: Value
    loads: Value


def walk(m: Module, engine: EngineFormat, *, segment: Buffer, template: Buffer, starts: Value) -> Steps:
    """Read both memories in the order that `wnn2hdl.ir.engine` describes.

    Args:
        m: the module under construction.
        engine: sizes.
        segment: the segment's memory.
        template: the template's.
        starts: whether a match begins; the halves of the memories have changed places in the cycle after.
    """
    (height, width), (rows, columns) = engine.template, engine.segment
    groups = width // engine.columns
    begins = Signal(name="begins")
    m.d.sync += begins.eq(starts)
    runs, ahead, current = Signal(name="runs"), Signal(name="ahead"), Signal(name="current")
    beat = Signal(range(engine.step), name="beat", reset_less=True)
    steps = Signal(name="steps")
    m.d.comb += steps.eq(runs & (beat == engine.step - 1))

    # The step ahead: which row of the template, which row of the segment, which group of columns; where
    # they start in the memories, and where the group and the band do.
    row = Signal(range(height + engine.lanes), name="ahead_row", reset_less=True)
    line = Signal(range(rows + 1), name="ahead_line", reset_less=True)
    band_line = Signal(range(rows + 1), name="band_line", reset_less=True)
    group = Signal(range(max(groups, 2)), name="group", reset_less=True)
    segment_at, segment_group, segment_band = (
        Signal.like(segment.address, name=f"{name}_segment_at", reset_less=True)
        for name in ("ahead", "group", "band")
    )
    template_at, template_group, template_next = (
        Signal.like(template.address, name=f"{name}_template_at", reset_less=True)
        for name in ("ahead", "group", "next")
    )
    last_group = group == groups - 1 if groups > 1 else Const(1)
    rows_end, group_ends, all_end = (Signal(name=name) for name in ("rows_end", "group_ends", "all_end"))
    m.d.comb += [
        rows_end.eq(line == rows - 1),
        group_ends.eq(rows_end | (row == height + engine.lanes - 2)),
        all_end.eq(rows_end & last_group),
        template_next.eq(
            Mux(
                begins | (group_ends & last_group),
                template.base,
                Mux(group_ends, template_group + engine.columns, template_at + width),
            )
        ),
    ]
    with m.If(steps):
        m.d.sync += [row.eq(row + 1), line.eq(line + 1), segment_at.eq(segment_at + columns)]
        with m.If(group_ends):
            following = segment_group + engine.columns
            m.d.sync += [row.eq(0), line.eq(band_line), group.eq(group + 1)]
            m.d.sync += [segment_at.eq(following), segment_group.eq(following)]
            with m.If(last_group):
                following = segment_band + engine.lanes * columns
                below = band_line + engine.lanes
                m.d.sync += [group.eq(0), line.eq(below), band_line.eq(below)]
                m.d.sync += [at.eq(following) for at in (segment_at, segment_group, segment_band)]
        m.d.sync += [ahead.eq(ahead & ~all_end), current.eq(ahead), runs.eq(ahead)]
    with m.If(begins):
        m.d.sync += [register.eq(0) for register in (row, line, band_line, group, beat, current)]
        m.d.sync += [at.eq(segment.base) for at in (segment_at, segment_group, segment_band)]
        m.d.sync += [ahead.eq(1), runs.eq(1)]
    with m.If(begins | steps):
        m.d.sync += [template_at.eq(template_next), template.address.eq(template_next)]
        with m.If(begins | group_ends):
            m.d.sync += template_group.eq(template_next)
    with m.If(runs & ~steps):
        m.d.sync += [
            beat.eq(beat + 1),
            template.address.eq(template.address + 1),
            segment.address.eq(segment.address + 1),
        ]
    knows = Signal(3, name="current_row", reset_less=True)
    forgets = Signal(name="current_starts_group", reset_less=True)
    with m.If(steps):
        m.d.sync += [
            beat.eq(0),
            segment.address.eq(segment_at),
            knows.eq(
                Row(
                    ahead & (row < height), (row == 0) & (group == 0), (row == height - 1) & last_group
                ).word()
            ),
            forgets.eq(row == 0),
        ]
    now = Cat(
        current,
        current & (beat >= engine.columns - 1),
        current & (beat == 0),
        runs & (beat < engine.columns),
    )
    for cycle in range(1, READ_CYCLES + 1):
        later = Signal(len(now), name=f"walk_{cycle}")
        m.d.sync += later.eq(now)
        now = later
    return Steps(now[0], now[1], now[2], Row.of(knows), forgets, now[3])
