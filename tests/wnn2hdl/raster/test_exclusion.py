"""A mask of clouds leaves pixels out of a picture that it fits."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import open_picture
from wnn2hdl.raster import Reading

rasterio = pytest.importorskip("rasterio")


def valid(path: Path, mask: Path) -> NDArray[np.bool_]:
    source = open_picture(path, Reading(exclude=mask))
    found = source.read(0, 0, source.height, source.width)[1]
    assert found is not None
    return found


@pytest.fixture
def clouds(tmp_path: Path) -> NDArray[np.uint8]:
    found = np.zeros((40, 70), dtype=np.uint8)
    found[20:, 30:] = 3
    Image.fromarray(found).save(tmp_path / "clouds.png")
    return found


def test_clouds_are_left_out(save: Any, scene: NDArray[np.uint8], clouds: NDArray[np.uint8]) -> None:
    path = save(scene, photometric="rgb")
    assert np.array_equal(valid(path, path.with_name("clouds.png")), clouds == 0)
    source = open_picture(path, Reading(exclude=path.with_name("clouds.png")))
    assert np.array_equal(source.read(10, 20, 20, 30)[0], np.moveaxis(scene, 0, 2)[10:30, 20:50])
    assert {file.name for file in source.files} >= {path.name, "clouds.png"}


def test_clouds_come_on_top_of_what_the_file_says(
    save: Any, scene: NDArray[np.uint8], clouds: NDArray[np.uint8]
) -> None:
    bands = np.maximum(scene, 1)
    bands[:, 0, 0] = 0
    path = save(bands, photometric="rgb", nodata=0)
    expected = clouds == 0
    expected[0, 0] = False
    assert np.array_equal(valid(path, path.with_name("clouds.png")), expected)


def test_a_masks_alpha_is_no_cloud(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    clouds = np.zeros((40, 70, 2), dtype=np.uint8)
    clouds[:10, :, 0], clouds[..., 1] = 255, 255
    Image.fromarray(clouds).save(tmp_path / "clouds.png")
    assert np.array_equal(valid(save(scene, photometric="rgb"), tmp_path / "clouds.png"), clouds[..., 0] == 0)


def test_a_mask_that_does_not_fit_is_refused(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    path = save(scene, photometric="rgb", crs="EPSG:32720", transform=rasterio.Affine(10, 0, 0, 0, -10, 0))
    Image.new("L", (40, 70)).save(tmp_path / "turned.png")
    with pytest.raises(InputError, match=r"40x70, the picture 70x40"):
        valid(path, tmp_path / "turned.png")
    Image.new("L", (70, 40)).save(tmp_path / "lossy.jpg")
    with pytest.raises(InputError, match="JPEG cannot be a mask"):
        valid(path, tmp_path / "lossy.jpg")
    elsewhere = rasterio.Affine(10, 0, 10, 0, -10, 0)
    moved = save(scene[:1], "moved.tif", crs="EPSG:32720", transform=elsewhere)
    with pytest.raises(InputError, match="different places"):
        valid(path, moved)
