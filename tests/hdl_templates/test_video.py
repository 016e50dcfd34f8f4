# amaranth: UnusedElaboratable=no
"""Video cores: whole frames are answered exactly, malformed ones as far as they were whole."""

import random
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator
from numpy.typing import NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.video import VideoCore
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.video import Answer
from wnn2hdl.ir.window import framed_window_codes

Beat = tuple[int, int, int]
"""TDATA, TUSER, TLAST."""

WIDTH = 8
"""Of the memories."""

PATTERNS = np.random.default_rng(0).random(512) < 0.5
"""An edge filter that depends on each of its inputs."""


def delayed(m: Module, value: Any, cycles: int) -> Any:
    for _ in range(cycles):
        later = Signal(len(value), reset_less=True)
        m.d.sync += later.eq(value)
        value = later
    return value


class Pixel(Part):
    """The high bits of red as a class, or as another port, ``latency`` cycles later."""

    def __init__(self, width: int, latency: int, port: str = "class_bits") -> None:
        self.module_name, self.width, self.latency, self.port = "pixel", width, latency, port
        super().__init__({"rgb": In(24), port: Out(width)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        high = delayed(m, self.rgb[24 - self.width :], self.latency)
        m.d.comb += getattr(self, self.port).eq(high)
        return m


class Window(Part):
    """`PATTERNS` as a look-up table, ``latency`` cycles later."""

    module_name = "window"

    def __init__(self, latency: int) -> None:
        self.latency = latency
        super().__init__({"bits": In(9), "edge_bit": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        value = Signal()
        with m.Switch(self.bits):
            for code in np.flatnonzero(PATTERNS).tolist():
                with m.Case(code):
                    m.d.comb += value.eq(1)
        m.d.comb += self.edge_bit.eq(delayed(m, value, self.latency))
        return m


def core(answer: Answer = "both", *, classes: int = 1, latency: int = 0, pixels: int = 1) -> VideoCore:
    video = VideoFormat(max_width=WIDTH * pixels, answer=answer, pixels_per_clock=pixels)
    return VideoCore(
        video=video,
        pixels=[Pixel(classes, latency) for _ in range(pixels)],
        windows=[Window(latency) for _ in range(pixels)] if video.has_edges else [],
    )


def frame(height: int, width: int, seed: int) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)


def marked(words: Any, bits: int, per_clock: int) -> list[Beat]:
    """Words of pixels as beats; the last column is repeated up to whole beats."""
    rows = [[*row, *[row[-1]] * (-len(row) % per_clock)] for row in words.tolist()]
    return [
        (
            sum(word << bits * place for place, word in enumerate(row[x : x + per_clock])),
            int(y == x == 0),
            int(x + per_clock == len(row)),
        )
        for y, row in enumerate(rows)
        for x in range(0, len(row), per_clock)
    ]


def sent(pixels: NDArray[np.uint8], per_clock: int = 1) -> list[Beat]:
    return marked(VideoFormat().pixels(pixels), 24, per_clock)


def answers(
    pixels: NDArray[np.uint8], answer: Answer = "both", classes: int = 1, per_clock: int = 1
) -> list[Beat]:
    pixels = VideoFormat(pixels_per_clock=per_clock).padded(pixels)
    found = pixels[..., 0] >> np.uint8(8 - classes)
    edges = PATTERNS[framed_window_codes(found != 0)]
    return marked(
        VideoFormat(answer=answer).answers(found, edges if answer != "class" else None), 8, per_clock
    )


def run(
    dut: VideoCore,
    beats: Sequence[Beat | None],
    *,
    height: int = 0,
    offers: float = 0.7,
    takes: float = 0.7,
    cycles: int = 0,
    patience: int = 40,
    squares: list[Beat] | None = None,
) -> tuple[list[Beat], int]:
    """What comes out of a core for the beats, and after how many cycles all were taken; None is a reset.

    It runs until nothing has moved for ``patience`` cycles, or for ``cycles``. What comes of squares is put
    in a list.
    """
    draw = random.Random(0)
    found: list[Beat] = []
    took = 0

    async def bench(ctx: Any) -> None:
        nonlocal took
        if dut.has_lines:
            ctx.set(dut.height, height)
        left = [None, *beats][::-1]
        offered, held, waiting, idle, cycle = False, None, None, 0, 0
        while idle < patience and (not cycles or cycle < cycles):
            resets = bool(left) and left[-1] is None
            if resets:
                left.pop()
                offered, held = False, None
            ctx.set(dut.aresetn, not resets)
            if left and left[-1] is not None and not offered and not resets and draw.random() < offers:
                for name, value in zip(("tdata", "tuser", "tlast"), left[-1], strict=True):
                    ctx.set(getattr(dut, f"s_axis_video_{name}"), value)
                offered = True
            ready = draw.random() < takes
            ctx.set(dut.s_axis_video_tvalid, offered)
            ctx.set(dut.m_axis_video_tready, ready)
            if squares is not None:
                ctx.set(dut.m_axis_squares_tready, takes_square := draw.random() < takes)
                square = tuple(
                    ctx.get(getattr(dut, f"m_axis_squares_{name}")) for name in ("tdata", "tuser", "tlast")
                )
                offers_square = bool(ctx.get(dut.m_axis_squares_tvalid))
                assert waiting is None or (offers_square and square == waiting)
                waiting = square if offers_square and not takes_square and not resets else None
                if offers_square and takes_square and not resets:
                    squares.append(square)
            valid = bool(ctx.get(dut.m_axis_video_tvalid))
            now = tuple(ctx.get(getattr(dut, f"m_axis_video_{name}")) for name in ("tdata", "tuser", "tlast"))
            assert held is None or (valid and now == held), "a beat was offered, then changed or withdrawn"
            held = now if valid and not ready and not resets else None
            given = valid and ready and not resets
            if given:
                found.append(now)
            taken = offered and bool(ctx.get(dut.s_axis_video_tready)) and not resets
            if taken:
                left.pop()
                offered, took = False, cycle + 1
            idle = 0 if taken or given or resets or left else idle + 1
            cycle += 1
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
    return found, took


FRAMES = [frame(4, 5, 1), frame(4, 8, 2), frame(1, 3, 3), frame(3, 1, 4), frame(2, 2, 5), frame(4, 5, 6)]


@pytest.mark.parametrize("answer", ["class", "edge", "both"])
@pytest.mark.parametrize("latency", [0, 1, 3])
@pytest.mark.parametrize("per_clock", [1, 2, 4])
def test_frames_of_several_sizes_pass_with_pauses(answer: Answer, latency: int, per_clock: int) -> None:
    beats = [beat for pixels in FRAMES for beat in sent(pixels, per_clock)]
    found, _ = run(core(answer, latency=latency, pixels=per_clock), beats, height=4)
    assert found == [beat for pixels in FRAMES for beat in answers(pixels, answer, per_clock=per_clock)]


def test_an_edge_looks_at_foreground_and_the_class_is_sent_whole() -> None:
    pixels = frame(5, 7, 0)
    found, _ = run(core(classes=2), sent(pixels), height=5)
    assert found == answers(pixels, classes=2)
    assert {data & 3 for data, _, _ in found} == {0, 1, 2, 3}


@pytest.mark.parametrize("latency", [0, 2])
def test_a_pixel_passes_in_each_cycle_and_the_last_line_takes_as_long_as_a_line(latency: int) -> None:
    pixels = frame(6, 8, 0)
    beats = sent(pixels) + sent(pixels)
    found, took = run(core(latency=latency), beats, height=6, offers=1, takes=1)
    assert found == answers(pixels) * 2
    # One cycle of reset, the repeated line below the first frame's last, and until its end is noticed.
    assert took == 1 + len(beats) + 8 + 4


def test_the_last_line_comes_out_without_another_frame() -> None:
    assert run(core(), sent(FRAMES[0]), height=4)[0] == answers(FRAMES[0])


def test_without_a_height_a_frame_ends_where_the_next_begins() -> None:
    last = answers(FRAMES[1])
    assert run(core(), sent(FRAMES[0]) + sent(FRAMES[1]))[0] == answers(FRAMES[0]) + last[: -len(last) // 4]


def test_lines_beyond_the_height_are_left_out() -> None:
    tall = frame(6, 5, 0)
    beats = sent(tall) + sent(FRAMES[0])
    assert run(core(), beats, height=4)[0] == answers(tall[:4]) + answers(FRAMES[0])


def short(beats: list[Beat]) -> list[Beat]:
    """The third line ends a pixel early."""
    return [*beats[:13], (beats[13][0], 0, 1), *beats[15:]]


def long(beats: list[Beat]) -> list[Beat]:
    """The third line has a pixel more."""
    return [*beats[:14], (beats[14][0], 0, 0), *beats[14:]]


def broken_off(beats: list[Beat]) -> list[Beat]:
    """The frame ends inside its third line."""
    return beats[:13]


@pytest.mark.parametrize(("malform", "good"), [(short, 13), (long, 14), (broken_off, 13)])
def test_a_malformed_frame_is_answered_as_far_as_it_was_whole_and_the_next_exactly(
    malform: Any, good: int
) -> None:
    pixels, after = frame(4, 5, 7), frame(4, 6, 8)
    found, _ = run(core(), malform(sent(pixels)) + sent(after), height=4)
    # A pixel needs the next line up to its right neighbour.
    assert found == answers(pixels)[: good - 5 - 1] + answers(after)


def test_a_first_line_longer_than_the_memory_is_thrown_away() -> None:
    pixels = frame(3, WIDTH + 1, 0)
    assert run(core(), sent(pixels) + sent(FRAMES[0]), height=4)[0] == answers(FRAMES[0])


def test_pixels_before_a_first_frame_are_thrown_away() -> None:
    stray = [(data, 0, last) for data, _, last in sent(frame(2, 3, 0))][:-1]
    assert run(core(), stray + sent(FRAMES[0]), height=4)[0] == answers(FRAMES[0])


@pytest.mark.parametrize("at", [3, 11, 19])
def test_a_reset_in_the_middle_forgets_the_frame(at: int) -> None:
    pixels, after = frame(4, 5, 9), frame(4, 3, 10)
    found, _ = run(core(), [*sent(pixels)[:at], None, *sent(after)], height=4)
    before = len(found) - len(answers(after))
    assert found[before:] == answers(after)
    assert found[:before] == answers(pixels)[:before]


def test_any_mix_of_frames_and_faults_leaves_the_next_frame_whole() -> None:
    draw = random.Random(1)
    beats: list[Beat] = []
    expected: list[Beat] = []
    for seed in range(60):
        pixels = frame(4, draw.randint(2, WIDTH), seed)
        whole, width = sent(pixels), pixels.shape[1]
        cut = draw.randint(1, len(whole) - 1)
        # A frame that stops at the end of a line is a frame of fewer lines.
        if draw.random() < 0.5 and cut % width:
            beats += whole[:cut]
            expected += answers(pixels)[: max(0, cut - width - 1)]
        else:
            beats += whole
            expected += answers(pixels)
    beats += sent(FRAMES[0])
    assert run(core(), beats, height=4)[0] == expected + answers(FRAMES[0])


def test_a_core_has_a_window_for_each_pixel_if_it_sends_edges() -> None:
    one, video = [Pixel(1, 0)], VideoFormat()
    for wrong, windows in ((video, []), (VideoFormat(answer="class"), [Window(0)])):
        with pytest.raises(ValueError, match="for each"):
            VideoCore(video=wrong, pixels=one, windows=windows)
    with pytest.raises(ValueError, match="for each"):
        VideoCore(video=VideoFormat(pixels_per_clock=2), pixels=one, windows=[Window(0)])
