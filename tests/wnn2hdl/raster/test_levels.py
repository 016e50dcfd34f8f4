"""Samples become levels of 8 bits as the file and the user say."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster import RasterReader, Reading
from wnn2hdl.raster.levels import scaled

rasterio = pytest.importorskip("rasterio")


def whole(path: Path, reading: Reading = Reading()) -> NDArray[np.uint8]:  # noqa: B008
    reader = RasterReader(path, reading)
    return reader.read(0, 0, reader.height, reader.width)[0]


def with_units(path: Path, scale: float, *offsets: float) -> Path:
    with warnings.catch_warnings(action="ignore"), rasterio.open(path, "r+") as target:
        target.scales = (scale,) * target.count
        target.offsets = offsets if len(offsets) > 1 else offsets * target.count
    return path


def test_deep_samples_need_a_scale(save: Any) -> None:
    deep = np.arange(3 * 600, dtype=np.uint16).reshape(3, 20, 30) * 7
    path = save(deep, photometric="rgb")
    with pytest.raises(InputError, match=r"uint16.*\(0 to 12593 in a sample\); give --scale"):
        RasterReader(path, Reading())
    expected = np.clip(np.rint((np.moveaxis(deep, 0, 2).astype(float) - 100) * (255 / 2900)), 0, 255)
    assert np.array_equal(whole(path, Reading(scale=(100, 3000))), expected)


def test_a_stated_offset_is_heeded_so_that_two_dates_compare(save: Any) -> None:
    """Sentinel-2 stores reflectance times 10,000, and since 2022 a thousand more."""
    reflectance = np.arange(3 * 600, dtype=np.uint16).reshape(3, 20, 30)
    before = with_units(save(reflectance, "2021.tif", photometric="rgb"), 1e-4, 0.0)
    after = with_units(save(reflectance + 1000, "2023.tif", photometric="rgb"), 1e-4, -0.1)
    with pytest.raises(InputError, match=r"0 to 0\.1799 in a sample; 0\.0001 times the sample \+0\); give"):
        RasterReader(before, Reading())
    reading = Reading(scale=(0, 0.15))
    assert np.array_equal(whole(before, reading), whole(after, reading))
    assert whole(before, reading).max() == 255


def test_each_band_has_units_of_its_own(save: Any) -> None:
    samples = np.full((3, 4, 5), 100, dtype=np.uint16)
    path = with_units(save(samples, photometric="rgb"), 2.0, 0.0, 55.0, -100.0)
    assert whole(path, Reading(scale=(0, 255)))[0, 0].tolist() == [200, 255, 100]


def test_a_scale_of_samples_does_not_fit_a_file_of_reflectances(save: Any) -> None:
    path = with_units(save(np.ones((3, 4, 5), np.uint16), photometric="rgb"), 1e-4, -0.1)
    with pytest.raises(InputError, match=r"reach from -0\.1 to 6\.4535.*--scale 0\.\.3000"):
        RasterReader(path, Reading(scale=(0, 3000)))


def test_bytes_with_units_are_no_levels(save: Any, scene: NDArray[np.uint8]) -> None:
    path = with_units(save(scene, photometric="rgb"), 1 / 255, 0.0)
    with pytest.raises(InputError, match="give --scale"):
        RasterReader(path, Reading())
    assert np.array_equal(whole(path, Reading(scale=(0, 1))), np.moveaxis(scene, 0, 2))


def test_signed_samples_are_scaled(save: Any) -> None:
    samples = np.array([[[-128, 0, 127]]], dtype=np.int8).repeat(3, axis=0)
    path = save(samples, photometric="rgb")
    assert whole(path, Reading(scale=(-128, 127)))[0, :, 0].tolist() == [0, 128, 255]


def test_complex_samples_are_refused_scaled_or_not(save: Any) -> None:
    path = save(np.ones((3, 20, 30), dtype=np.complex64), photometric="rgb")
    for reading in (Reading(), Reading(scale=(0, 1))):
        with pytest.raises(InputError, match="the samples are complex"):
            RasterReader(path, reading)


def test_white_by_zero_is_turned_round(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene[:1], photometric="miniswhite")
    assert np.array_equal(whole(path)[..., 1], 255 - scene[0])
    assert np.array_equal(
        whole(path, Reading(scale=(0, 127.5)))[..., 1], 255 - np.minimum(2 * scene[0].astype(int), 255)
    )
    # Of one bit GDAL makes a palette, which says so itself.
    fax = save(scene[:1] & 1, "fax.tif", photometric="miniswhite", nbits=1)
    assert np.array_equal(whole(fax)[..., 0], np.where(scene[0] & 1, 0, 255))


@pytest.mark.parametrize("kind", ["int8", "int16", "uint16", "uint8"])
def test_scaling_by_table_is_scaling_by_arithmetic(kind: str) -> None:
    limits = np.iinfo(kind)
    values = np.random.default_rng(2).integers(limits.min, limits.max, 500, endpoint=True).astype(kind)
    low, high = float(np.quantile(values, 0.2)), float(np.quantile(values, 0.7))
    expected = np.clip(np.rint((values.astype(float) - low) * (255 / (high - low))), 0, 255)
    assert np.array_equal(scaled(values, low, high), expected)
