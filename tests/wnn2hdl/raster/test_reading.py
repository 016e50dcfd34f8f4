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
from wnn2hdl.raster.reading import require_upright, stored_orientation

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


def test_chosen_bands_are_read_in_their_order(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(np.concatenate([scene, scene[:1] // 2]), photometric="minisblack", alpha="no")
    with pytest.raises(InputError, match="give --bands"):
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


def upright(path: Path) -> None:
    RasterReader(path, Reading())
    require_upright(path, stored_orientation(path))


def test_a_picture_that_is_to_be_turned_is_not_read_in_windows(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("RGB", (20, 10)).save(tmp_path / "held.jpg", exif=exif)
    with pytest.raises(InputError, match="orientation 6"):
        upright(tmp_path / "held.jpg")
    Image.new("RGB", (20, 10)).save(tmp_path / "upright.jpg")
    upright(tmp_path / "upright.jpg")


def test_a_large_picture_draws_no_warning(
    monkeypatch: pytest.MonkeyPatch, save: Any, scene: NDArray[np.uint8]
) -> None:
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", scene[0].size - 1)
    upright(save(scene, photometric="rgb"))


def test_what_is_no_raster_is_one_line(tmp_path: Path, save: Any, scene: NDArray[np.uint8]) -> None:
    with pytest.raises(InputError, match="No such file"):
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
