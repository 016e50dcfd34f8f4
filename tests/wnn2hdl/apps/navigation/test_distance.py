"""Distances over the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.distance import EARTH_RADIUS_M, geodesic_m, great_circle_m

latitudes, longitudes = st.floats(-89, 89), st.floats(-179, 179)


@given(latitudes, longitudes, latitudes, longitudes)
def test_equals_the_reference_s_arccosine_at_long_distances(a: float, b: float, c: float, d: float) -> None:
    one, two = np.radians([a, b]), np.radians([c, d])
    cosine = np.cos(one[0]) * np.cos(two[0]) * np.cos(one[1] - two[1]) + np.sin(one[0]) * np.sin(two[0])
    # Its own rounding is 1e-8 radians near 0, which is 0.1 m.
    assert great_circle_m(a, b, c, d) == pytest.approx(
        EARTH_RADIUS_M * np.arccos(np.clip(cosine, -1, 1)), abs=0.5
    )


def test_keeps_its_digits_at_short_distances() -> None:
    metre = np.degrees(1 / EARTH_RADIUS_M)
    assert great_circle_m(41.0, -83.3, 41.0 + metre / 1000, -83.3) == pytest.approx(0.001, rel=1e-5)


@pytest.mark.parametrize(
    ("latitude", "north", "east"),
    [(0, 100.56, 99.89), (24, 100.39, 99.83), (41, 100.13, 99.74), (60, 99.81, 99.64)],
)
def test_how_much_the_two_differ(latitude: float, north: float, east: float) -> None:
    """As the module's text says, for 100 m on the ellipsoid."""
    for turn, figure in ((np.array([1.0, 0.0]), north), (np.array([0.0, 1.0]), east)):
        there = np.array([latitude, 10.0]) + turn * 1e-3
        ratio = great_circle_m(latitude, 10, *there) / geodesic_m(latitude, 10, *there)
        assert 100 * ratio == pytest.approx(figure, abs=0.006)


def test_arrays_are_taken_element_by_element() -> None:
    track = np.array([24.1, 24.2])
    for distance in (great_circle_m, geodesic_m):
        both = distance(track, 120.0, 24.1, 120.0)
        assert both.shape == (2,)
        assert both[0] == 0
        assert both[1] == distance(24.2, 120.0, 24.1, 120.0)
