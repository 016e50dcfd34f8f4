"""Local thresholds, against means worked out pixel by pixel in fractions."""

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.binarise import IMAGES, binary_images


def mean_around(
    band: NDArray[np.uint8], valid: NDArray[np.bool_], row: int, column: int, half: int
) -> Fraction:
    around = np.s_[max(row - half, 0) : row + half + 1, max(column - half, 0) : column + half + 1]
    return Fraction(int(band[around][valid[around]].sum()), int(valid[around].sum()))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 12), st.integers(1, 12), st.sampled_from([1, 3, 5, 9]))
def test_bits_are_exact_comparisons_with_the_mean_of_valid_pixels_around(
    seed: int, height: int, width: int, side: int
) -> None:
    rng = np.random.default_rng(seed)
    picture = rng.integers(0, 256, (height, width, 3), dtype=np.uint8)
    valid = rng.random((height, width)) < 0.7
    images = binary_images(picture, valid, side)
    assert images.shape == (len(IMAGES), height, width)
    for row, column in np.ndindex(height, width):
        expected = [False] * 3
        if valid[row, column]:
            red, blue = (
                int(picture[row, column, band])
                - mean_around(picture[..., band], valid, row, column, side // 2)
                for band in (0, 2)
            )
            expected = [red > 0, blue > 0, red > blue]
        assert images[:, row, column].tolist() == expected


def test_even_light_changes_nothing() -> None:
    rng = np.random.default_rng(1)
    picture = rng.integers(0, 100, (20, 30, 3), dtype=np.uint8)
    valid = np.ones((20, 30), dtype=np.bool_)
    brighter = (picture + 90).astype(np.uint8)
    assert (binary_images(brighter, valid, 7) == binary_images(picture, valid, 7)).all()


def test_what_lies_outside_the_valid_pixels_changes_nothing() -> None:
    rng = np.random.default_rng(2)
    picture = rng.integers(0, 256, (20, 30, 3), dtype=np.uint8)
    valid = rng.random((20, 30)) < 0.5
    other = np.where(valid[..., np.newaxis], picture, 255 - picture).astype(np.uint8)
    assert (binary_images(other, valid, 7) == binary_images(picture, valid, 7)).all()


def test_means_of_a_large_bright_picture_do_not_overflow() -> None:
    picture = np.full((3000, 3000, 3), 255, dtype=np.uint8)
    picture[2999, 2999, 0] = 254
    images = binary_images(picture, np.ones((3000, 3000), dtype=np.bool_), 5)
    # Only the pixels that see the darker one lie above their mean.
    assert np.count_nonzero(images[0]) == 8
    assert not images[1].any()
