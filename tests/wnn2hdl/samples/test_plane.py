"""Noise on an unbounded plane: the same at the same place from whichever window one looks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.samples.plane import Window, plane_noise

PLACES = st.integers(-50_000, 50_000)


@given(PLACES, PLACES, st.integers(0, 30), st.integers(0, 30), st.sampled_from([1.0, 3.0, 7.5, 200.0]))
def test_overlapping_windows_agree_to_the_last_bit(
    top: int, left: int, down: int, right: int, scale: float
) -> None:
    whole = plane_noise(4, 9, Window(top, left, 50, 60), scale, octaves=1 if scale < 2 else 2)
    part = plane_noise(4, 9, Window(top + down, left + right, 20, 30), scale, octaves=1 if scale < 2 else 2)
    assert np.array_equal(part, whole[down : down + 20, right : right + 30])


@pytest.mark.parametrize(("scale", "octaves"), [(2, 1), (5.5, 1), (16, 3)])
def test_its_mean_is_zero_and_its_spread_one(scale: float, octaves: int) -> None:
    field = plane_noise(0, 1, Window(-300, 100, 700, 700), scale, octaves)
    assert field.dtype == np.float32
    assert abs(field.mean()) < 0.08
    assert 0.9 < field.std() < 1.1


def test_it_is_smooth_within_its_scale_and_independent_beyond() -> None:
    field = plane_noise(0, 1, Window(0, 0, 600, 600), 20)
    assert np.abs(field[1:] - field[:-1]).max() < 0.4
    assert abs(np.corrcoef(field[100:].ravel(), field[:-100].ravel())[0, 1]) < 0.1


def test_seeds_and_salts_give_other_fields() -> None:
    window = Window(0, 0, 200, 200)
    one = plane_noise(1, 1, window, 5).ravel()
    for other in (plane_noise(2, 1, window, 5), plane_noise(1, 2, window, 5)):
        assert abs(np.corrcoef(one, other.ravel())[0, 1]) < 0.1


def test_padding_adds_to_every_side() -> None:
    assert Window(3, -2, 5, 6).padded(4) == Window(-1, -6, 13, 14)
