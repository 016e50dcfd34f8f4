"""Pixels are no data where the file says so, in whichever of its ways."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import read_picture
from wnn2hdl.raster import RasterReader, Reading

rasterio = pytest.importorskip("rasterio")

AUX = "<PAMDataset>{}</PAMDataset>"
BAND = '<PAMRasterBand band="{}"><NoDataValue>{}</NoDataValue></PAMRasterBand>'


def left_out(path: Path, reading: Reading = Reading()) -> list[list[int]]:  # noqa: B008
    """Rows and columns of the pixels that are not valid."""
    reader = RasterReader(path, reading)
    valid = reader.read(0, 0, reader.height, reader.width)[1]
    return [] if valid is None else np.argwhere(~valid).tolist()


@pytest.fixture
def holed(scene: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """Three bands, 0 in a quarter and nowhere else, and which pixels are data."""
    valid = np.ones(scene.shape[1:], dtype=np.bool_)
    valid[:20, 35:] = False
    return np.where(valid, np.maximum(scene, 1), 0).astype(np.uint8), valid


def masked(path: Path, valid: NDArray[np.bool_], *, internal: bool) -> Path:
    with (
        warnings.catch_warnings(action="ignore"),
        rasterio.Env(GDAL_TIFF_INTERNAL_MASK=internal),
        rasterio.open(path, "r+") as target,
    ):
        target.write_mask(valid)
    return path


def nodata_beside(path: Path, valid: NDArray[np.bool_]) -> Path:
    bands = "".join(BAND.format(band, 0) for band in (1, 2, 3))
    path.with_name(path.name + ".aux.xml").write_text(AUX.format(bands))
    return path


WAYS: dict[str, Callable[[Any, NDArray[np.uint8], NDArray[np.bool_]], Path]] = {
    "nodata": lambda save, bands, valid: save(bands, photometric="rgb", nodata=0),
    "aux.xml": lambda save, bands, valid: nodata_beside(save(bands, photometric="rgb"), valid),
    "internal mask": lambda save, bands, valid: masked(save(bands, photometric="rgb"), valid, internal=True),
    "msk": lambda save, bands, valid: masked(save(bands, photometric="rgb"), valid, internal=False),
    "alpha": lambda save, bands, valid: save(
        np.concatenate([bands, 255 * valid[np.newaxis].astype(np.uint8)]), photometric="rgb", alpha="yes"
    ),
    "alpha and another nodata": lambda save, bands, valid: save(
        np.concatenate([bands, 255 * valid[np.newaxis].astype(np.uint8)]),
        colours="red green blue alpha",
        nodata=77,
    ),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_way_leaves_the_same_pixels_out(
    way: str, save: Any, holed: tuple[NDArray[np.uint8], NDArray[np.bool_]]
) -> None:
    bands, valid = holed
    found = read_picture(WAYS[way](save, bands, valid))
    assert np.array_equal(found.valid, valid)
    assert np.array_equal(found.pixels[valid], np.moveaxis(bands, 0, 2)[valid])


def test_a_value_that_can_be_a_level_is_no_data_where_all_bands_have_it(
    save: Any, scene: NDArray[np.uint8]
) -> None:
    scene[scene == 0] = 1
    scene[:, 3, 4], scene[0, 5, 6] = 0, 0
    assert left_out(save(scene, photometric="rgb", nodata=0)) == [[3, 4]]


def test_a_value_that_can_be_none_is_no_data_in_any_band(save: Any) -> None:
    samples = np.full((3, 4, 5), 1000, dtype=np.int16)
    samples[1, 2, 3] = -9999
    path = save(samples, photometric="rgb", nodata=-9999)
    assert left_out(path, Reading(scale=(0, 3000))) == [[2, 3]]
    assert left_out(path, Reading(scale=(-10_000, 3000))) == []


def test_bands_that_are_not_read_do_not_count(save: Any, scene: NDArray[np.uint8]) -> None:
    """Red, green and blue are nodata, near-infrared is not."""
    bands = np.concatenate([np.maximum(scene, 1), scene[:1]])
    bands[:3, 3, 4], bands[3] = 0, 9
    path = save(bands, photometric="rgb", alpha="unspecified", nodata=0)
    assert left_out(path) == [[3, 4]]


def test_nodata_of_single_precision_is_found(save: Any) -> None:
    lowest = float(np.finfo(np.float32).min)
    samples = np.full((3, 4, 5), 0.5, dtype=np.float32)
    samples[:, 1, 1] = lowest
    assert left_out(save(samples, photometric="rgb", nodata=lowest), Reading(scale=(0, 1))) == [[1, 1]]


def test_numbers_that_are_none_are_not_valid(save: Any) -> None:
    samples = np.linspace(0, 1, 3 * 600, dtype=np.float32).reshape(3, 20, 30)
    samples[1, 4, 5], samples[2, 6, 7] = np.nan, np.inf
    path = save(samples, photometric="rgb")
    assert left_out(path, Reading(scale=(0, 1))) == [[4, 5], [6, 7]]
    with pytest.raises(InputError, match="0 to 1 in a sample"):
        RasterReader(path, Reading())


def test_transparent_entries_of_a_colour_table_are_not_valid(tmp_path: Path) -> None:
    palette = Image.fromarray(np.arange(24, dtype=np.uint8).reshape(4, 6)).convert("P")
    palette.save(tmp_path / "p.png", transparency=7)
    assert left_out(tmp_path / "p.png") == [[1, 1]]


@pytest.fixture
def infrared(save: Any, scene: NDArray[np.uint8]) -> Path:
    """Red, green, blue and near-infrared, which is marked alpha as programs do."""
    return Path(save(np.concatenate([scene, 255 - scene[:1] // 2]), colours="red green blue alpha"))


def test_alpha_that_looks_like_data_is_questioned(infrared: Path) -> None:
    with pytest.raises(InputError, match=r"looks like data: .*neither clear nor opaque\); give --alpha data"):
        RasterReader(infrared, Reading())
    assert left_out(infrared, Reading(alpha="data")) == []
    assert len(left_out(infrared, Reading(alpha="exclude"))) > 2700


def test_a_band_that_is_named_never_masks(infrared: Path) -> None:
    assert left_out(infrared, Reading(bands=(4, 2, 1))) == []
    with pytest.raises(InputError, match="--alpha"):
        RasterReader(infrared, Reading(bands=(3, 2, 1)))


def test_a_soft_rim_is_no_data_nor_a_question(save: Any, scene: NDArray[np.uint8]) -> None:
    alpha = np.full((1, 40, 70), 255, dtype=np.uint8)
    alpha[0, :, 0] = np.arange(40)
    path = save(np.concatenate([scene, alpha]), photometric="rgb", alpha="yes")
    assert left_out(path) == [[row, 0] for row in range(40)]


def test_alpha_of_16_bits_is_opaque_at_its_highest(save: Any) -> None:
    bands = np.full((4, 3, 2), 65535, dtype=np.uint16)
    bands[3, 1, 1] = 255
    path = save(bands, photometric="rgb", alpha="yes")
    assert left_out(path, Reading(scale=(0, 65535))) == [[1, 1]]
