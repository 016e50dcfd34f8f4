"""Windows of rasters of every kind, as red, green and blue of 8 bits."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import ExtraMissingError, InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.raster import Georeference, RasterReader, Reading
from wnn2hdl.raster.reading import scaled

rasterio = pytest.importorskip("rasterio")


def whole(path: Path, reading: Reading = Reading()) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:  # noqa: B008
    reader = RasterReader(path, reading)
    return reader.read(0, 0, reader.height, reader.width)


def test_windows_are_parts_of_the_whole(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene, photometric="rgb", tiled=True, blockxsize=16, blockysize=16)
    reader = RasterReader(path, Reading())
    assert (reader.height, reader.width, reader.block) == (40, 70, (16, 16))
    picture, valid = reader.read(5, 11, 20, 30)
    assert valid is None
    assert np.array_equal(picture, np.moveaxis(scene, 0, 2)[5:25, 11:41])


def test_threads_may_read_at_once(save: Any, scene: NDArray[np.uint8]) -> None:
    reader = RasterReader(save(scene, photometric="rgb", compress="deflate"), Reading())
    with ThreadPoolExecutor(4) as pool:
        rows = pool.map(lambda row: reader.read(row % 40, 0, 1, 70)[0], range(400))
        assert all(np.array_equal(x[0], scene[:, row % 40].T) for row, x in enumerate(rows))


@pytest.mark.parametrize(
    ("suffix", "mode"),
    [
        *((".png", mode) for mode in ("1", "L", "LA", "P", "RGB", "RGBA")),
        *((".tif", mode) for mode in ("1", "L", "LA", "P", "RGB", "RGBA", "CMYK")),
        *((".jpg", mode) for mode in ("L", "RGB", "CMYK")),
    ],
)
def test_every_mode_reads_as_pictures_do(suffix: str, mode: str, tmp_path: Path) -> None:
    colours = np.random.default_rng(1).integers(0, 256, (16, 24, 3), dtype=np.uint8)
    picture = Image.fromarray(colours).convert("L" if mode == "1" else "RGB").convert(mode)
    path = tmp_path / f"picture{suffix}"
    # GDAL and Pillow differ in how they draw up a JPEG's colours that were stored at half size.
    picture.save(path, subsampling=0)
    pixels, valid = whole(path)
    assert valid is None or valid.all()
    assert np.array_equal(pixels, read_rgb(path))


def test_transparent_pixels_are_not_valid(tmp_path: Path) -> None:
    pixels = np.full((4, 6, 4), 255, dtype=np.uint8)
    pixels[1, 2, 3], pixels[2, 3, 3] = 0, 254
    Image.fromarray(pixels).save(tmp_path / "a.png")
    _, valid = whole(tmp_path / "a.png")
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[1, 2], [2, 3]]
    palette = Image.fromarray(np.arange(24, dtype=np.uint8).reshape(4, 6)).convert("P")
    palette.save(tmp_path / "p.png", transparency=7)
    _, valid = whole(tmp_path / "p.png")
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[1, 1]]


def test_nodata_is_not_valid_where_all_bands_have_it(save: Any, scene: NDArray[np.uint8]) -> None:
    scene[scene == 0] = 1
    scene[:, 3, 4], scene[0, 5, 6] = 0, 0
    _, valid = whole(save(scene, photometric="rgb", nodata=0))
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[3, 4]]


def test_the_files_own_mask_counts(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene, photometric="rgb", transform=rasterio.Affine(10, 0, 0, 0, -10, 0))
    mask = np.full((40, 70), 255, dtype=np.uint8)
    mask[10:, :5] = 0
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True), rasterio.open(path, "r+") as target:
        target.write_mask(mask)
    _, valid = whole(path)
    assert valid is not None
    assert np.array_equal(valid, mask == 255)


def test_a_cloud_mask_takes_pixels_out(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    clouds = np.zeros((40, 70), dtype=np.uint8)
    clouds[20:, 30:] = 3
    Image.fromarray(clouds).save(tmp_path / "clouds.png")
    path = save(scene, photometric="rgb")
    picture, valid = whole(path, Reading(mask=tmp_path / "clouds.png"))
    assert np.array_equal(picture, np.moveaxis(scene, 0, 2))
    assert valid is not None
    assert np.array_equal(valid, clouds == 0)


def test_a_cloud_mask_takes_pixels_out_of_indexed_colours(tmp_path: Path) -> None:
    Image.fromarray(np.arange(24, dtype=np.uint8).reshape(4, 6)).convert("P").save(tmp_path / "a.png")
    clouds = np.zeros((4, 6), dtype=np.uint8)
    clouds[2, 3] = 1
    Image.fromarray(clouds).save(tmp_path / "clouds.png")
    _, valid = whole(tmp_path / "a.png", Reading(mask=tmp_path / "clouds.png"))
    assert valid is not None
    assert np.array_equal(valid, clouds == 0)


def test_a_masks_alpha_is_no_cloud(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    clouds = np.zeros((40, 70, 2), dtype=np.uint8)
    clouds[:10, :, 0], clouds[..., 1] = 255, 255
    Image.fromarray(clouds).save(tmp_path / "clouds.png")
    _, valid = whole(save(scene, photometric="rgb"), Reading(mask=tmp_path / "clouds.png"))
    assert valid is not None
    assert np.array_equal(valid, clouds[..., 0] == 0)


def test_a_colour_table_of_more_than_256_colours_is_refused(save: Any) -> None:
    path = save(np.zeros((1, 4, 5), np.uint16), photometric="palette")
    with pytest.raises(InputError, match=r"colour table is of uint16 .*gdal_translate -expand rgb"):
        RasterReader(path, Reading())


def test_further_pages_are_told(tmp_path: Path) -> None:
    pages = [Image.new("RGB", (5, 4), (level, 0, 0)) for level in (10, 20)]
    pages[0].save(tmp_path / "a.tif", save_all=True, append_images=pages[1:])
    reader = RasterReader(tmp_path / "a.tif", Reading())
    assert reader.note == "the file holds 2 pictures; the first one is read"
    assert reader.read(0, 0, 4, 5)[0][0, 0].tolist() == [10, 0, 0]


def test_all_files_of_a_picture_are_named(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    path = save(scene, photometric="rgb")
    path.with_suffix(".tfw").write_text("1\n0\n0\n-1\n0\n0\n")
    Image.fromarray(scene[0]).save(tmp_path / "clouds.png")
    files = RasterReader(path, Reading(mask=tmp_path / "clouds.png")).files
    assert {file.name for file in files} >= {path.name, path.with_suffix(".tfw").name, "clouds.png"}


def test_a_mask_that_does_not_fit_is_refused(save: Any, scene: NDArray[np.uint8], tmp_path: Path) -> None:
    path = save(scene, photometric="rgb", crs="EPSG:32720", transform=rasterio.Affine(10, 0, 0, 0, -10, 0))
    Image.new("L", (40, 70)).save(tmp_path / "turned.png")
    with pytest.raises(InputError, match=r"40x70, the picture 70x40"):
        RasterReader(path, Reading(mask=tmp_path / "turned.png"))
    Image.new("L", (70, 40)).save(tmp_path / "lossy.jpg")
    with pytest.raises(InputError, match="JPEG cannot be a mask"):
        RasterReader(path, Reading(mask=tmp_path / "lossy.jpg"))
    elsewhere = rasterio.Affine(10, 0, 10, 0, -10, 0)
    moved = save(scene[:1], "moved.tif", crs="EPSG:32720", transform=elsewhere)
    with pytest.raises(InputError, match="different places"):
        RasterReader(path, Reading(mask=moved))


def test_deep_samples_need_a_scale(save: Any) -> None:
    deep = np.arange(3 * 600, dtype=np.uint16).reshape(3, 20, 30) * 7
    path = save(deep, photometric="rgb")
    with pytest.raises(InputError, match=r"uint16.*\(0 to 12593 in a sample\); say --scale"):
        RasterReader(path, Reading())
    picture, valid = whole(path, Reading(scale=(100, 3000)))
    expected = np.clip(np.rint((np.moveaxis(deep, 0, 2).astype(float) - 100) * (255 / 2900)), 0, 255)
    assert valid is None
    assert np.array_equal(picture, expected)


def test_numbers_that_are_none_are_not_valid(save: Any) -> None:
    samples = np.linspace(0, 1, 3 * 600, dtype=np.float32).reshape(3, 20, 30)
    samples[1, 4, 5], samples[2, 6, 7] = np.nan, np.inf
    picture, valid = whole(save(samples, photometric="rgb"), Reading(scale=(0, 1)))
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[4, 5], [6, 7]]
    assert picture[19, 29, 2] == 255
    with pytest.raises(InputError, match="0 to 1 in a sample"):
        RasterReader(save(samples, photometric="rgb"), Reading())


def test_complex_samples_are_refused_scaled_or_not(save: Any) -> None:
    path = save(np.ones((3, 20, 30), dtype=np.complex64), photometric="rgb")
    for reading in (Reading(), Reading(scale=(0, 1))):
        with pytest.raises(InputError, match="the samples are complex"):
            RasterReader(path, reading)


def test_levels_that_mean_white_by_zero_are_refused(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene[:1], photometric="miniswhite")
    with pytest.raises(InputError, match="0 is white"):
        RasterReader(path, Reading())
    # Of one bit GDAL makes a palette, which says so itself.
    picture, _ = whole(save(scene[:1] & 1, "fax.tif", photometric="miniswhite", nbits=1))
    assert np.array_equal(picture[..., 0], np.where(scene[0] & 1, 0, 255))


@pytest.mark.parametrize("kind", ["int8", "int16", "uint16", "uint8"])
def test_scaling_by_table_is_scaling_by_arithmetic(kind: str) -> None:
    limits = np.iinfo(kind)
    values = np.random.default_rng(2).integers(limits.min, limits.max, 500, endpoint=True).astype(kind)
    low, high = float(np.quantile(values, 0.2)), float(np.quantile(values, 0.7))
    expected = np.clip(np.rint((values.astype(float) - low) * (255 / (high - low))), 0, 255)
    assert np.array_equal(scaled(values, low, high), expected)


def test_chosen_bands_are_read_in_their_order(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(np.concatenate([scene, scene[:1] // 2]), photometric="minisblack", alpha="no")
    with pytest.raises(InputError, match="say --bands"):
        RasterReader(path, Reading())
    picture, _ = whole(path, Reading(bands=(3, 2, 1)))
    assert np.array_equal(picture, np.moveaxis(scene[::-1], 0, 2))
    grey, _ = whole(path, Reading(bands=(4,)))
    assert np.array_equal(grey, np.repeat(scene[0, ..., np.newaxis] // 2, 3, axis=2))


def test_what_the_file_says_about_colours_is_followed(save: Any, scene: NDArray[np.uint8]) -> None:
    picture, _ = whole(save(scene, colours="blue green red"))
    assert np.array_equal(picture, np.moveaxis(scene[::-1], 0, 2))


def test_the_place_on_the_earth_is_kept(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene, photometric="rgb", crs="EPSG:32720", transform=rasterio.Affine(10, 1, 5, 2, -10, 7))
    expected = Georeference(rasterio.crs.CRS.from_epsg(32720).to_wkt(), (10, 1, 5, 2, -10, 7))
    assert RasterReader(path, Reading()).georeference == expected
    nowhere = save(scene, "nowhere.tif", photometric="rgb")
    assert RasterReader(nowhere, Reading()).georeference == Georeference(None, None)


def test_thinned_pictures_show_the_nearest_pixels(save: Any, scene: NDArray[np.uint8]) -> None:
    reader = RasterReader(save(scene, photometric="rgb"), Reading())
    assert np.array_equal(reader.thinned(8, 14), np.moveaxis(scene, 0, 2)[2::5, 2::5])


def test_a_picture_that_is_to_be_turned_is_not_read_in_windows(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("RGB", (20, 10)).save(tmp_path / "held.jpg", exif=exif)
    with pytest.raises(InputError, match="orientation 6"):
        RasterReader(tmp_path / "held.jpg", Reading()).require_upright()
    Image.new("RGB", (20, 10)).save(tmp_path / "upright.jpg")
    RasterReader(tmp_path / "upright.jpg", Reading()).require_upright()


def test_a_large_picture_draws_no_warning(
    monkeypatch: pytest.MonkeyPatch, save: Any, scene: NDArray[np.uint8]
) -> None:
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", scene[0].size - 1)
    RasterReader(save(scene, photometric="rgb"), Reading()).require_upright()


def test_what_is_no_raster_is_one_line(tmp_path: Path, save: Any, scene: NDArray[np.uint8]) -> None:
    with pytest.raises(InputError, match="no such file"):
        RasterReader(tmp_path / "none.tif", Reading())
    (tmp_path / "text.tif").write_text("hello")
    with pytest.raises(InputError, match=r"text\.tif"):
        RasterReader(tmp_path / "text.tif", Reading())
    cut = save(np.tile(scene, (1, 20, 20)), photometric="rgb", compress="deflate")
    cut.write_bytes(cut.read_bytes()[:-100_000])
    with pytest.raises(InputError, match=r"scene\.tif"):
        whole(cut)


def test_without_rasterio_the_extra_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(__import__("sys").modules, "rasterio", None)
    with pytest.raises(ExtraMissingError, match=r"wnn2hdl\[geo\]"):
        RasterReader(tmp_path / "a.tif", Reading())
