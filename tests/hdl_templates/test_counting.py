# amaranth: UnusedElaboratable=no
"""Video cores that count in squares: classes by how many pixels around a pixel have a bit set."""

import random
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out
from numpy.typing import NDArray

from hdl_templates.counting import Counting
from hdl_templates.hierarchy import Part
from hdl_templates.video import VideoCore
from tests.hdl_templates.test_video import (
    PATTERNS,
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
from wnn2hdl.ir.context import box_sums
from wnn2hdl.ir.video import Answer
from wnn2hdl.ir.window import framed_window_codes

WIDTH = 16
"""Of the memories."""

BITS = 3
"""Planes: the highest bits of red."""

Shape = tuple[tuple[int, ...], tuple[tuple[int, int], ...]]

SHAPES: dict[str, Shape] = {
    # The bits of which the pixel's own is read, and the squares.
    "3": ((1,), ((2, 3),)),
    "7": ((2, 0), ((2, 7), (1, 7))),
    "3 in 7": ((0,), ((2, 7), (1, 3), (2, 3))),
    "15": ((), ((2, 15), (0, 7))),
    "31": ((0,), ((1, 31),)),
}

WEIGHTS = 5
"""By how much the class grows with each: own bits, then counts, modulo 128."""


class Sum(Part):
    """The own bits and the counts, the first once, the next `WEIGHTS` times, and so on, as a class."""

    module_name = "sum"

    def __init__(self, shape: Shape, latency: int) -> None:
        own, squares = shape
        self.latency = latency
        self.widths = [*[1] * len(own), *((size * size).bit_length() for _, size in squares)]
        super().__init__({"counts": In(sum(self.widths)), "class_bits": Out(7)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        total: Any = 0
        low = 0
        for place, width in enumerate(self.widths):
            total += self.counts[low : low + width] * WEIGHTS**place
            low += width
        m.d.comb += self.class_bits.eq(delayed(m, total[:7], self.latency))
        return m


def core(shape: Shape, answer: Answer = "class", *, latency: int = 0) -> VideoCore:
    video = VideoFormat(max_width=WIDTH, answer=answer)
    return VideoCore(
        video=video,
        pixels=[Pixel(BITS, latency, "plane_bits")],
        windows=[Window(latency)] if video.has_edges else [],
        neighbours=Counting(*shape, [Sum(shape, latency)]),
    )


def answers(pixels: NDArray[np.uint8], shape: Shape, answer: Answer = "class") -> list[Beat]:
    own, squares = shape
    high = pixels[..., 0] >> np.uint8(8 - BITS)
    things = [high >> bit & 1 for bit in own]
    for bit, size in squares:
        around = np.pad(high, size // 2, mode="edge")
        things.append(box_sums(around >> bit & 1, size))
    total = sum(thing.astype(np.int64) * WEIGHTS**place for place, thing in enumerate(things))
    classes = np.asarray(total % 128, dtype=np.uint8)
    edges = PATTERNS[framed_window_codes(classes != 0)] if answer != "class" else None
    return marked(VideoFormat(answer=answer).answers(classes, edges), 8, 1)


SIZES = [(9, 13), (9, 16), (1, 3), (3, 1), (2, 2), (1, 1), (4, 7), (9, 5)]


@pytest.mark.parametrize(
    ("name", "answer", "latency"),
    [
        ("3", "class", 0),
        ("7", "class", 0),
        ("7", "both", 1),
        ("3 in 7", "class", 2),
        ("15", "edge", 0),
        ("31", "class", 0),
    ],
)
def test_frames_of_several_sizes_pass_with_pauses(name: str, answer: Answer, latency: int) -> None:
    frames = [frame(*size, seed) for seed, size in enumerate(SIZES)]
    beats = [beat for pixels in frames for beat in sent(pixels)]
    # The widest square waits for 15 pixels behind each line.
    found, _ = run(core(SHAPES[name], answer, latency=latency), beats, height=9, patience=400)
    assert found == [beat for pixels in frames for beat in answers(pixels, SHAPES[name], answer)]


def test_a_line_takes_as_many_cycles_more_as_a_square_reaches_to_the_right() -> None:
    pixels = frame(12, 16, 0)
    beats = sent(pixels) + sent(pixels)
    found, took = run(core(SHAPES["7"]), beats, height=12, offers=1, takes=1)
    assert found == answers(pixels, SHAPES["7"]) * 2
    # Two frames, and three repeated lines below the first; what is ahead of the counts need not wait.
    lines = 12 + 3 + 12
    assert lines * (16 + 3) - 30 < took < lines * (16 + 3) + 30


@pytest.mark.parametrize("name", ["3", "7"])
@pytest.mark.parametrize(("malform", "good"), [(short, 13), (long, 14), (broken_off, 13)])
def test_a_malformed_frame_is_answered_as_far_as_it_was_whole_and_the_next_exactly(
    malform: Any, good: int, name: str
) -> None:
    shape = SHAPES[name]
    pixels, after = frame(6, 5, 7), frame(6, 6, 8)
    found, _ = run(core(shape), malform(sent(pixels)) + sent(after), height=6)
    reach = int(name) // 2
    assert found == answers(pixels, shape)[: max(0, good - 6 * reach)] + answers(after, shape)


def test_any_mix_of_frames_and_faults_leaves_the_next_frame_whole() -> None:
    draw = random.Random(1)
    shape = SHAPES["7"]
    beats: list[Beat] = []
    for seed in range(30):
        pixels = frame(draw.randint(1, 5), draw.randint(1, WIDTH + 1), seed)
        whole = sent(pixels)
        beats += whole[: draw.randint(1, len(whole))] if draw.random() < 0.5 else whole
        after = frame(4, draw.randint(1, WIDTH), seed + 100)
        beats += sent(after)
        wanted = answers(after, shape)
        found, _ = run(core(shape), beats, height=4) if seed % 10 == 9 else (wanted, 0)
        assert found[-len(wanted) :] == wanted


@pytest.mark.parametrize("at", [3, 11, 19])
def test_a_reset_in_the_middle_forgets_the_frame(at: int) -> None:
    shape = SHAPES["3"]
    pixels, after = frame(4, 5, 9), frame(4, 3, 10)
    found, _ = run(core(shape), [*sent(pixels)[:at], None, *sent(after)], height=4)
    before = len(found) - len(answers(after, shape))
    assert found[before:] == answers(after, shape)
    assert found[:before] == answers(pixels, shape)[:before]


def test_no_more_is_kept_of_a_bit_than_is_counted() -> None:
    # Of the own bit the lines down to the middle, of counts those down to the upper end of the square.
    assert Counting((0,), ((2, 7), (1, 3)), []).kept(BITS) == [3, 4, 6]
