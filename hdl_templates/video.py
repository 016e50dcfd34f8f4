# amaranth: UnusedElaboratable=no
"""Video cores: circuits of pixels and of windows between two streams of AXI4-Stream Video (AMD UG934).

A stream carries one, two or four pixels a beat, the left one lowest, frames row by row: TUSER marks the first
beat of a frame, TLAST the last of a line. A core classifies each pixel once, as it comes in. What looks at a
3x3 window reads the answers, one bit each, of the two lines before from a block RAM, not the pixels; see
`hdl_templates.scan`. Where the model looks at the pixels around a pixel, there are two such scans: the first
one is of the few bits that are found of each pixel, and the windows of these have its class.

Beyond the picture the nearest pixel inside is repeated, as in `wnn2hdl.ir.window.framed_window_codes`. A line
has whole beats: where a picture is narrower, the sender repeats its last pixel, which is the same border.

A frame is the lines up to the next TUSER, but no more than the input ``height`` says; all are as long as the
first one. After the last of ``height`` lines, or where the next TUSER comes before, the core takes no pixels
for as many cycles as a line has beats, and a few more, in which the last line of answers comes out; for as
many lines as a neighbourhood reaches below its middle.

A frame is given up where it turns out malformed: at a line that is shorter or longer than the first, a first
line that is longer than the memory, or a TUSER inside a line. The answers that are complete by then stand;
there are no more, and the pixels before the next TUSER are thrown away. What follows is as after a reset.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from amaranth.hdl import Cat, Const, Module, ResetInserter, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.across import Windows, across
from hdl_templates.counting import Counted, Counting, count_around
from hdl_templates.hierarchy import Part, place
from hdl_templates.interfaces import vivado_interfaces
from hdl_templates.scan import Pixels, scan
from hdl_templates.squares import Squares, majorities
from hdl_templates.stream import queued, registered
from wnn2hdl.ir import CHANNELS, WINDOW_BITS, VideoFormat
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS
from wnn2hdl.ir.video import ANSWER_BITS, HEIGHT_BITS
from wnn2hdl.ir.window import SIDE


@dataclass(frozen=True)
class Neighbours:
    """How a pixel is classified by what was found of the pixels around it.

    Attributes:
        size: rows and columns of the window, odd.
        taps: for each bit of a code which bit of a pixel's value it is, and the row and the column of the
            pixel in the window.
        parts: the circuit of a code, once for each pixel of a beat: one input, and one output, the class.
    """

    size: int
    taps: Sequence[tuple[int, int, int]]
    parts: Sequence[Part]

    @property
    def seen(self) -> list[tuple[int, int]]:
        """The different bits of columns that are seen: of a value, and how many lines above the newest."""
        return sorted({(bit, self.size - 1 - row) for bit, row, _ in self.taps})

    def kept(self, bits: int) -> list[int]:
        """For each of the bits of a value how many lines above the newest one are kept.

        At least one, which is repeated below the last.
        """
        return [max(1, *(line for seen, line in self.seen if seen == bit)) for bit in range(bits)]


@dataclass(frozen=True)
class EdgeLines:
    """What is kept of the lines above, for windows of edges.

    Attributes:
        depth: bits of a value that windows see, its highest ones; 0 where there are no windows.
        sends: bits that are sent of it, its lowest ones.
        kept: for each of its bits how many lines above the newest one are kept.
        is_reduced: whether windows see only whether a value is not 0, in one more bit of it.
    """

    depth: int
    sends: int
    kept: list[int]
    is_reduced: bool


class VideoCore(Part):
    """A video core.

    Args:
        video: what goes in and what comes out.
        pixels: the circuit of a pixel, once for each pixel of a beat: the input ``rgb`` and one output, its
            value: its class, or what there is to find of it with ``neighbours``.
        windows: likewise the circuit of a 3x3 window of such values, or of one bit each that says whether the
            value is not 0: one input, and one output of one bit. None where no edge is asked for.
        neighbours: how classes follow from the pixels around a pixel; None where each has its own.
        classes: how many there are, for squares.

    Members:
        aresetn: In, synchronous reset, active low.
        height: In, the most lines of a frame, read while none passes; 0 means 4096. It has to stand three
            cycles before a frame's first beat. Only where the core keeps lines.
        s_axis_video_*: the stream of pixels.
        m_axis_video_*: the stream of answers.
        m_axis_squares_*: the stream of the majorities of squares, one a beat, as a frame for each frame. Only
            where squares are sent.

    Raises:
        ValueError: there are other circuits than these.
    """

    clocked = True
    clock = "aclk"
    module_name = "video"

    def __init__(
        self,
        *,
        video: VideoFormat,
        pixels: Sequence[Part],
        windows: Sequence[Part],
        neighbours: Neighbours | Counting | None = None,
        classes: int = 2,
    ) -> None:
        wanted = video.pixels_per_clock
        if (
            len(pixels) != wanted
            or len(windows) != wanted * video.has_edges
            or (neighbours is not None and len(neighbours.parts) != wanted)
        ):
            raise ValueError(
                "a core needs a circuit for each pixel of a beat, and one for each edge it sends"
            )
        self.video, self.neighbours = video, neighbours
        self.squares = None if video.square is None else Squares(video.square, classes)
        self.pixels, self.windows = tuple(pixels), tuple(windows)
        members = {
            "aresetn": In(1),
            "height": In(HEIGHT_BITS),
            **_stream("s_axis_video", video.pixel_bits * len(pixels), In, Out),
            **_stream("m_axis_video", ANSWER_BITS * len(pixels), Out, In),
            **(_stream("m_axis_squares", ANSWER_BITS, Out, In) if self.squares else {}),
        }
        super().__init__(
            {name: member for name, member in members.items() if name != "height" or self.has_lines}
        )

    @property
    def has_lines(self) -> bool:
        """Whether it keeps lines, and so counts them."""
        return bool(self.windows) or self.neighbours is not None or self.squares is not None

    @property
    def places(self) -> int:
        """Words of the memory, a power of two, at least 2, so that there are addresses."""
        return 1 << (max(self.video.beats_of(self.video.max_width), 2) - 1).bit_length()

    @property
    def marks_lines(self) -> bool:
        """Whether classes pass another scan: for edges, or to know the last line of a frame."""
        return bool(self.windows) or (self.squares is not None and self.neighbours is None)

    def edge_lines(self, bits: int) -> EdgeLines:
        """What that scan keeps of values of so many bits."""
        depth = len(input_of(self.windows[0])) // WINDOW_BITS if self.windows else 0
        sends = 0 if self.video.answer == "edge" and not self.squares else bits
        # What is sent is kept of the line in the middle, what windows see of two lines.
        if depth in (0, bits):
            return EdgeLines(depth, sends, [2 if depth else 1] * bits, is_reduced=False)
        return EdgeLines(depth, sends, [1] * sends + [2], is_reduced=True)

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        what = {"class": "classes", "edge": "edges", "both": "classes and edges"}[self.video.answer]
        rate = "a pixel" if len(self.pixels) == 1 else f"{len(self.pixels)} pixels"
        lines = f", of lines of up to {self.video.max_width} pixels" if self.has_lines else ""
        return f"AXI4-Stream Video: {what}, {rate} per clock{lines}."

    @property
    def streams(self) -> tuple[str, ...]:
        """What the names of the ports of its streams begin with."""
        return ("s_axis_video", "m_axis_video", *(["m_axis_squares"] if self.squares else []))

    @property
    def port_attributes(self) -> Mapping[str, Mapping[str, str]]:
        """See `Part.port_attributes`."""
        return vivado_interfaces(self, streams=self.streams)

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
        taken = Signal(name="taken")
        stream = {
            "valid": self.s_axis_video_tvalid,
            "ready": self.s_axis_video_tready,
            "word": Cat(*_delayed(m, "pixels", latency, start, last), *map(output_of, self.pixels)),
            "taken": taken,
        }
        # What keeps lines moves by registers alone, so a place for one beat is enough.
        if self.has_lines and not latency:
            head = registered(m, "pixels", **stream)
        else:
            head = queued(m, "pixels", latency=latency, **stream)
        pixels = Pixels(head.valid, head.word[0], head.word[1], None, _split(head.word[2:], self.pixels))
        if self.neighbours is not None:
            pixels, taken = self._look_around(m, pixels, taken, self.neighbours, reset, platform)
        if self.marks_lines:
            self._find_edges(m, pixels, taken, reset, platform)
        else:
            room = self._vote(m, pixels, self.m_axis_video_tready)
            m.d.comb += taken.eq(self.m_axis_video_tready & room)
            self._answer(m, pixels.valid & room, pixels.start, pixels.last, pixels.values)
        return ResetInserter(reset)(m)

    def _look_around(
        self,
        m: Module,
        pixels: Pixels,
        taken: Signal,
        neighbours: Neighbours | Counting,
        reset: Value,
        platform: object,
    ) -> tuple[Pixels, Signal]:
        """The classes of pixels by what was found of them and their neighbours, and who is to take them."""
        reach, advances = neighbours.size // 2, Signal(name="near_advances")
        columns = scan(
            m,
            "near_",
            pixels,
            reach=reach,
            kept=neighbours.kept(len(pixels.values[0])),
            places=self.places,
            height=self.height,
            reset=reset,
            moves=advances,
            taken=taken,
        )
        moves = Signal(name="near_moves")
        if isinstance(neighbours, Counting):
            counted = count_around(
                m, "near_", columns, neighbours, advances=advances, moves=moves, platform=platform
            )
            (part,) = neighbours.parts
            place(m, "decision", part, platform)
            m.d.comb += input_of(part).eq(Cat(counted.own, *counted.counts))
            return self._classes(m, counted, neighbours.parts, moves)
        m.d.comb += advances.eq(moves)
        seen = neighbours.seen
        words = [Cat(*(bits[bit][line] for bit, line in seen)) for bits in columns.bits]
        found = across(m, "near_", columns, words, (), reach=reach, moves=moves)
        for number, (part, window) in enumerate(zip(neighbours.parts, found.words, strict=True)):
            place(m, f"decision_{number}", part, platform)
            code = [
                window[column][seen.index((bit, 2 * reach - row))] for bit, row, column in neighbours.taps
            ]
            m.d.comb += input_of(part).eq(Cat(*code))
        return self._classes(m, found, neighbours.parts, moves)

    def _classes(
        self, m: Module, found: Windows | Counted, parts: Sequence[Part], moves: Signal
    ) -> tuple[Pixels, Signal]:
        """The queue of classes, and who is to take them."""
        latency = parts[0].latency
        marks = _delayed(m, "classes", latency, found.start, found.last, found.final)
        leaves = Signal(name="classes_taken")
        head = queued(
            m,
            "classes",
            valid=found.valid,
            ready=moves,
            word=Cat(*marks, *map(output_of, parts)),
            latency=latency,
            taken=leaves,
        )
        start, last, final = head.word[:3]
        return Pixels(head.valid, start, last, final, _split(head.word[3:], parts)), leaves

    def _vote(self, m: Module, beat: Pixels, room: Value) -> Value:
        """Let squares count a beat that is offered; returns whether they can."""
        if self.squares is None:
            return Const(1, 1)
        ready = Signal(name="squares_ready")
        head = majorities(
            m,
            self.squares,
            beat,
            places=self.places,
            room=room,
            ready=ready,
            taken=self.m_axis_squares_tready,
        )
        m.d.comb += [
            self.m_axis_squares_tvalid.eq(head.valid),
            Cat(self.m_axis_squares_tuser, self.m_axis_squares_tlast, self.m_axis_squares_tdata).eq(
                head.word
            ),
        ]
        return ready

    def _find_edges(self, m: Module, pixels: Pixels, taken: Signal, reset: Value, platform: object) -> None:
        """The edges between pixels, if there are any, and the answers; frames whose last line is marked."""
        lines = self.edge_lines(len(pixels.values[0]))
        depth, sends, looks = lines.depth, lines.sends, len(lines.kept)
        values = pixels.values
        if lines.is_reduced:
            values = [Cat(value[:sends], value.any()) for value in values]
        moves, room = Signal(name="moves"), Signal(name="answers_ready")
        columns = scan(
            m,
            "",
            replace(pixels, values=values),
            reach=1,
            kept=lines.kept,
            places=self.places,
            height=self.height if pixels.final is None else None,
            reset=reset,
            moves=moves,
            taken=taken,
        )
        words = [
            Cat(*(bits[bit][line] for line in reversed(range(SIDE)) for bit in range(looks - depth, looks)))
            for bits in columns.bits
        ]
        sent = [Cat(*(bits[bit][1] for bit in range(sends))) for bits in columns.bits if sends]
        beat = across(m, "", columns, words, sent, reach=1, moves=moves)
        for number, part in enumerate(self.windows):
            place(m, f"window_{number}", part, platform)
            rows = [column.word_select(row, depth) for row in range(SIDE) for column in beat.words[number]]
            m.d.comb += input_of(part).eq(Cat(*rows))
        passing = Pixels(beat.valid, beat.start, beat.last, beat.final, beat.sent)
        counted = self._vote(m, passing, room)
        m.d.comb += moves.eq(room & counted)
        latency = self.windows[0].latency if self.windows else 0
        delayed = _delayed(m, "answers", latency, beat.start, beat.last, *beat.sent)
        answers = queued(
            m,
            "answers",
            valid=beat.valid & counted,
            ready=room,
            word=Cat(*delayed, *map(output_of, self.windows)),
            latency=latency,
            taken=self.m_axis_video_tready,
        )
        start, last, found = answers.word[0], answers.word[1], answers.word[2:]
        edges = found[len(found) - len(self.windows) :]
        if self.video.answer == "class":
            answered = [found.word_select(number, sends) for number in range(len(self.pixels))]
        elif self.video.answer == "edge":
            answered = [edge.replicate(ANSWER_BITS) for edge in edges]
        else:
            answered = [
                Cat(found.word_select(number, sends), Const(0, ANSWER_BITS - 1 - sends), edge)
                for number, edge in enumerate(edges)
            ]
        self._answer(m, answers.valid, start, last, answered)

    def _rgb(self, word: Value) -> Value:
        """The pixel that a word of the stream stands for, as its circuit reads it."""
        if self.video.is_mono:
            return word.replicate(len(CHANNELS))
        channels = {
            channel: word.word_select(place, CHANNEL_BITS) for place, channel in enumerate(self.video.format)
        }
        return Cat(*(channels[channel] for channel in reversed(CHANNELS)))

    def _answer(self, m: Module, valid: Value, start: Value, last: Value, values: Sequence[Value]) -> None:
        m.d.comb += [
            self.m_axis_video_tvalid.eq(valid),
            self.m_axis_video_tuser.eq(start),
            self.m_axis_video_tlast.eq(last),
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


def _split(words: Value, parts: Sequence[Part]) -> list[Value]:
    """The words side by side that came out of circuits."""
    return [words.word_select(number, len(output_of(part))) for number, part in enumerate(parts)]


def input_of(part: Part) -> Value:
    """The one input of a circuit of a core."""
    return _member(part, In)


def output_of(part: Part) -> Value:
    """The one output of a circuit of a core."""
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
