"""How land is divided: every pixel in one parcel, between roads that go on from window to window."""

import numpy as np
import pytest

from wnn2hdl.samples.parcels import Parcels, divide
from wnn2hdl.samples.plane import Window


@pytest.fixture(scope="module")
def land() -> Parcels:
    return divide(3, Window(0, 0, 1400, 1500))


def test_every_pixel_lies_within_its_parcels_sides(land: Parcels) -> None:
    assert land.index.shape == land.road.shape == (1400, 1500)
    assert land.sides.shape == (4, 1400, 1500)
    assert land.sides.min() > -1e-2


def test_parcels_are_of_the_size_of_lots_in_towns_and_of_fields_outside(land: Parcels) -> None:
    area = np.bincount(land.index.ravel(), minlength=len(land.town))
    whole = np.ones(len(area), dtype=bool)
    border = np.concatenate([land.index[0], land.index[-1], land.index[:, 0], land.index[:, -1]])
    whole[border] = False
    seen = whole & (area > 0)
    assert 15**2 < np.median(area[seen & land.town]) < 60**2
    assert 60**2 < np.median(area[seen & ~land.town]) < 140**2
    assert 0.1 < land.town[land.index].mean() < 0.9


def test_roads_are_a_small_part_and_highways_a_part_of_them(land: Parcels) -> None:
    road = land.road < 0
    assert 0.05 < road.mean() < 0.3
    assert not (land.highway & ~road).any()
    assert 0.005 < land.highway.mean() < road.mean()


def test_a_window_elsewhere_sees_the_same_land(land: Parcels) -> None:
    part = divide(3, Window(500, 700, 300, 200))
    inside = np.s_[500:800, 700:900]
    assert np.array_equal(part.road, land.road[inside])
    assert np.array_equal(part.sides, land.sides[(slice(None), *inside)])
    assert np.array_equal(part.highway, land.highway[inside])
    assert np.array_equal(part.town[part.index], land.town[land.index][inside])
    assert np.array_equal(part.number[:, part.index], land.number[:, land.index][(slice(None), *inside)])


def test_parcels_have_numbers_of_their_own(land: Parcels) -> None:
    seen = np.unique(land.index)
    numbers = land.number[:, seen]
    assert numbers.min() >= 0
    assert numbers.max() < 1
    assert np.abs(numbers.mean(axis=1) - 0.5).max() < 0.1
    assert len(np.unique(numbers[0])) > 0.95 * len(seen)


def test_no_two_meshes_are_divided_alike(land: Parcels) -> None:
    """The pattern of roads does not repeat: its correlation with itself has a single peak."""
    road = (land.road < 0)[:1024, :1024].astype(np.float64)
    spectrum = np.fft.rfft2(road - road.mean())
    correlation = np.fft.irfft2(np.abs(spectrum) ** 2)
    peak = correlation[0, 0]
    correlation[:40, :40] = correlation[-40:, :40] = correlation[:40, -40:] = correlation[-40:, -40:] = 0
    assert correlation.max() < 0.5 * peak
