"""Regions are the same however the raster is cut into strips."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import open_classes, read_strip, strip_rows
from wnn2hdl.apps.deforestation.regions import NO_REGION, Regions, find_regions
from wnn2hdl.raster import Georeference

pytest.importorskip("rasterio")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]


def regions_of(raster: Path, strip_pixels: int) -> tuple[Regions, NDArray[np.int32]]:
    with open_classes(raster) as dataset:
        strips = strip_rows(dataset, strip_pixels)
        regions = find_regions(dataset, strips, lambda done: None)
        labels = [regions.label(i, read_strip(dataset, rows)) for i, rows in enumerate(strips)]
    return regions, np.concatenate(labels)


def flooded(classes: NDArray[np.uint8]) -> set[frozenset[tuple[int, int]]]:
    """Regions the slow way: spreading from each pixel to its like neighbours."""
    left = {(r, c) for r, c in np.ndindex(classes.shape) if classes[r, c] != 255}
    found = set()
    while left:
        region, front = set(), [left.pop()]
        while front:
            row, column = front.pop()
            region.add((row, column))
            for place in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
                if place in left and classes[place] == classes[row, column]:
                    left.remove(place)
                    front.append(place)
        found.add(frozenset(region))
    return found


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(
    arrays(
        np.uint8, st.tuples(st.integers(1, 8), st.integers(1, 8)), elements=st.sampled_from([0, 1, 2, 255])
    ),
    st.integers(1, 70),
)
def test_regions_are_those_that_spread_from_pixel_to_pixel(
    save_classes: Save, tmp_path: Path, classes: NDArray[np.uint8], strip_pixels: int
) -> None:
    raster = save_classes(tmp_path / "c.tif", classes, Georeference())
    regions, labels = regions_of(raster, strip_pixels)
    assert np.array_equal(labels == NO_REGION, classes == 255)
    places = [set(map(tuple, np.argwhere(labels == i).tolist())) for i in range(len(regions.pixels))]
    assert {frozenset(place) for place in places} == flooded(classes)
    assert regions.pixels.tolist() == [len(place) for place in places]
    assert all(classes[place] == regions.classes[i] for i in range(len(places)) for place in places[i])


def test_the_last_strip_of_a_region_is_known(save_classes: Save, tmp_path: Path) -> None:
    classes = np.array([[0, 1], [1, 1], [1, 0]], dtype=np.uint8)
    regions, labels = regions_of(save_classes(tmp_path / "c.tif", classes, Georeference()), 2)
    assert labels.tolist() == [[0, 1], [1, 1], [1, 2]]
    assert regions.last_strip.tolist() == [0, 2, 2]
