"""Pictures and masks are read as they are, or refused with one clear line."""

import struct
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image, TiffImagePlugin

from wnn2hdl.errors import InputError
from wnn2hdl.images import (
    list_images,
    picture_size,
    read_rgb,
)

RGB = np.random.default_rng(0).integers(0, 256, (6, 9, 3), dtype=np.uint8)


def save(path: Path, array: NDArray[np.uint8]) -> Path:
    Image.fromarray(array).save(path)
    return path


def deep_png(path: Path, channels: int) -> Path:
    """A 16-bit PNG; Pillow cannot write RGB ones."""
    array = (np.arange(6 * 9 * channels).reshape(6, 9, channels) * 97).astype(np.uint16)
    path.write_bytes(cv2.imencode(".png", array)[1].tobytes())
    return path


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.bmp"])
def test_rgb_comes_back_as_written(tmp_path: Path, name: str) -> None:
    assert np.array_equal(read_rgb(save(tmp_path / name, RGB)), RGB)


def test_grey_becomes_three_equal_channels(tmp_path: Path) -> None:
    grey = RGB[..., 0]
    assert np.array_equal(read_rgb(save(tmp_path / "a.png", grey)), np.stack([grey] * 3, axis=2))


def test_a_palette_is_looked_up(tmp_path: Path) -> None:
    picture = Image.fromarray(np.array([[0, 1], [1, 0]], dtype=np.uint8)).convert("P")
    picture.putpalette([10, 20, 30, 200, 100, 0])
    picture.save(tmp_path / "a.png")
    assert read_rgb(tmp_path / "a.png").tolist() == [
        [[10, 20, 30], [200, 100, 0]],
        [[200, 100, 0], [10, 20, 30]],
    ]


def test_cmyk_without_black_is_the_complement(tmp_path: Path) -> None:
    cmyk = np.zeros((8, 8, 4), dtype=np.uint8)
    cmyk[..., :3] = (217, 203, 212)
    Image.frombytes("CMYK", (8, 8), cmyk.tobytes()).save(tmp_path / "a.tif")
    assert (read_rgb(tmp_path / "a.tif") == (38, 52, 43)).all()


def test_opaque_alpha_is_dropped(tmp_path: Path) -> None:
    opaque = np.dstack([RGB, np.full(RGB.shape[:2], 255, dtype=np.uint8)])
    assert np.array_equal(read_rgb(save(tmp_path / "a.png", opaque)), RGB)


def test_transparent_pixels_are_refused(tmp_path: Path) -> None:
    alpha = np.full(RGB.shape[:2], 255, dtype=np.uint8)
    alpha[0, :2] = 254
    path = save(tmp_path / "a.png", np.dstack([RGB, alpha]))
    with pytest.raises(InputError, match="2 pixels of the picture are transparent"):
        read_rgb(path)


@pytest.mark.parametrize("array", [RGB, RGB[..., 0]], ids=["rgb", "grey"])
def test_pixels_without_data_are_refused(tmp_path: Path, array: NDArray[np.uint8]) -> None:
    path, tags = tmp_path / "a.tif", TiffImagePlugin.ImageFileDirectory_v2()
    tags[42113] = "7"  # GDAL_NODATA
    holed = np.where(array == 7, np.uint8(8), array)
    holed[0, 0] = 8 if array.ndim == 2 else (7, 7, 8)
    Image.fromarray(holed).save(path, tiffinfo=tags)
    assert read_rgb(path).shape == RGB.shape
    holed[0, :2] = 7
    Image.fromarray(holed).save(path, tiffinfo=tags)
    with pytest.raises(InputError, match="2 pixels of the picture hold no data"):
        read_rgb(path)


@pytest.mark.parametrize("channels", [1, 3])
def test_a_png_of_16_bits_is_refused(tmp_path: Path, channels: int) -> None:
    with pytest.raises(InputError, match=r"samples of 16 bits: .*a\.png; scale it to 8 bits"):
        read_rgb(deep_png(tmp_path / "a.png", channels))


def test_a_planar_tiff_of_16_bits_is_refused(tmp_path: Path) -> None:
    """Pillow opens one as 8-bit RGB and mixes high and low bytes up."""
    tags = [(256, 3, 1, 9), (257, 3, 1, 6), (262, 3, 1, 2), (277, 3, 1, 3), (284, 3, 1, 2)]
    plane = 9 * 6 * 2
    data = 8 + 2 + 12 * 8 + 4
    head = struct.pack("<2sHIH", b"II", 42, 8, 8)
    entries = sorted(
        [*tags, (258, 3, 3, data), (273, 4, 3, data + 6), (279, 4, 3, data + 18)], key=lambda entry: entry[0]
    )
    body = b"".join(struct.pack("<HHII", *entry) for entry in entries) + struct.pack("<I", 0)
    start = data + 30
    extra = struct.pack("<3H3I3I", 16, 16, 16, *(start + plane * i for i in range(3)), *[plane] * 3)
    (tmp_path / "a.tif").write_bytes(head + body + extra + bytes(3 * plane))
    with pytest.raises(InputError, match="samples of 16 bits"):
        read_rgb(tmp_path / "a.tif")


def test_float_pictures_are_refused(tmp_path: Path) -> None:
    Image.fromarray(np.zeros((3, 3), dtype=np.float32)).save(tmp_path / "a.tif")
    with pytest.raises(InputError, match="samples of 32 bits"):
        read_rgb(tmp_path / "a.tif")


def test_pictures_are_turned_upright(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    for name in ("a.png", "a.tif"):
        Image.fromarray(RGB).save(tmp_path / name, exif=exif)
        assert np.array_equal(read_rgb(tmp_path / name), np.rot90(RGB, -1))
        assert picture_size(tmp_path / name) == (9, 6)


def test_a_text_file_named_png_is_no_picture(tmp_path: Path) -> None:
    path = tmp_path / "notes.png"
    path.write_text("not a picture")
    with pytest.raises(InputError, match=r"not a picture that can be read: .*notes\.png; give a PNG"):
        read_rgb(path)


def test_a_missing_picture_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read the picture: .*gone\.png \(No such file"):
        read_rgb(tmp_path / "gone.png")


@pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.tif", "a.bmp"])
@given(share=st.floats(0, 0.9))
@settings(max_examples=25)
def test_truncated_pictures_give_one_line(
    tmp_path_factory: pytest.TempPathFactory, name: str, share: float
) -> None:
    path = save(tmp_path_factory.mktemp("cut") / name, np.tile(RGB, (4, 4, 1)))
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError) as caught:
        read_rgb(path)
    assert "\n" not in str(caught.value)
    assert name in str(caught.value)


def test_a_picture_beyond_the_safety_limit_is_refused(tmp_path: Path) -> None:
    path = save(tmp_path / "a.bmp", RGB)
    content = bytearray(path.read_bytes())
    content[18:26] = struct.pack("<ii", 100_000, 100_000)
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"too large to be read at once: .*; cut it into tiles"):
        read_rgb(path)


def test_a_large_map_is_read_without_a_warning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pillow warns between its limit and twice its limit; warnings are errors in this suite."""
    path = save(tmp_path / "a.png", RGB)
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", RGB.size // 3 - 1)
    assert read_rgb(path).shape == RGB.shape


@pytest.mark.realdata
def test_geotiffs_are_read_as_another_reader_does(realdata: Path) -> None:
    for path in list_images(realdata / "amazon_masks" / "images")[:5]:
        other = cv2.imread(str(path))
        assert other is not None
        assert np.array_equal(read_rgb(path), other[..., ::-1])
        assert picture_size(path) == (512, 512)


@pytest.mark.realdata
def test_cmyk_chips_of_forest_are_dark_and_green(realdata: Path) -> None:
    red, green, blue = read_rgb(realdata / "paper" / "chips" / "forest1.jpg").mean(axis=(0, 1))
    assert green < 80
    assert green > max(red, blue)
