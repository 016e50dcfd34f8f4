"""Pictures in windows are the same as whole ones."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import PlainPicture, open_picture, read_rgb
from wnn2hdl.raster import Reading
from wnn2hdl.samples import landscape


@pytest.fixture
def pixels() -> NDArray[np.uint8]:
    """A landscape of 150 x 210 pixels."""
    return landscape(150, 210, seed=3).image


def read(path: Path, reading: Reading | None = None) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
    source = open_picture(path, reading or Reading())
    return source.read(0, 0, source.height, source.width)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_pictures_are_turned_upright(
    orientation: int, suffix: str, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    exif = Image.Exif()
    exif[0x0112] = orientation
    path = tmp_path / f"held{suffix}"
    Image.fromarray(pixels).save(path, exif=exif)
    picture, valid = read(path)
    assert valid is None
    assert np.array_equal(picture, read_rgb(path))


@pytest.mark.parametrize(
    "options", [{"quality": 60}, {"quality": 90, "progressive": True}, {"subsampling": 1}, {"mode": "CMYK"}]
)
def test_jpegs_are_decoded_as_in_training(
    options: dict[str, Any], pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    mode = options.pop("mode", "RGB") if "mode" in options else "RGB"
    Image.fromarray(pixels).convert(mode).save(tmp_path / "a.jpg", **options)
    assert np.array_equal(read(tmp_path / "a.jpg")[0], read_rgb(tmp_path / "a.jpg"))
    Image.fromarray((pixels[..., 0] > 90).astype(np.uint8)).save(tmp_path / "clouds.png")
    picture, valid = read(tmp_path / "a.jpg", Reading(exclude=tmp_path / "clouds.png"))
    assert np.array_equal(picture, read_rgb(tmp_path / "a.jpg"))
    assert valid is not None
    assert np.array_equal(valid, pixels[..., 0] <= 90)


def test_a_mask_for_a_picture_that_is_turned_has_two_readings(
    pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    exif = Image.Exif()
    exif[0x0112] = 3
    Image.fromarray(pixels).save(tmp_path / "a.jpg", exif=exif)
    Image.fromarray(pixels[..., 0]).save(tmp_path / "clouds.png")
    with pytest.raises(InputError, match="orientation 3"):
        open_picture(tmp_path / "a.jpg", Reading(exclude=tmp_path / "clouds.png"))


def test_a_world_file_locates_a_picture_that_is_not_turned(pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    (tmp_path / "a.pgw").write_text("0.5\n0\n0\n-0.5\n100.25\n199.75\n")
    Image.fromarray(pixels).save(tmp_path / "a.png")
    assert open_picture(tmp_path / "a.png", Reading()).georeference.transform == (0.5, 0, 100, 0, -0.5, 200)
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(pixels).save(tmp_path / "a.png", exif=exif)
    assert open_picture(tmp_path / "a.png", Reading()).georeference.transform is None


def test_large_pictures_are_read_in_windows(
    pixels: NDArray[np.uint8], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wnn2hdl.images.sources.PLAIN_PIXELS", pixels.size // 3 - 1)
    Image.fromarray(pixels).save(tmp_path / "a.png")
    source = open_picture(tmp_path / "a.png", Reading())
    assert not isinstance(source, PlainPicture)
    assert np.array_equal(source.read(3, 4, 50, 60)[0], pixels[3:53, 4:64])


def test_thinned_pictures_show_the_nearest_pixels(pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    assert np.array_equal(PlainPicture(pixels).thinned(30, 42), pixels[2::5, 2::5])
    Image.fromarray(pixels).save(tmp_path / "a.tif")
    in_windows = open_picture(tmp_path / "a.tif", Reading()).thinned(30, 42)
    assert np.array_equal(in_windows, pixels[2::5, 2::5])


@pytest.mark.realdata
def test_real_pictures_are_read_as_in_training(realdata: Path) -> None:
    for name in ("paper/earthimage.jpg", "paper/chips/forest1.jpg", "amazon_masks/images/Amazon_5_50.tif"):
        assert np.array_equal(read(realdata / name)[0], read_rgb(realdata / name))
