# amaranth: UnusedElaboratable=no
"""Video cores of neighbourhoods: classes by the pixels around a pixel, and edges between these."""

import random
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib.wiring import In, Out
from numpy.typing import NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.video import Neighbours, VideoCore
from tests.hdl_templates.test_video import (
    PATTERNS,
    WIDTH,
    Beat,
    Pixel,
    Window,
    broken_off,
    delayed,
    frame,
    long,
    marked,
    run,
    sent,
    short,
)
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.video import Answer
from wnn2hdl.ir.window import framed_window_codes

BITS = 3
"""Found of each pixel: the highest bits of red."""

TAPS = {
    # The middle, two in a corner, and the ends of a row and of a column.
    3: ((0, 1, 1), (1, 0, 0), (2, 0, 0), (0, 2, 1), (2, 1, 2)),
    5: ((0, 2, 2), (1, 0, 0), (2, 4, 4), (0, 0, 4), (1, 3, 0)),
    7: ((0, 3, 3), (1, 0, 0), (2, 6, 6), (0, 0, 6), (1, 4, 0)),
}

TABLE = np.random.default_rng(1).permutation(np.arange(32) % 3).astype(np.uint8)
"""The class of a code."""


class Decision(Part):
    """`TABLE`, ``latency`` cycles later; 0 and others alone if there is one bit for it."""

    module_name = "decision"

    def __init__(self, latency: int, width: int) -> None:
        self.latency, self.width = latency, width
        super().__init__({"code": In(5), "class_bits": Out(width)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        value = Signal(self.width)
        with m.Switch(self.code):
            for code, answer in enumerate(TABLE.tolist()):
                with m.Case(code):
                    m.d.comb += value.eq(answer if self.width > 1 else answer > 0)
        m.d.comb += self.class_bits.eq(delayed(m, value, self.latency))
        return m


def core(size: int, answer: Answer, *, latency: int = 0, pixels: int = 1, width: int = 2) -> VideoCore:
    video = VideoFormat(max_width=WIDTH * pixels, answer=answer, pixels_per_clock=pixels)
    return VideoCore(
        video=video,
        pixels=[Pixel(BITS, latency, "tap_bits") for _ in range(pixels)],
        windows=[Window(latency) for _ in range(pixels)] if video.has_edges else [],
        neighbours=Neighbours(size, TAPS[size], [Decision(latency, width) for _ in range(pixels)]),
    )


def answers(
    pixels: NDArray[np.uint8], size: int, answer: Answer, per_clock: int = 1, width: int = 2
) -> list[Beat]:
    pixels = VideoFormat(pixels_per_clock=per_clock).padded(pixels)
    height, across = pixels.shape[:2]
    around = np.pad(pixels[..., 0] >> np.uint8(8 - BITS), size // 2, mode="edge")
    codes = np.zeros((height, across), dtype=np.int64)
    for place, (bit, row, column) in enumerate(TAPS[size]):
        codes |= (around[row : row + height, column : column + across] >> bit & 1).astype(np.int64) << place
    found = TABLE[codes] if width > 1 else (TABLE[codes] > 0).astype(np.uint8)
    edges = PATTERNS[framed_window_codes(found != 0)]
    return marked(
        VideoFormat(answer=answer).answers(found, edges if answer != "class" else None), 8, per_clock
    )


SIZES = [(4, 5), (4, 8), (1, 3), (3, 1), (2, 2), (1, 1), (4, 6), (4, 5)]


@pytest.mark.parametrize(
    ("size", "answer", "latency", "per_clock"),
    [
        (3, "both", 0, 1),
        (3, "class", 2, 2),
        (3, "edge", 0, 4),
        (5, "both", 0, 1),
        (5, "edge", 1, 1),
        (5, "both", 0, 2),
        (5, "class", 0, 1),
        (5, "both", 1, 4),
        # Beyond what is trained: three beats wait to the right, and two of two pixels.
        (7, "class", 0, 1),
        (7, "both", 0, 2),
    ],
)
def test_frames_of_several_sizes_pass_with_pauses(
    size: int, answer: Answer, latency: int, per_clock: int
) -> None:
    frames = [
        frame(height, width * (per_clock if width == WIDTH else 1), seed)
        for seed, (height, width) in enumerate(SIZES)
    ]
    beats = [beat for pixels in frames for beat in sent(pixels, per_clock)]
    found, _ = run(core(size, answer, latency=latency, pixels=per_clock), beats, height=4)
    assert found == [beat for pixels in frames for beat in answers(pixels, size, answer, per_clock)]


@pytest.mark.parametrize(("size", "lines"), [(3, 1), (5, 2)])
def test_a_pixel_passes_in_each_cycle_and_each_repeated_line_takes_as_long_as_a_line(
    size: int, lines: int
) -> None:
    pixels = frame(6, 8, 0)
    beats = sent(pixels) + sent(pixels)
    found, took = run(core(size, "both"), beats, height=6, offers=1, takes=1)
    assert found == answers(pixels, size, "both") * 2
    # One cycle of reset; each repeated line, and until its end is noticed.
    assert took == 1 + len(beats) + lines * (8 + 4)


def complete(good: int, width: int, reach: int) -> int:
    """How many windows are complete with so many pixels of a frame that is broken off there."""
    line, column = divmod(good, width)
    return max(0, line - reach) * width + (max(0, column - reach) if line >= reach else 0)


@pytest.mark.parametrize("size", [3, 5])
@pytest.mark.parametrize(("malform", "good"), [(short, 13), (long, 14), (broken_off, 13)])
def test_a_malformed_frame_is_answered_as_far_as_it_was_whole_and_the_next_exactly(
    malform: Any, good: int, size: int
) -> None:
    pixels, after = frame(6, 5, 7), frame(6, 6, 8)
    beats = malform(sent(pixels)) + sent(after)
    found, _ = run(core(size, "class"), beats, height=6)
    classes = complete(good, 5, size // 2)
    assert found == answers(pixels, size, "class")[:classes] + answers(after, size, "class")
    found, _ = run(core(size, "both"), beats, height=6)
    edges = complete(classes, 5, 1)
    assert found == answers(pixels, size, "both")[:edges] + answers(after, size, "both")


@pytest.mark.parametrize("size", [3, 5])
def test_any_mix_of_frames_and_faults_leaves_the_next_frame_whole(size: int) -> None:
    draw = random.Random(1)
    beats: list[Beat] = []
    expected: list[Beat] = []
    for seed in range(60):
        pixels = frame(4, draw.randint(2, WIDTH + 2), seed)
        whole, width = sent(pixels), pixels.shape[1]
        cut = draw.randint(1, len(whole) - 1)
        if width > WIDTH:
            # Longer than the memory: nothing of it comes.
            beats += whole
        elif draw.random() < 0.5 and cut % width:
            beats += whole[:cut]
            classes = complete(cut, width, size // 2)
            expected += answers(pixels, size, "both")[: complete(classes, width, 1)]
        else:
            beats += whole
            expected += answers(pixels, size, "both")
    after = frame(4, 5, 100)
    found, _ = run(core(size, "both"), beats + sent(after), height=4)
    assert found == expected + answers(after, size, "both")


@pytest.mark.parametrize("at", [3, 11, 19])
def test_a_reset_in_the_middle_forgets_the_frame(at: int) -> None:
    pixels, after = frame(4, 5, 9), frame(4, 3, 10)
    found, _ = run(core(5, "both"), [*sent(pixels)[:at], None, *sent(after)], height=4)
    before = len(found) - len(answers(after, 5, "both"))
    assert found[before:] == answers(after, 5, "both")
    assert found[:before] == answers(pixels, 5, "both")[:before]


def test_no_more_is_kept_of_a_bit_than_is_seen() -> None:
    near = Neighbours(5, TAPS[5], [])
    # The lowest bit in the middle and at the top, the second at the top and in the fourth row, the third one
    # at the bottom alone: there the line above is kept, which is repeated below the last.
    assert near.kept(BITS) == [4, 4, 1]


def test_a_core_has_a_decision_for_each_pixel() -> None:
    with pytest.raises(ValueError, match="for each"):
        VideoCore(
            video=VideoFormat(answer="class"),
            pixels=[Pixel(BITS, 0, "tap_bits")],
            windows=[],
            neighbours=Neighbours(3, TAPS[3], []),
        )
