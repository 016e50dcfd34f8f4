"""Pillow reads what is plain, and leaves to GDAL what is not."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageOps, TiffImagePlugin

from wnn2hdl.errors import ExtraMissingError
from wnn2hdl.images import read_picture, read_rgb
from wnn2hdl.images.plain import plain_head, turned

PIXELS = np.random.default_rng(0).integers(0, 256, (6, 9, 3), dtype=np.uint8)


@pytest.fixture
def without_rasterio(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if only the base of the project were installed."""
    monkeypatch.setitem(__import__("sys").modules, "rasterio", None)


def test_without_rasterio_plain_tiffs_are_read_all_the_same(tmp_path: Path, without_rasterio: None) -> None:
    Image.fromarray(PIXELS).save(tmp_path / "a.tif")
    assert np.array_equal(read_rgb(tmp_path / "a.tif"), PIXELS)
    Image.fromarray(PIXELS[..., 0]).save(tmp_path / "a.tif")
    assert np.array_equal(read_rgb(tmp_path / "a.tif")[..., 2], PIXELS[..., 0])


@pytest.mark.parametrize("tag", [42112, 42113])
def test_without_rasterio_a_tiff_that_says_more_is_refused(
    tag: int, tmp_path: Path, without_rasterio: None
) -> None:
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    tags[tag] = "0"
    Image.fromarray(PIXELS).save(tmp_path / "a.tif", tiffinfo=tags)
    with pytest.raises(ExtraMissingError, match=r"wnn2hdl\[geo\]"):
        read_picture(tmp_path / "a.tif")


@pytest.mark.parametrize("mode", ["1", "LA", "P", "RGBA", "CMYK", "I;16", "F"])
def test_without_rasterio_other_tiffs_are_refused(mode: str, tmp_path: Path, without_rasterio: None) -> None:
    kind = {"I;16": np.uint16, "F": np.float32}.get(mode)
    picture = (
        Image.fromarray(PIXELS).convert("RGB").convert(mode)
        if kind is None
        else Image.fromarray(PIXELS[..., 0].astype(kind))
    )
    picture.save(tmp_path / "a.tif")
    with pytest.raises(ExtraMissingError):
        read_picture(tmp_path / "a.tif")


@pytest.mark.parametrize("suffix", [".aux.xml", ".msk"])
def test_without_rasterio_a_file_beside_a_picture_is_not_overlooked(
    suffix: str, tmp_path: Path, without_rasterio: None
) -> None:
    Image.fromarray(PIXELS).save(tmp_path / "a.png")
    (tmp_path / f"a.png{suffix}").write_text("<PAMDataset/>")
    with pytest.raises(ExtraMissingError):
        read_picture(tmp_path / "a.png")


def test_pillow_reads_a_plain_picture_and_gdal_a_raster(tmp_path: Path) -> None:
    pytest.importorskip("rasterio")
    for suffix, plain in ((".png", True), (".jpg", True), (".bmp", True), (".tif", False)):
        Image.fromarray(PIXELS).save(tmp_path / f"a{suffix}")
        kind = {".png": "PNG", ".jpg": "JPEG", ".bmp": "BMP", ".tif": "GTiff"}[suffix]
        assert (plain_head(tmp_path / f"a{suffix}", kind) is not None) == plain


@pytest.mark.parametrize("orientation", range(1, 9))
def test_arrays_are_turned_as_pillow_turns_pictures(orientation: int, tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = orientation
    Image.fromarray(PIXELS).save(tmp_path / "a.png", exif=exif)
    with Image.open(tmp_path / "a.png") as picture:
        expected = np.asarray(ImageOps.exif_transpose(picture))
    assert np.array_equal(turned(PIXELS, orientation), expected)
