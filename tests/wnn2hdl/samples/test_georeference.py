"""The map's grid: PROJ's projection one way and back, and its north and metres against PROJ's geodesics."""

import math
import sys

import numpy as np
import pytest

from wnn2hdl.errors import ExtraMissingError
from wnn2hdl.samples.georeference import EPSG, NORTH, WEST, Grid

pyproj = pytest.importorskip("pyproj")

CORNERS = [(WEST, NORTH), (WEST + 5193, NORTH), (WEST, NORTH - 4936), (WEST + 5193, NORTH - 4936)]


@pytest.mark.parametrize(("east", "north"), CORNERS)
def test_degrees_and_back_is_the_same_place_and_what_a_transformer_says(east: float, north: float) -> None:
    grid = Grid()
    latitude, longitude = grid.degrees(east, north)
    assert grid.position(latitude, longitude) == pytest.approx((east, north), abs=1e-6)
    transformer = pyproj.Transformer.from_crs(4326, EPSG, always_xy=True)
    assert transformer.transform(longitude, latitude) == pytest.approx((east, north), abs=1e-6)


@pytest.mark.parametrize(("east", "north"), CORNERS)
@pytest.mark.parametrize("azimuth", range(0, 360, 30))
def test_true_north_and_metres_become_the_grids(east: float, north: float, azimuth: int) -> None:
    grid = Grid()
    latitude, longitude = grid.degrees(east, north)
    there_longitude, there_latitude, _ = pyproj.Geod(ellps="WGS84").fwd(longitude, latitude, azimuth, 250)
    there_east, there_north = grid.position(there_latitude, there_longitude)
    true = 250 * np.array([math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth))])
    shift = grid.to_grid(true, latitude, longitude)
    assert math.dist(shift, (there_north - north, there_east - east)) < 0.0005
    # What forgetting the convergence would cost.
    assert math.dist(true, (there_north - north, there_east - east)) > 1


def test_factors_are_what_the_documentation_says() -> None:
    grid = Grid()
    convergence, scale = grid.factors(*grid.degrees(WEST + 2600, NORTH - 2500))
    assert convergence == pytest.approx(-0.30, abs=0.01)
    assert scale == pytest.approx(1.00006, abs=0.000005)


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyproj", None)
    with pytest.raises(
        ExtraMissingError, match=r"needs pyproj; install it with: pip install 'wnn2hdl\[geo\]'"
    ):
        Grid()
