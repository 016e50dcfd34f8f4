"""Ground that several rasters show."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.areas import class_areas
from wnn2hdl.apps.deforestation.class_raster import open_classes
from wnn2hdl.apps.deforestation.overlap import later_ones, shown_by
from wnn2hdl.raster import NODATA, Georeference

pyproj = pytest.importorskip("pyproj")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]

NAMES = ("forest", "deforested")


def utm(zone: int, east: float, north: float, size: float = 10) -> Georeference:
    crs = pyproj.CRS(f"EPSG:{32700 + zone}").to_wkt()
    return Georeference(crs, (size, 0.0, east, 0.0, -size, north))


@pytest.fixture
def save(save_classes: Save, tmp_path: Path) -> Callable[..., Path]:
    def run(name: str, classes: NDArray[np.uint8], place: Georeference) -> Path:
        return save_classes(tmp_path / name, classes, place)

    return run


def shown(raster: Path, others: list[Path]) -> NDArray[np.bool_]:
    with open_classes(raster) as dataset, shown_by(others, dataset) as rows:
        return rows(0, dataset.height)


def test_tiles_of_one_grid_are_compared_pixel_by_pixel(save: Callable[..., Path]) -> None:
    one = save("a.tif", np.zeros((40, 60), np.uint8), utm(20, 500_000, 9_000_000))
    data = np.zeros((40, 60), np.uint8)
    data[3, 5] = NODATA
    other = save("b.tif", data, utm(20, 500_170, 8_999_880))
    expected = np.zeros((40, 60), dtype=np.bool_)
    expected[12:, 17:] = True
    expected[12 + 3, 17 + 5] = False
    assert np.array_equal(shown(one, [other]), expected)
    assert later_ones([one, other]) == {one: (other,)}


def test_neighbours_that_touch_and_rasters_far_away_share_nothing(save: Callable[..., Path]) -> None:
    square = np.zeros((40, 60), np.uint8)
    rasters = [
        save("a.tif", square, utm(20, 500_000, 9_000_000)),
        save("right.tif", square, utm(20, 500_600, 9_000_000)),
        save("below.tif", square, utm(20, 500_000, 8_999_600)),
        save("zone.tif", square, utm(24, 500_000, 9_000_000)),
        save("nowhere.tif", square, Georeference()),
    ]
    assert later_ones(rasters) == {}


def test_rasters_of_two_zones_share_what_lies_on_the_same_ground(save: Callable[..., Path]) -> None:
    # The same square of the Earth near the meridian between two zones, some 2 km wide.
    there = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32721", always_xy=True).transform(-60.0, -9.0)
    here = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32720", always_xy=True).transform(-60.0, -9.0)
    square = np.ones((200, 200), np.uint8)
    one = save("a.tif", square, utm(20, here[0] - 1000, here[1] + 1000))
    other = save("b.tif", square, utm(21, there[0], there[1] + 1000))
    assert later_ones([one, other]) == {one: (other,)}
    found = shown(one, [other])
    # The grids are turned against each other by about a degree.
    assert found[:, 106:194].mean() > 0.97
    assert not found[:, :94].any()
    whole, rest = class_areas(one, NAMES)[1], class_areas(one, NAMES, [other])[1]
    assert rest.pixels == whole.pixels - found.sum()
    assert rest.hectares is not None
    assert rest.hectares == pytest.approx(200, rel=0.03)


@pytest.mark.parametrize("west", [179.99, -180.01])
def test_the_antimeridian_hides_no_overlap(west: float, save: Callable[..., Path]) -> None:
    degrees = pyproj.CRS("EPSG:4326").to_wkt()
    square = np.zeros((40, 60), np.uint8)
    one = save("a.tif", square, Georeference(degrees, (1e-3, 0.0, west, 0.0, -1e-3, -16.0)))
    east, north = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32701", always_xy=True).transform(
        -179.99, -16
    )
    other = save("b.tif", square, utm(1, east, north, 100))
    assert later_ones([one, other]) == {one: (other,)}
    assert shown(one, [other])[:, 25:].mean() > 0.9
