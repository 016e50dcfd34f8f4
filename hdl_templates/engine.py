# amaranth: UnusedElaboratable=no
"""The match engine: a template against all positions in a segment of a map, see `wnn2hdl.ir.engine`.

Both come in by streams, into memories of which one half is filled while the other one is matched. Once a
template is complete, and a segment was ever, `hdl_templates.walk` reads them, `hdl_templates.lanes` compares
them, and `hdl_templates.peaks` keeps what is best.
"""

from collections.abc import Callable, Mapping
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, ResetInserter, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.buffered import Buffer, buffered
from hdl_templates.hierarchy import Part, place
from hdl_templates.interfaces import vivado_interfaces
from hdl_templates.lanes import scores
from hdl_templates.peaks import Peaks
from hdl_templates.walk import walk
from wnn2hdl.ir.engine import EDGE_BIT, RESULT_WORDS, WORD_BITS, EngineFormat


class MatchEngine(Part):
    """A match engine.

    Args:
        engine: sizes.
        lane: makes the circuit of a lane: the input ``pairs``, a pixel of the segment in each even bit and
            one of the template above it, and the output ``count``, at least one cycle later.

    Members:
        aresetn: In, synchronous reset, active low.
        s_axis_segment_*: segments, words of 32 pixels row after row, the first in bit 0; TLAST at the last.
        s_axis_template_*: templates as AXI4-Stream Video, of whose pixels bit 7 counts.
        m_axis_result_*: a beat for each template, see `wnn2hdl.ir.engine.EngineAnswer.words`.
    """

    clocked = True
    clock = "aclk"
    module_name = "engine"

    def __init__(self, *, engine: EngineFormat, lane: Callable[[], Part]) -> None:
        self.engine = engine
        self.lanes = [lane() for _ in range(engine.lanes)]
        if self.lanes[0].latency < 1:
            raise ValueError("a lane answers at least one cycle later")
        super().__init__(
            {
                "aresetn": In(1),
                "s_axis_segment_tdata": In(WORD_BITS),
                "s_axis_segment_tvalid": In(1),
                "s_axis_segment_tready": Out(1),
                "s_axis_segment_tlast": In(1),
                "s_axis_template_tdata": In(EDGE_BIT + 1),
                "s_axis_template_tvalid": In(1),
                "s_axis_template_tready": Out(1),
                "s_axis_template_tuser": In(1),
                "s_axis_template_tlast": In(1),
                "m_axis_result_tdata": Out(RESULT_WORDS * WORD_BITS),
                "m_axis_result_tvalid": Out(1),
                "m_axis_result_tready": In(1),
            }
        )

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        (height, width), (rows, columns) = self.engine.template, self.engine.segment
        return (
            f"Match engine: {height}x{width} in {rows}x{columns}, {self.engine.bits} bits per cycle "
            f"in {self.engine.lanes} lanes."
        )

    @property
    def port_attributes(self) -> Mapping[str, Mapping[str, str]]:
        """See `Part.port_attributes`."""
        return vivado_interfaces(self, streams=("s_axis_segment", "s_axis_template", "m_axis_result"))

    def elaborate(self, platform: object) -> Any:
        """Both inputs, what walks through them, the lanes, and what becomes of their scores."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        starts, has_segment, busy = Signal(name="starts"), Signal(name="has_segment"), Signal(name="busy")
        template = self._template(m, starts)
        segment = self._segment(m, starts)
        m.d.comb += starts.eq(
            ~busy & ~self.m_axis_result_tvalid & template.full & (segment.full | has_segment)
        )
        peaks = Peaks(engine=self.engine)
        place(m, "peaks", peaks, platform)
        m.d.comb += peaks.reset.eq(reset)
        with m.If(starts):
            m.d.sync += [busy.eq(1), has_segment.eq(1)]
        with m.If(peaks.done):
            m.d.sync += [busy.eq(0), self.m_axis_result_tvalid.eq(1)]
        with m.If(self.m_axis_result_tvalid & self.m_axis_result_tready):
            m.d.sync += self.m_axis_result_tvalid.eq(0)
        m.d.comb += self.m_axis_result_tdata.eq(_result(peaks))
        steps = walk(m, self.engine, segment=segment, template=template, starts=starts)
        valid, score = scores(m, self.engine, self.lanes, steps, segment.bit, template.bit, platform)
        m.d.comb += [peaks.valid.eq(valid), peaks.score.eq(score)]
        return ResetInserter(reset)(m)

    def _segment(self, m: Module, starts: Value) -> Buffer:
        """Take segments, a word in 33 cycles; one that is not as long as it should be is thrown away."""
        word = Signal(WORD_BITS, name="segment_word", reset_less=True)
        left = Signal(range(WORD_BITS + 1), name="segment_left")
        last = Signal(name="segment_last", reset_less=True)
        fresh, too_long = Signal(name="segment_fresh", init=1), Signal(name="segment_too_long")
        puts, ends, completes = (Signal(name=f"segment_{name}") for name in ("puts", "ends", "completes"))
        rows, columns = self.engine.segment
        buffer = buffered(
            m,
            "segment",
            rows * columns,
            puts=puts,
            pixel=word[0],
            first=fresh,
            completes=completes,
            swaps=starts,
        )
        m.d.comb += [
            self.s_axis_segment_tready.eq((left == 0) & ~buffer.full),
            puts.eq(left != 0),
            ends.eq(buffer.ends | (last & (left == 1))),
            completes.eq(puts & buffer.ends & last & ~too_long),
        ]
        with m.If(self.s_axis_segment_tvalid & self.s_axis_segment_tready):
            m.d.sync += [
                word.eq(self.s_axis_segment_tdata),
                last.eq(self.s_axis_segment_tlast),
                left.eq(WORD_BITS),
            ]
        with m.If(puts):
            m.d.sync += [word.eq(word[1:]), left.eq(Mux(ends, 0, left - 1)), fresh.eq(ends)]
            with m.If(ends):
                m.d.sync += too_long.eq(~last)
        return buffer

    def _template(self, m: Module, starts: Value) -> Buffer:
        """Take templates; the rest of one whose lines have other lengths is thrown away."""
        height, width = self.engine.template
        in_frame = Signal(name="template_in_frame")
        column = Signal(range(width), name="template_column", reset_less=True)
        at, puts, fault, completes = (
            Signal(like, name=f"template_{name}")
            for name, like in (("column_at", range(width)), ("puts", 1), ("fault", 1), ("completes", 1))
        )
        start, last = self.s_axis_template_tuser, self.s_axis_template_tlast
        buffer = buffered(
            m,
            "template",
            height * width,
            puts=puts,
            pixel=self.s_axis_template_tdata[EDGE_BIT],
            first=start,
            completes=completes,
            swaps=starts,
        )
        m.d.comb += [
            self.s_axis_template_tready.eq(~buffer.full),
            puts.eq(self.s_axis_template_tvalid & ~buffer.full & (start | in_frame)),
            at.eq(Mux(start, 0, column)),
            fault.eq(last ^ (at == width - 1)),
            completes.eq(puts & ~fault & buffer.ends),
        ]
        with m.If(puts):
            m.d.sync += [column.eq(Mux(last, 0, at + 1)), in_frame.eq(~fault & ~buffer.ends)]
        return buffer


def _result(peaks: Peaks) -> Value:
    """The words of a result."""
    rows, columns = peaks.places

    def position(entry: Value) -> list[Value]:
        place, score = entry[: rows + columns], entry[rows + columns :]
        return [_wide(place[:rows], 16), _wide(place[rows:], 16), _wide(score, WORD_BITS - 1)]

    second = Mux(peaks.alone, 0, peaks.second)
    sums = (_wide(total, 2 * WORD_BITS) for total in (peaks.total, peaks.squares))
    return Cat(*position(peaks.best), Const(0, 1), *position(second), peaks.alone, *sums)


def _wide(value: Value, width: int) -> Value:
    return Cat(value, Const(0, width - len(value)))
