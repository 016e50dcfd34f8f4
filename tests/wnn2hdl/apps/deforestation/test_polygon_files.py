"""What other programs find in the files of polygons."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.polygons import write_polygons
from wnn2hdl.raster import Georeference

pyproj = pytest.importorskip("pyproj")
pyogrio = pytest.importorskip("pyogrio")
shapely = pytest.importorskip("shapely")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]

NAMES = ("forest", "deforested", "río")
PLACE = Georeference(pyproj.CRS("EPSG:32720").to_wkt(), (10.0, 0.0, 500_000.0, 0.0, -10.0, 9_000_000.0))
CLASSES = np.array([[1, 1, 0], [1, 1, 2]], dtype=np.uint8)


def silent(step: str, done: int, total: int) -> None:
    pass


def test_geojson_is_in_longitude_and_latitude(save_classes: Save, tmp_path: Path) -> None:
    output = tmp_path / "p.geojson"
    write_polygons(save_classes(tmp_path / "c.tif", CLASSES, PLACE), output, NAMES, silent)
    collection = json.loads(output.read_text())
    assert set(collection) == {"type", "features"}
    clearing, river = collection["features"]
    assert (clearing["properties"]["class"], river["properties"]["class"]) == ("deforested", "río")
    ring = np.array(clearing["geometry"]["coordinates"][0])
    transformer = pyproj.Transformer.from_crs("EPSG:32720", "EPSG:4326", always_xy=True)
    west, north = transformer.transform(500_000, 9_000_000)
    east, south = transformer.transform(500_020, 8_999_980)
    assert ring.min(axis=0) == pytest.approx([west, south], abs=2e-8)
    assert ring.max(axis=0) == pytest.approx([east, north], abs=2e-8)
    assert pyogrio.read_info(output)["features"] == 2


def test_long_edges_follow_the_rasters_straight_lines(save_classes: Save, tmp_path: Path) -> None:
    output = tmp_path / "p.geojson"
    far = Georeference(PLACE.crs, (100.0, 0.0, 300_000.0, 0.0, -100.0, 7_000_000.0))
    write_polygons(save_classes(tmp_path / "c.tif", np.ones((2, 1000), np.uint8), far), output, NAMES, silent)
    (feature,) = json.loads(output.read_text())["features"]
    transformer = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32720", always_xy=True)
    boundary = shapely.geometry.shape(feature["geometry"]).exterior
    share = np.linspace(0, 1, 500)
    x, y = shapely.get_coordinates(shapely.line_interpolate_point(boundary, share, normalized=True)).T
    _, northing = transformer.transform(x, y)
    edges = np.array([7_000_000, 6_999_800])
    off = np.abs(northing[:, np.newaxis] - edges).min(axis=1)
    short_sides = (northing < 6_999_995) & (northing > 6_999_805)
    # A twentieth of a pixel; a single straight line would be off by one.
    assert off[~short_sides].max() < 5
    assert len(feature["geometry"]["coordinates"][0]) < 40


def test_pixels_are_told_as_such_without_a_georeference(save_classes: Save, tmp_path: Path) -> None:
    output = tmp_path / "p.geojson"
    write_polygons(save_classes(tmp_path / "c.tif", CLASSES, Georeference()), output, NAMES, silent)
    collection = json.loads(output.read_text())
    assert collection["coordinates"] == "pixels: x to the right, y downwards; no georeference"
    river = shapely.geometry.shape(collection["features"][1]["geometry"])
    assert river.bounds == (2, 1, 3, 2)


def test_geopackage_keeps_the_rasters_coordinates(save_classes: Save, tmp_path: Path) -> None:
    output = tmp_path / "p.gpkg"
    # One row a strip: the table is filled in two parts.
    write_polygons(save_classes(tmp_path / "c.tif", CLASSES, PLACE), output, NAMES, silent, strip_pixels=3)
    info = pyogrio.read_info(output)
    assert (info["crs"], info["features"], info["layer_name"]) == ("EPSG:32720", 2, "regions")
    _, _, geometries, fields = pyogrio.raw.read(output)
    assert shapely.from_wkb(geometries[0]).bounds == (500_000, 8_999_980, 500_020, 9_000_000)
    assert fields[0].tolist() == ["deforested", "río"]
    assert fields[2].tolist() == [4, 1]
    assert fields[1] == pytest.approx([0.04, 0.01], rel=1e-3)


def test_a_geopackage_without_regions_is_an_empty_table(save_classes: Save, tmp_path: Path) -> None:
    raster = save_classes(tmp_path / "c.tif", np.zeros((2, 2), np.uint8), Georeference())
    write_polygons(raster, tmp_path / "p.gpkg", NAMES, silent)
    assert pyogrio.read_info(tmp_path / "p.gpkg")["features"] == 0


@pytest.mark.parametrize("suffix", [".geojson", ".gpkg"])
def test_the_same_raster_gives_the_same_bytes(save_classes: Save, tmp_path: Path, suffix: str) -> None:
    raster = save_classes(tmp_path / "c.tif", CLASSES, PLACE)
    files = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for file in files:
        write_polygons(raster, file, NAMES, silent)
    assert files[0].read_bytes() == files[1].read_bytes()
