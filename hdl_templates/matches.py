"""What stands around a match engine to control it: templates and segments that come, and results."""

from typing import Any

from amaranth.hdl import Const, Module, Mux, ResetInserter, Signal
from amaranth.lib.wiring import In, Out

from hdl_templates.arrivals import arrivals, counted, later
from hdl_templates.hierarchy import Part
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.registers import COUNT_BITS, DATA_BITS


class MatchControl(Part):
    """Lets templates into a match engine, watches what comes, and takes a result once it was read.

    Args:
        engine: the engine's sizes.

    Members:
        aresetn: In, synchronous reset, active low.
        enable: In, whether templates may begin.
        template_tvalid, _tready, _tuser, _tlast: In, the stream of templates, with the engine's ready.
        passes: Out, whether the beat of it that is offered may pass.
        segment_tvalid, _tready, _tlast: In, the stream of segments.
        result_tvalid: In, whether there is a result.
        result_tready: Out, whether it is taken: once nobody waits for it.
        waits: In, whether a match has ended whose result was not read yet.
        running: Out, whether a template is complete and has no result yet.
        has_segment: Out, whether a segment has come.
        ended: Out, for a cycle, that a match has ended.
        gone_wrong: Out, for a cycle, that a template or a segment turned out to be of another size.
        results, malformed: Out, how many of these there were.
    """

    clocked = True
    clock = "aclk"
    module_name = "match_control"

    def __init__(self, *, engine: EngineFormat) -> None:
        self.engine = engine
        inputs = ("tvalid", "tready", "tlast")
        super().__init__(
            {
                "aresetn": In(1),
                "enable": In(1),
                **{f"template_{name}": In(1) for name in (*inputs, "tuser")},
                "passes": Out(1),
                **{f"segment_{name}": In(1) for name in inputs},
                "result_tvalid": In(1),
                "result_tready": Out(1),
                "waits": In(1),
                "running": Out(1),
                "has_segment": Out(1),
                "ended": Out(1),
                "gone_wrong": Out(1),
                "results": Out(DATA_BITS),
                "malformed": Out(COUNT_BITS),
            }
        )

    def elaborate(self, platform: object) -> Any:  # noqa: ARG002  # there are no parts inside
        """The gate, both inputs, and the result."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        m.d.comb += self.passes.eq(~self.template_tuser | self.enable)
        height, width = self.engine.template
        seen = later(
            m,
            "came",
            taken=self.template_tvalid & self.template_tready & self.passes,
            start=self.template_tuser,
            last=self.template_tlast,
        )
        came = arrivals(m, seen, height=Const(height), longest=width, width=width)
        whole, faulty = self._segments(m)

        shown = Signal(name="result_shown")
        m.d.sync += shown.eq(self.result_tvalid)
        # Two templates can be there: the one that is matched, and the next.
        left = Signal(range(3), name="results_to_come")
        m.d.sync += left.eq(left + came.whole - self.ended)
        with m.If(whole):
            m.d.sync += self.has_segment.eq(1)
        counted(m, self.results, self.ended)
        counted(m, self.malformed, self.gone_wrong)
        m.d.comb += [
            self.ended.eq(self.result_tvalid & ~shown),
            self.result_tready.eq(shown & ~self.waits),
            self.running.eq(left.any()),
            self.gone_wrong.eq(came.malformed | faulty),
        ]
        return ResetInserter(reset)(m)

    def _segments(self, m: Module) -> tuple[Signal, Signal]:
        """Whether a segment is complete, and whether one was too short or too long."""
        words = self.engine.segment_words
        place = Signal(range(words + 1), name="segment_place")
        ends, right, whole, faulty = (
            Signal(name=f"segment_{name}") for name in ("ends", "right", "whole", "faulty")
        )
        taken = self.segment_tvalid & self.segment_tready
        m.d.comb += [
            ends.eq(taken & self.segment_tlast),
            right.eq(place == words - 1),
        ]
        with m.If(taken):
            m.d.sync += place.eq(Mux(self.segment_tlast, 0, Mux(place == words, place, place + 1)))
        m.d.sync += [whole.eq(ends & right), faulty.eq(ends & ~right)]
        return whole, faulty
