"""Class rasters are read in strips, and files appear whole or not at all."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import colours, open_classes, read_strip, staged, strip_rows
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference

rasterio = pytest.importorskip("rasterio")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]
CLASSES = np.array([[0, 1, 255], [1, 1, 0], [255, 0, 2]], dtype=np.uint8)


@pytest.fixture
def raster(save_classes: Save, tmp_path: Path) -> Path:
    return save_classes(tmp_path / "classes.tif", CLASSES, Georeference())


@pytest.mark.parametrize("pixels", [1, 3, 7, 100])
def test_strips_make_up_the_raster(raster: Path, pixels: int) -> None:
    with open_classes(raster) as dataset:
        strips = [read_strip(dataset, rows) for rows in strip_rows(dataset, pixels)]
    assert np.array_equal(np.concatenate([strip.classes for strip in strips]), CLASSES)
    assert np.array_equal(np.concatenate([strip.valid for strip in strips]), CLASSES != 255)
    assert [strip.row for strip in strips] == np.cumsum([0, *(len(s.classes) for s in strips)])[:-1].tolist()


def test_the_colours_are_those_of_the_table(raster: Path) -> None:
    with open_classes(raster) as dataset:
        assert colours(dataset)[:3] == ((0, 90, 0), (200, 0, 0), (0, 0, 200))


def test_what_is_no_class_raster_is_refused(tmp_path: Path) -> None:
    with (
        pytest.raises(InputError, match=r"missing\.tif"),
        open_classes(tmp_path / "missing.tif"),
    ):
        pass
    path = tmp_path / "heights.tif"
    options = {"driver": "GTiff", "count": 1, "height": 2, "width": 2, "dtype": "int16"}
    with rasterio.open(
        path, "w", crs="EPSG:32720", transform=rasterio.Affine(5, 0, 0, 0, -5, 0), **options
    ) as f:
        f.write(np.zeros((1, 2, 2), np.int16))
    with pytest.raises(InputError, match="one band of 8 bits"), open_classes(path):
        pass


def test_a_staged_file_replaces_the_old_one_only_when_all_went_well(tmp_path: Path) -> None:
    path = tmp_path / "new" / "file.txt"
    with staged(path) as unfinished:
        unfinished.write_text("one")
        assert not path.exists()
    with suppress(InputError), staged(path) as unfinished:
        unfinished.write_text("half")
        raise InputError("broken")
    assert path.read_text() == "one"
    assert list(path.parent.iterdir()) == [path]
