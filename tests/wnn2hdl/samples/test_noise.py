"""Random fields have the scale, spread and repeatability they promise."""

import numpy as np
import pytest

from wnn2hdl.samples.noise import cell_random, grains, smooth


@pytest.mark.parametrize("octaves", [1, 4])
def test_smooth_noise_has_unit_spread(octaves: int) -> None:
    field = smooth(np.random.default_rng(0), (512, 512), 16, octaves)
    assert field.dtype == np.float32
    assert abs(field.mean()) < 0.1
    assert 0.85 < field.std() < 1.15


def test_smooth_noise_changes_little_within_a_tenth_of_its_scale() -> None:
    field = smooth(np.random.default_rng(0), (256, 256), 40)
    assert np.abs(field[4:] - field[:-4]).max() < 1
    assert np.abs(field[40:] - field[:-40]).max() > 1


def test_grains_have_zero_mean_unit_spread_and_are_a_few_pixels_wide() -> None:
    field = grains(np.random.default_rng(0), (256, 256), 1.5)
    assert abs(field.mean()) < 0.05
    assert field.std() == pytest.approx(1, abs=0.01)
    assert (field[1:] * field[:-1]).mean() > 0.5
    assert abs((field[12:] * field[:-12]).mean()) < 0.1


def test_cell_numbers_depend_on_seed_salt_row_and_column_and_are_uniform() -> None:
    row, column = np.mgrid[-100:100, -100:100].astype(np.int32)
    field = cell_random(3, 1, row, column)
    assert np.array_equal(field, cell_random(3, 1, row, column))
    assert field.min() >= 0
    assert field.max() < 1
    counts = np.histogram(field, bins=10, range=(0, 1))[0]
    assert counts.min() > 3700
    assert counts.max() < 4300
    for other in (cell_random(4, 1, row, column), cell_random(3, 2, row, column), field.T):
        assert abs(np.corrcoef(field.ravel(), other.ravel())[0, 1]) < 0.03
