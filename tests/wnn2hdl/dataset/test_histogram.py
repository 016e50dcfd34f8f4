"""Colours counted by class."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.dataset import LabelledImage, colour_histogram


def image(pixels: NDArray[np.uint8], labels: list[int]) -> LabelledImage:
    return LabelledImage("a", pixels, np.array(labels, dtype=np.uint8))


def test_colours_are_packed_red_first_and_counted_by_class() -> None:
    pixels = np.array([[1, 2, 3], [255, 0, 0], [1, 2, 3], [1, 2, 3]], dtype=np.uint8)
    histogram = colour_histogram(image(pixels, [0, 2, 0, 2]), 3)
    assert histogram.colours.tolist() == [0x010203, 0xFF0000]
    assert histogram.colours.dtype == np.uint32
    assert histogram.counts.tolist() == [[2, 0], [0, 0], [1, 1]]
    assert histogram.pixels.tolist() == [[1, 2, 3], [255, 0, 0]]


@given(
    pixels=st.integers(1, 40).flatmap(lambda n: arrays(np.uint8, (n, 3), elements=st.integers(250, 255))),
    seed=st.integers(0, 9),
)
def test_a_histogram_holds_every_pixel(pixels: NDArray[np.uint8], seed: int) -> None:
    labels = np.random.default_rng(seed).integers(0, 2, len(pixels)).tolist()
    histogram = colour_histogram(image(pixels, labels), 2)
    listed = sorted((*pixel, label) for pixel, label in zip(pixels.tolist(), labels, strict=True))
    rebuilt = sorted(
        (*pixel, label)
        for label, row in enumerate(histogram.counts.tolist())
        for pixel, count in zip(histogram.pixels.tolist(), row, strict=True)
        for _ in range(count)
    )
    assert rebuilt == listed
