"""Polygons against the pixels they outline."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.areas import ClassArea, class_areas
from wnn2hdl.apps.deforestation.polygons import write_polygons
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference

rasterio = pytest.importorskip("rasterio")
shapely = pytest.importorskip("shapely")
pyproj = pytest.importorskip("pyproj")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]

NAMES = ("forest", "deforested", "river")
DEGREES = Georeference(pyproj.CRS("EPSG:4326").to_wkt(), (1e-4, 0.0, -60.0, 0.0, -1e-4, -3.0))

maps = arrays(
    np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.sampled_from([0, 1, 2, 255])
)


def silent(step: str, done: int, total: int) -> None:
    pass


def features(path: Path) -> list[dict[str, Any]]:
    return json.loads(path.read_text())["features"]  # type: ignore[no-any-return]


def drawn(path: Path, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """The polygons of a file in pixel coordinates, put back onto a grid."""
    from rasterio.features import rasterize

    shapes = [(f["geometry"], NAMES.index(f["properties"]["class"])) for f in features(path)]
    if not shapes:
        return np.zeros(shape, dtype=np.uint8)
    identity = rasterio.Affine.identity()
    return np.asarray(rasterize(shapes, out_shape=shape, transform=identity, dtype="uint8"))


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(maps, st.integers(1, 90))
@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_polygons_cover_their_pixels_and_nothing_else(
    save_classes: Save, tmp_path: Path, classes: NDArray[np.uint8], strip: int
) -> None:
    raster = save_classes(tmp_path / "c.tif", classes, Georeference())
    output = tmp_path / "p.geojson"
    write_polygons(raster, output, NAMES, silent, strip_pixels=strip)
    assert np.array_equal(drawn(output, classes.shape), np.where(classes == 255, 0, classes))
    for feature in features(output):
        polygon = shapely.geometry.shape(feature["geometry"])
        assert polygon.is_valid
        assert polygon.geom_type == "Polygon"
        assert polygon.area == feature["properties"]["area_px"]
        assert feature["properties"]["area_ha"] is None


@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(maps, st.integers(1, 40))
def test_strips_leave_no_trace_in_the_polygons(
    save_classes: Save, tmp_path: Path, classes: NDArray[np.uint8], strip: int
) -> None:
    raster = save_classes(tmp_path / "c.tif", classes, DEGREES)
    texts = []
    for name, pixels in (("parts", strip), ("whole", 1000)):
        write_polygons(raster, tmp_path / f"{name}.geojson", NAMES, silent, strip_pixels=pixels)
        texts.append(sorted(json.dumps(f) for f in features(tmp_path / f"{name}.geojson")))
    assert texts[0] == texts[1]


def test_areas_of_polygons_add_up_to_those_of_pixels(save_classes: Save, tmp_path: Path) -> None:
    classes = np.random.default_rng(1).choice([0, 1, 2, 255], size=(40, 50)).astype(np.uint8)
    raster = save_classes(tmp_path / "c.tif", classes, DEGREES)
    found = write_polygons(raster, tmp_path / "p.geojson", NAMES, silent, strip_pixels=300)
    for area, expected in zip(found, class_areas(raster, NAMES)[1:], strict=True):
        assert (area.name, area.pixels) == (expected.name, expected.pixels)
        assert area.hectares == pytest.approx(expected.hectares, rel=1e-12)
    written = features(tmp_path / "p.geojson")
    for area in found:
        mine = [f["properties"]["area_ha"] for f in written if f["properties"]["class"] == area.name]
        assert sum(mine) == pytest.approx(area.hectares, abs=1e-6 * len(mine))


@pytest.mark.parametrize("crs", ["EPSG:32720", "EPSG:4326"])
def test_the_area_told_is_that_of_the_polygon_on_the_ellipsoid(
    save_classes: Save, tmp_path: Path, crs: str
) -> None:
    transform = (10.0, 0.0, 7e5, 0.0, -10.0, 9e6) if crs == "EPSG:32720" else DEGREES.transform
    classes = np.zeros((300, 300), dtype=np.uint8)
    classes[20:280, 30:200] = 1
    classes[100:200, 60:150] = 0
    raster = save_classes(tmp_path / "c.tif", classes, Georeference(pyproj.CRS(crs).to_wkt(), transform))
    write_polygons(raster, tmp_path / "p.geojson", NAMES, silent)
    (feature,) = features(tmp_path / "p.geojson")
    polygon = shapely.geometry.shape(feature["geometry"])
    assert polygon.exterior.is_ccw
    geodesic = pyproj.Geod(ellps="WGS84").geometry_area_perimeter(polygon)[0] / 10_000
    assert feature["properties"]["area_ha"] == pytest.approx(geodesic, rel=1e-6)


def test_only_geojson_and_geopackage_are_written(save_classes: Save, tmp_path: Path) -> None:
    raster = save_classes(tmp_path / "c.tif", np.zeros((2, 2), dtype=np.uint8), Georeference())
    with pytest.raises(InputError, match=r"end its name in \.geojson or \.gpkg"):
        write_polygons(raster, tmp_path / "p.shp", NAMES, silent)
    empty = write_polygons(raster, tmp_path / "p.geojson", NAMES[:2], silent)
    assert empty == (ClassArea("deforested", 0, None),)
    assert features(tmp_path / "p.geojson") == []


def test_a_class_without_a_name_leaves_no_file(save_classes: Save, tmp_path: Path) -> None:
    raster = save_classes(tmp_path / "c.tif", np.full((2, 2), 2, dtype=np.uint8), Georeference())
    with pytest.raises(InputError, match="class of index 2"):
        write_polygons(raster, tmp_path / "out" / "p.geojson", NAMES[:2], silent)
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("system", ["EPSG:32760", "EPSG:3832", "EPSG:3460", "EPSG:4326"])
@pytest.mark.parametrize("turn", [0, 360])
def test_a_clearing_across_the_antimeridian_is_cut_there(
    save_classes: Save, tmp_path: Path, system: str, turn: int
) -> None:
    crs = pyproj.CRS(system)
    if turn and not crs.is_geographic:
        return
    pixel = 1e-4 if crs.is_geographic else 10.0
    middle = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True).transform(180.0, -16.8)
    west, north = (-180.0 + turn if crs.is_geographic else middle[0]) - 50 * pixel, middle[1] + 50 * pixel
    classes = np.zeros((100, 100), dtype=np.uint8)
    classes[40:60, 35:65] = 1
    classes[45:55, 45:55] = 0
    place = Georeference(crs.to_wkt(), (pixel, 0.0, west, 0.0, -pixel, north))
    raster = save_classes(tmp_path / "c.tif", classes, place)
    write_polygons(raster, tmp_path / "p.geojson", NAMES, silent)
    (feature,) = features(tmp_path / "p.geojson")
    shape = shapely.from_geojson(json.dumps(feature["geometry"]))
    assert shape.is_valid
    assert shape.geom_type == "MultiPolygon"
    assert shape.bounds[0] == -180
    assert shape.bounds[2] == 180
    on_earth = pyproj.Geod(ellps="WGS84")
    area = sum(on_earth.geometry_area_perimeter(part)[0] for part in shape.geoms)
    assert area / 1e4 == pytest.approx(feature["properties"]["area_ha"], rel=1e-4)


def test_a_geopackage_lies_on_its_raster(save_classes: Save, tmp_path: Path) -> None:
    pyogrio = pytest.importorskip("pyogrio")
    place = Georeference(DEGREES.crs, (1e-4, 0.0, 300.0, 0.0, -1e-4, -3.0))
    raster = save_classes(tmp_path / "c.tif", np.ones((9, 9), np.uint8), place)
    write_polygons(raster, tmp_path / "p.gpkg", NAMES, silent)
    _, _, shapes, _ = pyogrio.raw.read(tmp_path / "p.gpkg")
    assert shapely.from_wkb(shapes[0]).bounds == pytest.approx((300, -3.0009, 300.0009, -3))


HOSTILE = "=1+1|</script>\n\"'*/,&<b>\t`" + "x" * 5000


@pytest.mark.parametrize("name", [HOSTILE, "+1", "@x", "a\r\nb"])
def test_no_name_of_a_class_changes_a_file_of_polygons(save_classes: Save, tmp_path: Path, name: str) -> None:
    pyogrio = pytest.importorskip("pyogrio")
    raster = save_classes(tmp_path / "c.tif", np.ones((3, 3), np.uint8), DEGREES)
    for output in (tmp_path / "p.geojson", tmp_path / "p.gpkg"):
        write_polygons(raster, output, ("forest", name), silent)
    (feature,) = features(tmp_path / "p.geojson")
    assert feature["properties"]["class"] == name
    assert len((tmp_path / "p.geojson").read_text().splitlines()) == 3
    _, _, _, fields = pyogrio.raw.read(tmp_path / "p.gpkg")
    assert fields[0].tolist() == [name]
