"""Clean-up against the plainest way to compute it, whole and in parts."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import colours, open_classes
from wnn2hdl.apps.deforestation.cleanup import MinimumSize, despeckle, sieve_raster
from wnn2hdl.raster import Georeference

rasterio = pytest.importorskip("rasterio")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]

maps = arrays(
    np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.sampled_from([0, 1, 2, 255])
)
PLACE = Georeference(rasterio.CRS.from_epsg(32720).to_wkt(), (10.0, 0.0, 5e5, 0.0, -10.0, 9e6))


def silent(step: str, done: int, total: int) -> None:
    pass


def slow_despeckle(classes: NDArray[np.uint8], radius: int) -> NDArray[np.uint8]:
    result = classes.copy()
    for row, column in np.argwhere(classes != 255).tolist():
        top, left = max(row - radius, 0), max(column - radius, 0)
        around = classes[top : row + radius + 1, left : column + radius + 1]
        votes = Counter(around[around != 255].tolist())
        winners = [index for index, count in votes.items() if count == max(votes.values())]
        result[row, column] = classes[row, column] if classes[row, column] in winners else min(winners)
    return result


@given(maps, st.integers(0, 3))
def test_each_pixel_goes_with_the_majority_around(classes: NDArray[np.uint8], radius: int) -> None:
    assert np.array_equal(despeckle(classes, classes != 255, radius), slow_despeckle(classes, radius))


@given(maps, st.integers(0, 2), st.integers(0, 8))
def test_a_window_with_its_halo_is_cleaned_like_the_whole(
    classes: NDArray[np.uint8], radius: int, row: int
) -> None:
    whole = despeckle(classes, classes != 255, radius)
    row = min(row, len(classes) - 1)
    start = max(row - radius, 0)
    part = classes[start : row + radius + 1]
    assert np.array_equal(despeckle(part, part != 255, radius)[row - start], whole[row])


def sieved(
    save: Save, folder: Path, classes: NDArray[np.uint8], minimum: int, strip: int
) -> NDArray[np.uint8]:
    raster = save(folder / "c.tif", classes, PLACE)
    sieve_raster(raster, folder / "s.tif", MinimumSize(minimum), silent, strip_pixels=strip)
    with open_classes(folder / "s.tif") as dataset:
        return np.asarray(dataset.read(1))


def test_a_speck_joins_the_class_around_it(save_classes: Save, tmp_path: Path) -> None:
    classes = np.zeros((7, 9), dtype=np.uint8)
    classes[1:4, 1:4] = 1
    classes[2, 2] = 0
    classes[5, 6:8] = 2
    classes[:, 8] = 255
    expected = np.where(classes == 255, 255, 0)
    assert sieved(save_classes, tmp_path, classes, 9, 1000).tolist() == expected.tolist()
    # The clearing of eight pixels is large enough; the pixel inside it and the pair are not.
    kept = classes.copy()
    kept[2, 2], kept[5, 6:8] = 1, 0
    assert sieved(save_classes, tmp_path, classes, 8, 1000).tolist() == kept.tolist()


def test_the_longest_border_decides_and_not_the_larger_neighbour(save_classes: Save, tmp_path: Path) -> None:
    classes = np.array([[0, 0, 0, 0, 0, 0], [0, 0, 0, 2, 1, 1], [0, 0, 0, 1, 1, 1]], dtype=np.uint8)
    classes[0, 3] = 1
    assert sieved(save_classes, tmp_path, classes, 2, 1000)[1, 3] == 1


def test_what_borders_on_small_regions_only_stays(save_classes: Save, tmp_path: Path) -> None:
    classes = np.array([[0, 1, 0, 1]], dtype=np.uint8)
    assert sieved(save_classes, tmp_path, classes, 3, 1000).tolist() == classes.tolist()


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(maps, st.integers(1, 8), st.integers(1, 40))
def test_strips_leave_no_seam(
    save_classes: Save, tmp_path: Path, classes: NDArray[np.uint8], minimum: int, strip: int
) -> None:
    in_strips = sieved(save_classes, tmp_path, classes, minimum, strip)
    assert np.array_equal(in_strips, sieved(save_classes, tmp_path, classes, minimum, 1000))


def test_two_classes_are_sieved_as_by_gdal(save_classes: Save, tmp_path: Path) -> None:
    from rasterio.features import sieve
    from scipy.ndimage import gaussian_filter

    noise = np.random.default_rng(0).normal(size=(200, 230))
    classes = (gaussian_filter(noise, 2) > 0.03).astype(np.uint8)
    classes[50:60, 100:140] = 255
    expected = sieve(classes, 20, mask=classes != 255)
    assert (expected != classes).sum() > 100
    assert np.array_equal(sieved(save_classes, tmp_path, classes, 20, 3000), expected)


def test_georeference_and_colours_are_kept(save_classes: Save, tmp_path: Path) -> None:
    sieved(save_classes, tmp_path, np.zeros((3, 3), dtype=np.uint8), 2, 1000)
    with open_classes(tmp_path / "c.tif") as before, open_classes(tmp_path / "s.tif") as after:
        assert (after.crs, after.transform, after.nodata) == (before.crs, before.transform, 255)
        assert colours(after)[:3] == colours(before)[:3]


def test_the_dissolved_regions_are_counted(save_classes: Save, tmp_path: Path) -> None:
    classes = np.zeros((5, 5), dtype=np.uint8)
    classes[0, 0] = classes[3, 3] = 1
    raster = save_classes(tmp_path / "c.tif", classes, PLACE)
    assert sieve_raster(raster, tmp_path / "s.tif", MinimumSize(2), silent) == 2


def test_a_minimum_area_is_each_regions_own(save_classes: Save, tmp_path: Path) -> None:
    degrees = Georeference(rasterio.CRS.from_epsg(4326).to_wkt(), (0.5, 0.0, 10.0, 0.0, -0.5, 70.0))
    classes = np.zeros((140, 40), dtype=np.uint8)
    classes[18:22, 10:14], classes[134:138, 10:14] = 1, 1
    raster = save_classes(tmp_path / "a.tif", classes, degrees)
    # 16 pixels each: half as large at 60 degrees north as near the equator.
    sieve_raster(raster, tmp_path / "s.tif", MinimumSize(hectares=3e6), silent, strip_pixels=40 * 7)
    with open_classes(tmp_path / "s.tif") as dataset:
        found = dataset.read(1)
    assert not found[:70].any()
    assert np.array_equal(found[70:], classes[70:])
