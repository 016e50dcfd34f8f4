"""What stands around a video core to control it: where frames begin and end, and how many there were."""

from typing import Any

from amaranth.hdl import Cat, Const, Module, ResetInserter, Signal
from amaranth.lib.wiring import In, Out

from hdl_templates.arrivals import arrivals, countdown, counted, later
from hdl_templates.hierarchy import Part
from wnn2hdl.ir.registers import COUNT_BITS, DATA_BITS
from wnn2hdl.ir.video import HEIGHT_BITS, WIDTH_BITS

_SETTLES = 2
"""Cycles of comparison, and one more, for which a core wants its height to stand before a frame."""


class FrameControl(Part):
    """Lets frames into a video core, and watches them on both sides.

    A frame's first beat is held back while the core is not enabled, and for a few cycles where the height has
    changed. The height of a frame that is in the core is kept: another one is given to the core while the
    first beat of a frame waits. So where heights change, frames have to have more lines than the core keeps,
    or one frame may be counted wrongly.

    Args:
        pixels: of a beat, a power of two.
        longest: beats of the longest line.

    Members:
        aresetn: In, synchronous reset, active low.
        enable: In, whether frames may begin.
        height: In, lines of frames from the next one on; 0 means 4096.
        frame_height: Out, the core's.
        s_tvalid, s_tready, s_tuser, s_tlast: In, the stream in front, with the core's ready.
        passes: Out, whether the beat that is offered may pass.
        m_tvalid, m_tready, m_tuser, m_tlast: In, the stream behind.
        running: Out, whether a frame has begun and is not answered yet.
        answered: Out, for a cycle, that the last answer of a frame was taken.
        gone_wrong: Out, for a cycle, that a frame turned out malformed, see `hdl_templates.arrivals`.
        frames, malformed: Out, how many of these there were.
        width: Out, pixels of the first line of the frame that came last.
    """

    clocked = True
    clock = "aclk"
    module_name = "frame_control"

    def __init__(self, *, pixels: int, longest: int) -> None:
        self.pixels, self.longest = pixels, longest
        stream = ("tvalid", "tready", "tuser", "tlast")
        super().__init__(
            {
                "aresetn": In(1),
                "enable": In(1),
                "height": In(HEIGHT_BITS),
                "frame_height": Out(HEIGHT_BITS),
                **{f"{side}_{name}": In(1) for side in "sm" for name in stream},
                "passes": Out(1),
                "running": Out(1),
                "answered": Out(1),
                "gone_wrong": Out(1),
                "frames": Out(DATA_BITS),
                "malformed": Out(COUNT_BITS),
                "width": Out(WIDTH_BITS),
            }
        )

    def elaborate(self, platform: object) -> Any:  # noqa: ARG002  # there are no parts inside
        """The gate, and both sides."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        fits = Signal(_SETTLES, name="fits")
        may_begin = Signal(name="may_begin")
        m.d.sync += [
            fits.eq(Cat(self.frame_height == self.height, fits)),
            may_begin.eq(self.enable & fits.all() & (self.frame_height == self.height)),
        ]
        takes_height = Signal(name="takes_height")
        m.d.comb += takes_height.eq(self.s_tvalid & self.s_tuser & self.enable & ~may_begin)
        with m.If(takes_height):
            m.d.sync += self.frame_height.eq(self.height)
        m.d.comb += self.passes.eq(~self.s_tuser | may_begin)

        seen = later(
            m,
            "came",
            taken=self.s_tvalid & self.s_tready & self.passes,
            start=self.s_tuser,
            last=self.s_tlast,
        )
        came = arrivals(m, seen, height=self.frame_height, longest=self.longest)
        counted(m, self.frames, self.answered)
        counted(m, self.malformed, self.gone_wrong)
        shift = (self.pixels - 1).bit_length()
        m.d.comb += [
            self.answered.eq(self._answered(m)),
            self.gone_wrong.eq(came.malformed),
            self.width.eq(Cat(Const(0, shift), came.width)),
        ]
        with m.If(came.begins):
            m.d.sync += self.running.eq(1)
        with m.Elif(came.malformed | (self.answered & ~came.open)):
            m.d.sync += self.running.eq(0)
        return ResetInserter(reset)(m)

    def _answered(self, m: Module) -> Signal:
        """Whether the last answer of a frame was taken, a cycle ago."""
        gone = later(m, "gone", taken=self.m_tvalid & self.m_tready, start=self.m_tuser, last=self.m_tlast)
        # The height is taken along: the next frame may have another one, and have begun already.
        last_line = countdown(m, "lines_to_go", gone, self.frame_height)
        leaves, ends = Signal(name="leaves"), Signal(name="ends")
        m.d.comb += ends.eq(gone.taken & gone.last & (gone.start | leaves) & last_line)
        with m.If(gone.taken):
            m.d.sync += leaves.eq((gone.start | leaves) & ~ends)
        return ends
