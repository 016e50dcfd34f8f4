"""Areas of pixels against PROJ's geodesics and scale factors, which know nothing of how they are computed."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.apps.deforestation.ellipsoid import PixelAreas
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference

rasterio = pytest.importorskip("rasterio")
pyproj = pytest.importorskip("pyproj")
GEOD = pyproj.Geod(ellps="WGS84")


def raster(path: Path, crs: str, transform: tuple[float, ...], height: int, width: int) -> Path:
    options = {"driver": "GTiff", "count": 1, "height": height, "width": width, "dtype": "uint8"}
    with rasterio.open(path, "w", crs=crs, transform=rasterio.Affine(*transform), **options):
        return path


def areas(path: Path, rows: tuple[int, int]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    with rasterio.open(path) as dataset:
        return PixelAreas(Georeference.of(dataset), *dataset.shape).rows(*rows)


def geodesic_area(longitudes: list[float], latitudes: list[float]) -> float:
    """Of a quadrangle whose sides are straight in degrees, so they are cut into many geodesics."""
    share = np.linspace(0, 1, 2001)[:-1]
    x = np.concatenate(
        [a + (b - a) * share for a, b in zip(longitudes, np.roll(longitudes, -1), strict=True)]
    )
    y = np.concatenate([a + (b - a) * share for a, b in zip(latitudes, np.roll(latitudes, -1), strict=True)])
    return abs(float(GEOD.polygon_area_perimeter(x, y)[0]))


@pytest.mark.parametrize("north", [90, 60, 1, 0, -44])
def test_cells_of_a_degree_have_their_area_between_parallels(tmp_path: Path, north: int) -> None:
    path = raster(tmp_path / "cells.tif", "EPSG:4326", (1, 0, -60, 0, -1, north), 2, 3)
    found = areas(path, (0, 2))
    for row in (0, 1):
        south = north - row - 1
        expected = geodesic_area([-60, -59, -59, -60], [south, south, south + 1, south + 1])
        assert found[row] == pytest.approx(expected, rel=1e-6)


def test_all_cells_of_the_world_make_the_ellipsoid(tmp_path: Path) -> None:
    path = raster(tmp_path / "world.tif", "EPSG:4326", (10, 0, -180, 0, -10, 90), 18, 36)
    # 510 065 621.7 km²: the area of WGS 84.
    assert areas(path, (0, 18)).sum() == pytest.approx(510_065_621.724e6, rel=1e-9)


@pytest.mark.parametrize("easting", [500_000, 250_000, 790_000])
def test_pixels_in_utm_differ_from_their_nominal_size_by_the_scale_factor(
    tmp_path: Path, easting: int
) -> None:
    path = raster(tmp_path / "utm.tif", "EPSG:32720", (10, 0, easting, 0, -10, 9_000_000), 4, 5)
    transformer = pyproj.Transformer.from_crs("EPSG:32720", "EPSG:4326", always_xy=True)
    factors = pyproj.Proj("EPSG:32720").get_factors(*transformer.transform(easting + 25, 9_000_000 - 20))
    assert areas(path, (0, 4)) == pytest.approx(100 / factors.areal_scale, rel=1e-6)


def test_web_mercator_is_measured_on_the_ellipsoid(tmp_path: Path) -> None:
    path = raster(tmp_path / "web.tif", "EPSG:3857", (100, 0, -6_700_000, 0, -100, -1_500_000), 1, 1)
    transformer = pyproj.Transformer.from_crs("EPSG:3857", "EPSG:4326", always_xy=True)
    corners = transformer.transform(
        [-6_700_000, -6_699_900, -6_699_900, -6_700_000], [-1_500_100, -1_500_100, -1_500_000, -1_500_000]
    )
    assert areas(path, (0, 1))[0, 0] == pytest.approx(geodesic_area(*map(list, corners)), rel=1e-7)


def test_a_rotated_grid_has_the_area_of_its_parallelograms(tmp_path: Path) -> None:
    path = raster(tmp_path / "turned.tif", "EPSG:4326", (4e-3, 1e-3, 120, -1e-3, -5e-3, 30), 1, 1)
    expected = geodesic_area([120, 120.004, 120.005, 120.001], [30, 29.999, 29.994, 29.995])
    assert areas(path, (0, 1))[0, 0] == pytest.approx(expected, rel=1e-6)


def test_a_raster_may_lie_across_the_antimeridian(tmp_path: Path) -> None:
    # Zone 60 reaches to 180 degrees east, some 334 km from its central meridian; it mirrors at that meridian.
    west = raster(tmp_path / "west.tif", "EPSG:32701", (1000, 0, 500_000 - 336_000, 0, -1000, 1e7), 1, 4)
    east = raster(tmp_path / "east.tif", "EPSG:32760", (1000, 0, 500_000 + 332_000, 0, -1000, 1e7), 1, 4)
    assert areas(east, (0, 1)) == pytest.approx(areas(west, (0, 1))[:, ::-1], rel=1e-9)
    assert areas(east, (0, 1)).max() < 1.01e6


def test_areas_between_nodes_are_those_at_every_pixel(tmp_path: Path) -> None:
    wide = raster(tmp_path / "wide.tif", "EPSG:4326", (1e-4, 0, -60, 0, -1e-4, -8), 600, 700)
    found = areas(wide, (130, 470))
    for row, column in ((0, 0), (77, 699), (339, 350)):
        top = -8 - (130 + row) * 1e-4
        one = raster(tmp_path / "one.tif", "EPSG:4326", (1e-4, 0, -60 + column * 1e-4, 0, -1e-4, top), 1, 1)
        assert found[row, column] == pytest.approx(areas(one, (0, 1))[0, 0], rel=1e-8)


@pytest.mark.parametrize(
    "transform",
    [(10, 0, 1e12, 0, -10, 1e13), (0, 0, 500_000, 0, 0, 9_000_000)],
    ids=["beyond the projection", "of no size"],
)
def test_pixels_without_an_area_are_refused(tmp_path: Path, transform: tuple[float, ...]) -> None:
    path = raster(tmp_path / "lost.tif", "EPSG:32720", transform, 4, 5)
    with pytest.raises(InputError, match="the pixels have no area on the Earth"):
        areas(path, (0, 4))


def test_another_world_has_no_area_on_the_earth(tmp_path: Path) -> None:
    path = raster(tmp_path / "moon.tif", "IAU_2015:30100", (1, 0, 5, 0, -1, 0), 2, 3)
    with pytest.raises(InputError, match="longitude and latitude on the Earth"):
        areas(path, (0, 2))


def test_corners_beyond_the_projection_are_told_at_once(tmp_path: Path) -> None:
    globe = "+proj=ortho +lat_0=0 +lon_0=0 +ellps=WGS84"
    path = raster(tmp_path / "globe.tif", globe, (1e5, 0, -65e5, 0, -1e5, 65e5), 130, 130)
    with rasterio.open(path) as dataset, pytest.raises(InputError, match="no area on the Earth"):
        PixelAreas(Georeference.of(dataset), *dataset.shape)
