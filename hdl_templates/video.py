# amaranth: UnusedElaboratable=no
"""Video cores: circuits of pixels and of windows between two streams of AXI4-Stream Video (AMD UG934).

A stream carries a pixel a beat, frames row by row: TUSER marks the first pixel of a frame, TLAST the last of
a line. A core classifies each pixel once, as it comes in. What looks at a 3x3 window reads the answers, one
bit each, of the two lines before from a block RAM, not the pixels.

Beyond the picture the nearest pixel inside is repeated, as in `wnn2hdl.ir.window.framed_window_codes`.

A frame is the lines up to the next TUSER, but no more than the input ``height`` says; all are as long as the
first one. The RAM keeps the ends of lines beside the answers: no width is set, and lengths are compared
without a counter. After the last of ``height`` lines, or where the next TUSER comes before, the core takes no
pixels for as many cycles as a line has, in which the last line of answers comes out.

A frame is given up where it turns out malformed: at a line that is shorter or longer than the first, a first
line that is longer than the RAM, or a TUSER inside a line. The answers that are complete by then stand; there
are no more, and the pixels before the next TUSER are thrown away. What follows is as after a reset.
"""

from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, ResetInserter, Signal, Value
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part, place
from hdl_templates.stream import Head, queued
from wnn2hdl.ir import CHANNELS, PIXEL_BITS, WINDOW_BITS, VideoFormat
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS
from wnn2hdl.ir.video import ANSWER_BITS, MAX_HEIGHT
from wnn2hdl.ir.window import SIDE

HEIGHT_BITS = (MAX_HEIGHT - 1).bit_length()
"""A height of 0 stands for `MAX_HEIGHT` lines."""


class VideoCore(Part):
    """A video core.

    Args:
        video: what goes in and what comes out.
        pixel: the circuit of a pixel: the input ``rgb`` and one output, its value.
        window: the circuit of a 3x3 window of such values, or of one bit each that says whether the value is
            not 0: one input and one output of one bit; combinational. None where no edge is asked for.

    Members:
        aresetn: In, synchronous reset, active low.
        height: In, the most lines of a frame, to be held still while one passes; 0 means 4096. Only where
            edges are sent.
        s_axis_video_*: the stream of pixels.
        m_axis_video_*: the stream of answers.

    Raises:
        ValueError: the window's circuit is missing, in vain, or has registers.
    """

    clocked = True
    clock = "aclk"
    module_name = "video"

    def __init__(self, *, video: VideoFormat, pixel: Part, window: Part | None) -> None:
        if (window is None) == video.has_edges:
            raise ValueError("a core needs the circuit of a window for edges, and for nothing else")
        if window is not None and window.latency:
            raise ValueError("the circuit of a window has to be combinational")
        self.video, self.pixel, self.window = video, pixel, window
        members = {
            "aresetn": In(1),
            "height": In(HEIGHT_BITS),
            **_stream("s_axis_video", PIXEL_BITS, In, Out),
            **_stream("m_axis_video", ANSWER_BITS, Out, In),
        }
        super().__init__({name: member for name, member in members.items() if name != "height" or window})

    @property
    def places(self) -> int:
        """Words of the memory, a power of two: the longest line has as many pixels."""
        return 1 << (self.video.max_width - 1).bit_length()

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        what = {"class": "classes", "edge": "edges", "both": "classes and edges"}[self.video.answer]
        lines = f", of lines of up to {self.video.max_width} pixels" if self.window else ""
        return f"AXI4-Stream Video: {what} of RGB pixels{lines}."

    def elaborate(self, platform: object) -> Any:
        """The classifier and its queue; behind it the window, or nothing."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        place(m, "classifier", self.pixel, platform)
        channels = {
            channel: self.s_axis_video_tdata[CHANNEL_BITS * place : CHANNEL_BITS * (place + 1)]
            for place, channel in enumerate(self.video.channels)
        }
        m.d.comb += self.pixel.rgb.eq(Cat(*(channels[channel] for channel in reversed(CHANNELS))))
        value = _output(self.pixel)
        start, last = self.s_axis_video_tuser, self.s_axis_video_tlast
        for cycle in range(1, self.pixel.latency + 1):
            start, last = _register(m, f"start_{cycle}", start), _register(m, f"last_{cycle}", last)
        taken = Signal()
        head = queued(
            m,
            valid=self.s_axis_video_tvalid,
            ready=self.s_axis_video_tready,
            word=Cat(start, last, value),
            latency=self.pixel.latency,
            taken=taken,
        )
        if self.window is None:
            m.d.comb += [
                self.m_axis_video_tvalid.eq(head.valid),
                self.m_axis_video_tuser.eq(head.word[0]),
                self.m_axis_video_tlast.eq(head.word[1]),
                self.m_axis_video_tdata.eq(head.word[2:]),
                taken.eq(self.m_axis_video_tready),
            ]
        else:
            self._windows(m, reset, head, taken, platform)
        return ResetInserter(reset)(m)

    def _windows(self, m: Module, reset: Signal, head: Head, taken: Signal, platform: object) -> None:
        """From values in the order of the frame to answers, one line and one pixel later."""
        assert self.window is not None
        place(m, "window", self.window, platform)
        (window_port,) = (name for name, member in self.window.signature.members.items() if member.flow == In)
        windows = getattr(self.window, window_port)
        depth = len(windows) // WINDOW_BITS
        start, last, value = head.word[0], head.word[1], head.word[2:]

        def look(of: Value) -> Value:
            """What a window sees of a value."""
            return of if len(of) == depth else of.any()

        # Everything behind the queue moves at once, whenever the answer at the end is gone.
        moves = Signal(name="moves")
        m.d.comb += moves.eq(~self.m_axis_video_tvalid | self.m_axis_video_tready)

        places = self.places
        in_frame = Signal(name="in_frame")
        # Whether there is a line above, and whether this is the repeated one below the last.
        lined, flush = Signal(name="lined"), Signal(name="flush")
        line_starts = Signal(name="line_starts", init=1)
        # Of the place that the head is for, and of the one behind it; one more bit of that says that the
        # memory ends.
        column = Signal(range(places), name="column", reset_less=True)
        next_column = Signal(range(places + 1), name="next_column", init=1, reset_less=True)
        line = Signal(HEIGHT_BITS, name="line", init=1, reset_less=True)
        # What is known of this place in the line above.
        above = Signal(1 + depth + len(value), name="above")
        ended, centre_above, centre_value = above[0], above[1 : 1 + depth], above[1 + depth :]

        # A step goes on by one place: a pixel, or in the line below the last one of the line above.
        halts, step, ends = Signal(name="halts"), Signal(name="step"), Signal(name="ends")
        good, goes_on, breaks = Signal(name="good"), Signal(name="goes_on"), Signal(name="breaks")
        fault = ~flush & Mux(lined, last ^ ended, ~last & next_column[-1])
        m.d.comb += [
            halts.eq(head.valid & start & ~flush & (in_frame | ~line_starts)),
            step.eq(moves & (flush | (head.valid & ~halts))),
            taken.eq(moves & ~flush & ~halts),
            ends.eq(Mux(flush, ended, last)),
            good.eq((start | in_frame) & ~fault),
            goes_on.eq(good & ~(flush & ended)),
            breaks.eq(moves & halts & ~line_starts),
        ]
        with m.If(step):
            m.d.sync += [
                in_frame.eq(goes_on),
                lined.eq(goes_on & (lined | last)),
                flush.eq(Mux(flush, ~ended, good & last & (line == self.height))),
                line_starts.eq(ends),
                column.eq(next_column),
                next_column.eq(next_column + 1),
            ]
        # A new frame ends the one before, whose last line is yet to come out; or breaks it off inside a line.
        with m.If(halts & line_starts):
            m.d.sync += flush.eq(1)
        with m.If(breaks):
            m.d.sync += [in_frame.eq(0), lined.eq(0), line_starts.eq(1)]
        # One condition each: counters whose flip-flops are reset by it need no logic for that.
        with m.If(step & ends):
            m.d.sync += line.eq(line + 1)
        with m.If(reset | breaks | (step & ~goes_on)):
            m.d.sync += line.eq(1)
        with m.If(reset | breaks | (step & ends)):
            m.d.sync += [column.eq(0), next_column.eq(1)]

        # What the next line needs of this place. The first place has a register, so that the address of the
        # next one is always one more.
        lines = Memory(
            shape=len(above),
            depth=places,
            init=[],
            # Yosys takes 40 LUTs instead for lines of 640 pixels.
            attrs={"ram_style": "block"},
        )
        m.submodules.lines = lines
        write, read = lines.write_port(), lines.read_port()
        first_place = Signal(len(above), name="first_place", reset_less=True)
        kept, keeps = Signal(len(above), name="kept"), Signal(name="keeps")
        centre = look(centre_value)
        m.d.comb += [
            kept.eq(Cat(last, Mux(lined, centre, look(value)), value)),
            read.addr.eq(next_column),
            read.en.eq(step),
            write.addr.eq(column),
            write.data.eq(kept),
            keeps.eq(step & ~flush),
            write.en.eq(keeps),
            above.eq(Mux(line_starts, first_place, read.data)),
        ]
        with m.If(step & line_starts):
            m.d.sync += first_place.eq(kept)

        # Three columns of the window; the newest waits for its right neighbour, the last of a line has none.
        arriving = Signal(SIDE * depth, name="arriving")
        newest = Signal(SIDE * depth, name="newest", reset_less=True)
        newest_value = Signal(len(value), name="newest_value", reset_less=True)
        newest_valid = Signal(name="newest_valid")
        newest_starts_line, newest_starts = (
            Signal(name=name, reset_less=True) for name in ("newest_starts_line", "newest_starts")
        )
        newest_lined = Signal(name="newest_lined", reset_less=True)
        m.d.comb += arriving.eq(Cat(centre_above, centre, Mux(flush, centre, look(value))))
        with m.If(moves):
            m.d.sync += newest_valid.eq(step & good & lined | newest_valid & ~step & ~line_starts & ~halts)
        with m.If(step):
            m.d.sync += [
                newest.eq(arriving),
                newest_value.eq(centre_value),
                newest_starts_line.eq(line_starts),
                newest_starts.eq(lined & ~newest_lined),
                newest_lined.eq(lined),
            ]
        left, middle, right = (
            Signal(SIDE * depth, name=name, reset_less=True) for name in ("left", "middle", "right")
        )
        middle_value = Signal(len(value), name="middle_value", reset_less=True)
        middle_valid = Signal(name="middle_valid")
        middle_starts, middle_ends = (
            Signal(name=name, reset_less=True) for name in ("middle_starts", "middle_ends")
        )
        with m.If(moves):
            m.d.sync += middle_valid.eq(newest_valid & (line_starts | (step & good)))
        with m.If(moves & (line_starts | step)):
            m.d.sync += [
                right.eq(Mux(line_starts, newest, arriving)),
                middle.eq(newest),
                left.eq(Mux(newest_starts_line, newest, middle)),
                middle_value.eq(newest_value),
                middle_starts.eq(newest_starts),
                middle_ends.eq(line_starts),
            ]
        sides = (left, middle, right)
        m.d.comb += windows.eq(Cat(*(side.word_select(row, depth) for row in range(SIDE) for side in sides)))
        edge = _output(self.window)
        if self.video.answer == "edge":
            answer = edge.replicate(ANSWER_BITS)
        else:
            answer = Cat(middle_value, Const(0, ANSWER_BITS - 1 - len(middle_value)), edge)
        with m.If(moves):
            m.d.sync += [
                self.m_axis_video_tvalid.eq(middle_valid),
                self.m_axis_video_tuser.eq(middle_starts),
                self.m_axis_video_tlast.eq(middle_ends),
                self.m_axis_video_tdata.eq(answer),
            ]


def _stream(name: str, width: int, forward: Any, back: Any) -> dict[str, Any]:
    """The members of a stream."""
    return {
        f"{name}_tdata": forward(width),
        f"{name}_tvalid": forward(1),
        f"{name}_tready": back(1),
        f"{name}_tuser": forward(1),
        f"{name}_tlast": forward(1),
    }


def _output(part: Part) -> Value:
    """The one output of a circuit."""
    (name,) = (name for name, member in part.signature.members.items() if member.flow == Out)
    value: Value = getattr(part, name)
    return value


def _register(m: Module, name: str, value: Value) -> Signal:
    later = Signal(len(value), name=name, reset_less=True)
    m.d.sync += later.eq(value)
    return later
