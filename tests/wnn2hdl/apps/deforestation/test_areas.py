"""Pixels and hectares of classes."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.areas import ClassArea, class_areas
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference

pyproj = pytest.importorskip("pyproj")
pytest.importorskip("rasterio")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]
UTM = pyproj.CRS("EPSG:32720").to_wkt()


def test_pixels_of_ten_metres_are_hundredths_of_a_hectare(save_classes: Save, tmp_path: Path) -> None:
    classes = np.zeros((100, 200), dtype=np.uint8)
    classes[:, :50], classes[:10, 100:] = 1, 255
    # On the central meridian of UTM lengths are 0.9996 of those on the ground.
    place = Georeference(UTM, (10.0, 0.0, 499_000.0, 0.0, -10.0, 9_000_000.0))
    forest, cleared = class_areas(save_classes(tmp_path / "c.tif", classes, place), ["forest", "deforested"])
    assert (forest.pixels, cleared.pixels) == (14_000, 5_000)
    assert cleared.hectares == pytest.approx(50 / 0.9996**2, rel=1e-6)
    assert forest.hectares == pytest.approx(140 / 0.9996**2, rel=1e-6)


def test_without_a_georeference_there_are_no_hectares(save_classes: Save, tmp_path: Path) -> None:
    raster = save_classes(tmp_path / "c.tif", np.array([[0, 2, 2]], dtype=np.uint8), Georeference())
    assert class_areas(raster, ["a", "b", "c"]) == (
        ClassArea("a", 1, None),
        ClassArea("b", 0, None),
        ClassArea("c", 2, None),
    )


def test_a_class_without_a_name_is_refused(save_classes: Save, tmp_path: Path) -> None:
    raster = save_classes(tmp_path / "c.tif", np.array([[0, 2]], dtype=np.uint8), Georeference())
    with pytest.raises(InputError, match="class of index 2, and there are 2 names"):
        class_areas(raster, ["a", "b"])
