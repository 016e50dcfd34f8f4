# amaranth: UnusedElaboratable=no
"""Video cores: circuits of pixels and of windows between two streams of AXI4-Stream Video (AMD UG934).

A stream carries one, two or four pixels a beat, the left one lowest, frames row by row: TUSER marks the first
beat of a frame, TLAST the last of a line. A core classifies each pixel once, as it comes in. What looks at a
3x3 window reads the answers, one bit each, of the two lines before from a block RAM, not the pixels; see
`hdl_templates.scan`.

Beyond the picture the nearest pixel inside is repeated, as in `wnn2hdl.ir.window.framed_window_codes`. A line
has whole beats: where a picture is narrower, the sender repeats its last pixel, which is the same border.

A frame is the lines up to the next TUSER, but no more than the input ``height`` says; all are as long as the
first one. After the last of ``height`` lines, or where the next TUSER comes before, the core takes no pixels
for as many cycles as a line has beats, and a few more, in which the last line of answers comes out.

A frame is given up where it turns out malformed: at a line that is shorter or longer than the first, a first
line that is longer than the memory, or a TUSER inside a line. The answers that are complete by then stand;
there are no more, and the pixels before the next TUSER are thrown away. What follows is as after a reset.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from amaranth.hdl import Cat, Const, Module, ResetInserter, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part, place
from hdl_templates.scan import HEIGHT_BITS, scan
from hdl_templates.stream import queued
from wnn2hdl.ir import CHANNELS, WINDOW_BITS, VideoFormat
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS
from wnn2hdl.ir.video import ANSWER_BITS


class VideoCore(Part):
    """A video core.

    Args:
        video: what goes in and what comes out.
        pixels: the circuit of a pixel, once for each pixel of a beat: the input ``rgb`` and one output, its
            value.
        windows: likewise the circuit of a 3x3 window of such values, or of one bit each that says whether the
            value is not 0: one input, and one output of one bit. None where no edge is asked for.

    Members:
        aresetn: In, synchronous reset, active low.
        height: In, the most lines of a frame, read while none passes; 0 means 4096. It has to stand three
            cycles before a frame's first beat. Only where edges are sent.
        s_axis_video_*: the stream of pixels.
        m_axis_video_*: the stream of answers.

    Raises:
        ValueError: there are other circuits than these.
    """

    clocked = True
    clock = "aclk"
    module_name = "video"

    def __init__(self, *, video: VideoFormat, pixels: Sequence[Part], windows: Sequence[Part]) -> None:
        if len(pixels) != video.pixels_per_clock or len(windows) != video.pixels_per_clock * video.has_edges:
            raise ValueError(
                "a core needs a circuit for each pixel of a beat, and one for each edge it sends"
            )
        self.video, self.pixels, self.windows = video, tuple(pixels), tuple(windows)
        members = {
            "aresetn": In(1),
            "height": In(HEIGHT_BITS),
            **_stream("s_axis_video", video.pixel_bits * len(pixels), In, Out),
            **_stream("m_axis_video", ANSWER_BITS * len(pixels), Out, In),
        }
        super().__init__({name: member for name, member in members.items() if name != "height" or windows})

    @property
    def places(self) -> int:
        """Words of the memory, a power of two: the longest line has as many beats."""
        return 1 << (self.video.beats_of(self.video.max_width) - 1).bit_length()

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        what = {"class": "classes", "edge": "edges", "both": "classes and edges"}[self.video.answer]
        rate = "a pixel" if len(self.pixels) == 1 else f"{len(self.pixels)} pixels"
        lines = f", of lines of up to {self.video.max_width} pixels" if self.windows else ""
        return f"AXI4-Stream Video: {what}, {rate} per clock{lines}."

    @property
    def port_attributes(self) -> Mapping[str, Mapping[str, str]]:
        """See `Part.port_attributes`: what groups the ports in Vivado's IP Integrator (AMD UG1118)."""
        streams = ("s_axis_video", "m_axis_video")
        reset, axis = "xilinx.com:signal:reset:1.0", "xilinx.com:interface:axis:1.0"
        return {
            self.clock: {
                "X_INTERFACE_INFO": f"xilinx.com:signal:clock:1.0 {self.clock} CLK",
                "X_INTERFACE_PARAMETER": f"ASSOCIATED_BUSIF {':'.join(streams)}, ASSOCIATED_RESET aresetn",
            },
            "aresetn": {
                "X_INTERFACE_INFO": f"{reset} aresetn RST",
                "X_INTERFACE_PARAMETER": "POLARITY ACTIVE_LOW",
            },
            **{
                port: {"X_INTERFACE_INFO": f"{axis} {stream} {port.removeprefix(f'{stream}_').upper()}"}
                for stream in streams
                for port in _stream(stream, 1, In, Out)
            },
        }

    def elaborate(self, platform: object) -> Any:
        """The classifiers and their queue; behind it the windows, or nothing; the queue of answers."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        words = self.s_axis_video_tdata
        for number, part in enumerate(self.pixels):
            place(m, f"classifier_{number}", part, platform)
            m.d.comb += part.rgb.eq(self._rgb(words.word_select(number, self.video.pixel_bits)))
        latency = self.pixels[0].latency
        start, last = self.s_axis_video_tuser, self.s_axis_video_tlast
        taken, moves = Signal(name="taken"), Signal(name="moves")
        head = queued(
            m,
            "pixels",
            valid=self.s_axis_video_tvalid,
            ready=self.s_axis_video_tready,
            word=Cat(*_delayed(m, "pixels", latency, start, last), *map(_output, self.pixels)),
            latency=latency,
            taken=taken,
        )
        if not self.windows:
            values = [
                head.word[2:].word_select(number, len(_output(part)))
                for number, part in enumerate(self.pixels)
            ]
            m.d.comb += taken.eq(self.m_axis_video_tready)
            self._answer(m, head.valid, head.word[:2], values)
            return ResetInserter(reset)(m)

        depth = len(_input(self.windows[0])) // WINDOW_BITS
        beat = scan(
            m,
            head,
            pixels=len(self.pixels),
            depth=depth,
            places=self.places,
            height=self.height,
            reset=reset,
            moves=moves,
            taken=taken,
        )
        for number, (part, window) in enumerate(zip(self.windows, beat.windows, strict=True)):
            place(m, f"window_{number}", part, platform)
            m.d.comb += _input(part).eq(window)
        latency = self.windows[0].latency
        sent = [] if self.video.answer == "edge" else beat.values
        answers = queued(
            m,
            "answers",
            valid=beat.valid,
            ready=moves,
            word=Cat(
                *_delayed(m, "answers", latency, beat.start, beat.last, *sent), *map(_output, self.windows)
            ),
            latency=latency,
            taken=self.m_axis_video_tready,
        )
        edges = answers.word[-len(self.windows) :]
        if self.video.answer == "edge":
            values = [edge.replicate(ANSWER_BITS) for edge in edges]
        else:
            bits = len(beat.values[0])
            values = [
                Cat(answers.word[2:].word_select(number, bits), Const(0, ANSWER_BITS - 1 - bits), edge)
                for number, edge in enumerate(edges)
            ]
        self._answer(m, answers.valid, answers.word[:2], values)
        return ResetInserter(reset)(m)

    def _rgb(self, word: Value) -> Value:
        """The pixel that a word of the stream stands for, as its circuit reads it."""
        if self.video.is_mono:
            return word.replicate(len(CHANNELS))
        channels = {
            channel: word.word_select(place, CHANNEL_BITS) for place, channel in enumerate(self.video.format)
        }
        return Cat(*(channels[channel] for channel in reversed(CHANNELS)))

    def _answer(self, m: Module, valid: Value, marks: Value, values: Sequence[Value]) -> None:
        m.d.comb += [
            self.m_axis_video_tvalid.eq(valid),
            self.m_axis_video_tuser.eq(marks[0]),
            self.m_axis_video_tlast.eq(marks[1]),
            *(
                self.m_axis_video_tdata.word_select(number, ANSWER_BITS).eq(value)
                for number, value in enumerate(values)
            ),
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


def _input(part: Part) -> Value:
    """The one input of a circuit."""
    return _member(part, In)


def _output(part: Part) -> Value:
    """The one output of a circuit."""
    return _member(part, Out)


def _member(part: Part, flow: Any) -> Value:
    (name,) = (name for name, member in part.signature.members.items() if member.flow == flow)
    value: Value = getattr(part, name)
    return value


def _delayed(m: Module, name: str, cycles: int, *values: Value) -> tuple[Value, ...]:
    """The values so many cycles later."""
    for cycle in range(1, cycles + 1):
        later = [
            Signal(len(value), name=f"{name}_{cycle}_{i}", reset_less=True) for i, value in enumerate(values)
        ]
        m.d.sync += [after.eq(before) for after, before in zip(later, values, strict=True)]
        values = tuple(later)
    return values
