"""Whether two rasters lie on the same grid."""

from dataclasses import replace

import pytest

from wnn2hdl.raster import Georeference, same_grid

rasterio = pytest.importorskip("rasterio")

PLACE = Georeference(rasterio.crs.CRS.from_epsg(32720).to_wkt(), (10.0, 0.0, 500.0, 0.0, -10.0, 900.0))


def test_the_same_place_is_the_same_grid() -> None:
    assert same_grid(PLACE, PLACE, 100, 100)
    assert same_grid(PLACE, replace(PLACE, transform=(10.0, 0.0, 500.09, 0.0, -10.0, 900.0)), 100, 100)
    assert not same_grid(PLACE, replace(PLACE, transform=(10.0, 0.0, 500.2, 0.0, -10.0, 900.0)), 100, 100)


def test_a_small_difference_of_scale_adds_up() -> None:
    other = replace(PLACE, transform=(10.0001, 0.0, 500.0, 0.0, -10.0, 900.0))
    assert same_grid(PLACE, other, 100, 100)
    assert not same_grid(PLACE, other, 100, 10_000)


def test_another_coordinate_system_is_another_grid() -> None:
    other = replace(PLACE, crs=rasterio.crs.CRS.from_epsg(32721).to_wkt())
    assert not same_grid(PLACE, other, 100, 100)


def test_a_system_tied_to_no_place_on_the_earth_gives_no_areas_but_a_grid() -> None:
    site = Georeference('LOCAL_CS["building site",UNIT["metre",1]]', PLACE.transform)
    assert PLACE.located
    assert not site.located
    assert same_grid(site, site, 100, 100)
    assert not same_grid(site, replace(site, transform=(10.0, 0.0, 600.0, 0.0, -10.0, 900.0)), 100, 100)


def test_what_has_no_place_contradicts_nothing() -> None:
    assert same_grid(PLACE, Georeference(), 100, 100)
