"""The words of video streams."""

import numpy as np
import pytest

from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.video import Beats
from wnn2hdl.ir.window import framed_window_codes, window_codes

PIXEL = np.array([0x11, 0x22, 0x33], dtype=np.uint8)


@pytest.mark.parametrize(("channels", "word"), [("GBR", 0x113322), ("RGB", 0x332211), ("BGR", 0x112233)])
def test_the_first_channel_is_the_least_significant_byte(channels: str, word: int) -> None:
    assert VideoFormat(format=channels).pixels(PIXEL) == word


def test_an_answer_has_the_class_below_and_the_edge_on_top() -> None:
    classes, edges = np.array([0, 2, 1], dtype=np.uint8), np.array([False, True, True])
    assert VideoFormat(answer="class").answers(classes, None).tolist() == [0, 2, 1]
    assert VideoFormat(answer="edge").answers(classes, edges).tolist() == [0, 255, 255]
    assert VideoFormat(answer="both").answers(classes, edges).tolist() == [0, 0x82, 0x81]


def test_a_format_survives_as_json_and_refuses_what_no_core_has() -> None:
    video = VideoFormat(640, "BGR", "edge", 4)
    assert VideoFormat.from_json(video.to_json()) == video
    wrong = {"max_width": 4097, "format": "RGG", "answer": "none", "pixels_per_clock": 3}
    for field, value in [("max_width", 1), *wrong.items()]:
        with pytest.raises(ValueError, match="not"):
            VideoFormat.from_json(video.to_json() | {field: value})


def test_beats_mark_the_start_of_frames_and_the_ends_of_lines() -> None:
    frames = [np.arange(6, dtype=np.uint32).reshape(2, 3), np.arange(2, dtype=np.uint32).reshape(1, 2)]
    beats = Beats.of(frames, [frame.astype(np.uint8) for frame in frames])
    assert beats.pixels.tolist() == beats.answers.tolist() == [[0], [1], [2], [3], [4], [5], [0], [1]]
    assert np.flatnonzero(beats.starts).tolist() == [0, 6]
    assert np.flatnonzero(beats.ends).tolist() == [2, 5, 7]
    assert (len(beats), beats.height) == (8, 2)


def test_a_beat_has_its_left_pixel_lowest_and_the_last_one_of_a_line_repeated() -> None:
    video = VideoFormat(format="RGB", pixels_per_clock=2)
    frame = video.padded(np.arange(1, 10, dtype=np.uint8).reshape(1, 3, 3))
    assert frame[0, :, 0].tolist() == [1, 4, 7, 7]
    beats = Beats.of([video.pixels(frame)], [frame[..., 0]], 2)
    assert beats.sent(video.pixel_bits) == [0x060504030201, 0x090807090807]
    assert beats.expected() == [0x0401, 0x0707]
    assert (video.beats_of(4), video.beats_of(5)) == (2, 3)


def test_a_grey_pixel_is_one_byte() -> None:
    video = VideoFormat(format="mono")
    assert video.pixels(np.full((1, 2, 3), [[[7], [9]]], dtype=np.uint8)).tolist() == [[7, 9]]
    assert video.pixel_bits == 8


def test_beyond_an_image_its_nearest_pixel_is_repeated() -> None:
    image = np.random.default_rng(0).random((4, 5)) < 0.5
    codes = framed_window_codes(image)
    assert codes.shape == image.shape
    assert np.array_equal(codes[1:-1, 1:-1], window_codes(image))
    top_left = [image[max(y, 0), max(x, 0)] for y in (-1, 0, 1) for x in (-1, 0, 1)]
    assert codes[0, 0] == sum(int(bit) << place for place, bit in enumerate(top_left))
