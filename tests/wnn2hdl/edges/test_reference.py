"""Canny and Sobel, and the grey they work on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from scipy.signal import convolve2d

from wnn2hdl.edges import canny, grey, sobel

STEP = np.repeat(np.array([[20] * 10 + [120] * 10], dtype=np.uint8), 12, axis=0)


def test_grey_is_the_luma_of_bt_601() -> None:
    pixels = np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]], dtype=np.uint8)
    assert grey(pixels).tolist() == [[76, 150, 29, 255]]


@given(
    picture=arrays(np.uint8, st.tuples(st.integers(3, 9), st.integers(3, 9))), threshold=st.integers(0, 2041)
)
def test_sobel_is_the_integer_definition(picture: NDArray[np.uint8], threshold: int) -> None:
    kernel = np.array([[1, 0, -1], [2, 0, -2], [1, 0, -1]])
    wide = picture.astype(np.int64)
    size = np.abs(convolve2d(wide, kernel, "valid")) + np.abs(convolve2d(wide, kernel.T, "valid"))
    assert np.array_equal(sobel(picture, threshold), size >= threshold)


def test_sobel_reaches_its_greatest_value_on_a_corner_of_black_and_white() -> None:
    corner = np.array([[0, 0, 0], [0, 0, 255], [0, 255, 255]], dtype=np.uint8)
    assert sobel(corner, 1530).all()
    assert not sobel(corner, 1531).any()


def test_canny_draws_one_thin_line_along_a_step() -> None:
    edges = canny(STEP)
    assert edges.shape == (10, 18)
    assert (edges.sum(axis=1) == 1).all()
    assert np.flatnonzero(edges[5])[0] in (8, 9)


@pytest.mark.parametrize(("high", "found"), [(30, True), (2000, False)])
def test_canny_obeys_its_upper_threshold(high: int, found: bool) -> None:
    assert canny(STEP, low=10, high=high).any() == found
