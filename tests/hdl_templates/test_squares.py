# amaranth: UnusedElaboratable=no
"""Squares of a video core: majorities as the software finds them, whatever the sizes of frames."""

import numpy as np
import pytest
from numpy.typing import NDArray

from hdl_templates.video import Neighbours, VideoCore
from tests.hdl_templates import test_neighbours as near
from tests.hdl_templates.test_video import (
    WIDTH,
    Beat,
    Pixel,
    Window,
    answers,
    broken_off,
    frame,
    marked,
    run,
    sent,
)
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.video import Answer

SIZES = [(4, 5), (4, 8), (1, 3), (3, 1), (2, 2), (1, 1), (4, 6), (7, 7), (7, 7)]


def core(
    answer: Answer, square: int, *, classes: int = 2, latency: int = 0, pixels: int = 1, width: int = WIDTH
) -> VideoCore:
    video = VideoFormat(max_width=width * pixels, answer=answer, pixels_per_clock=pixels, square=square)
    return VideoCore(
        video=video,
        pixels=[Pixel((classes - 1).bit_length(), latency) for _ in range(pixels)],
        windows=[Window(latency) for _ in range(pixels)] if video.has_edges else [],
        classes=classes,
    )


def majorities(classes: NDArray[np.uint8], side: int, count: int = 2) -> list[Beat]:
    """The software's, one for each square, marked as a frame."""
    voted = vote(classes, None, side=side, share=1.0, seed=0, count=count)
    return marked(voted[::side, ::side], 8, 1)


def classes_of(pixels: NDArray[np.uint8], per_clock: int = 1, bits: int = 1) -> NDArray[np.uint8]:
    """Those of `Pixel`, of whole beats."""
    return VideoFormat(pixels_per_clock=per_clock).padded(pixels)[..., 0] >> np.uint8(8 - bits)


@pytest.mark.parametrize(
    ("answer", "square", "classes", "latency", "per_clock"),
    [
        ("class", 2, 2, 0, 1),
        ("both", 3, 2, 1, 1),
        ("edge", 5, 4, 0, 1),
        ("both", 4, 3, 0, 2),
        ("edge", 2, 2, 2, 2),
        ("class", 4, 4, 1, 4),
        ("both", 16, 2, 0, 1),
        ("class", 3, 128, 0, 1),
    ],
)
def test_squares_are_those_of_the_software_and_answers_are_as_without_them(
    answer: Answer, square: int, classes: int, latency: int, per_clock: int
) -> None:
    bits = (classes - 1).bit_length()
    frames = [
        frame(height, width * (per_clock if width == WIDTH else 1), seed)
        for seed, (height, width) in enumerate(SIZES)
    ]
    if classes == 3:
        frames = [np.minimum(pixels, np.uint8(191)) for pixels in frames]
    found: list[Beat] = []
    beats = [beat for pixels in frames for beat in sent(pixels, per_clock)]
    dut = core(answer, square, classes=classes, latency=latency, pixels=per_clock)
    answered, _ = run(dut, beats, height=7, squares=found)
    assert answered == [beat for pixels in frames for beat in answers(pixels, answer, bits, per_clock)]
    voted = [majorities(classes_of(pixels, per_clock, bits), square, classes) for pixels in frames]
    assert found == [beat for squares in voted for beat in squares]


def test_squares_of_neighbourhoods() -> None:
    video = VideoFormat(max_width=WIDTH, answer="class", square=3)
    dut = VideoCore(
        video=video,
        pixels=[Pixel(near.BITS, 0, "tap_bits")],
        windows=[],
        neighbours=Neighbours(5, near.TAPS[5], [near.Decision(1, 2)]),
        classes=3,
    )
    found: list[Beat] = []
    frames = [frame(7, 7, seed) for seed in range(3)]
    run(dut, [beat for pixels in frames for beat in sent(pixels)], height=7, squares=found)
    classes = [
        np.array([data for data, _, _ in near.answers(pixels, 5, "class")], dtype=np.uint8).reshape(7, 7)
        for pixels in frames
    ]
    assert found == [beat for picture in classes for beat in majorities(picture, 3, 3)]


def test_a_square_of_one_beat_is_counted_line_by_line() -> None:
    # The same counter is needed again as soon as can be.
    frames = [frame(9, 1, seed) for seed in range(20)]
    found: list[Beat] = []
    beats = [beat for pixels in frames for beat in sent(pixels)]
    run(core("class", 8), beats, height=9, offers=1, takes=1, squares=found)
    assert found == [beat for pixels in frames for beat in majorities(classes_of(pixels), 8)]


def test_a_pixel_passes_in_each_cycle() -> None:
    pixels = frame(6, 8, 0)
    beats = sent(pixels) + sent(pixels)
    _, took = run(core("both", 2), beats, height=6, offers=1, takes=1, squares=[])
    assert took == 1 + len(beats) + 8 + 4


def test_squares_of_a_malformed_frame_are_given_up_and_the_next_are_whole() -> None:
    pixels, after = frame(6, 5, 7), frame(6, 6, 8)
    found: list[Beat] = []
    run(core("both", 4), broken_off(sent(pixels)) + sent(after), height=6, squares=found)
    assert found == majorities(classes_of(after), 4)
