"""Pictures and masks are read as they are, or refused with one clear line."""

import struct
import warnings
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import list_images, picture_size, read_picture, read_rgb, whole_windows
from wnn2hdl.raster import Reading

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


def test_transparent_pixels_are_left_out(tmp_path: Path) -> None:
    alpha = np.full(RGB.shape[:2], 255, dtype=np.uint8)
    alpha[0, :2] = 254
    path = save(tmp_path / "a.png", np.dstack([RGB, alpha]))
    assert np.array_equal(read_picture(path).valid, alpha == 255)
    assert read_picture(path).left_out == 2
    assert read_picture(path, Reading(alpha="data")).left_out == 0
    with pytest.raises(InputError, match="2 pixels of the picture without data, and a whole one is needed"):
        read_rgb(path)


def test_near_infrared_in_the_alpha_of_a_png_is_questioned(tmp_path: Path) -> None:
    infrared = np.arange(54, dtype=np.uint8).reshape(6, 9) + 100
    path = save(tmp_path / "a.png", np.dstack([RGB, infrared]))
    with pytest.raises(InputError, match="give --alpha data"):
        read_picture(path)
    assert read_picture(path, Reading(alpha="exclude")).left_out == 54


@pytest.mark.parametrize("channels", [1, 3])
def test_a_png_of_16_bits_needs_a_scale(tmp_path: Path, channels: int) -> None:
    path = deep_png(tmp_path / "a.png", channels)
    with pytest.raises(InputError, match=r"uint16, and it is not said how .*a\.png"):
        read_rgb(path)
    assert read_rgb(path, Reading(scale=(0, 97 * 53 * channels))).max() == 255


def test_a_mask_beside_a_png_counts(tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    path, mask = save(tmp_path / "a.png", RGB), tmp_path / "a.png.msk"
    Image.fromarray(np.uint8(255) * (RGB[..., 0] > 99)).save(mask, format="TIFF")
    with pytest.raises(InputError, match=r"does not say which of its bands it is for: .*a\.png\.msk"):
        read_picture(path)
    with warnings.catch_warnings(action="ignore"), rasterio.open(mask, "r+") as target:
        target.update_tags(INTERNAL_MASK_FLAGS_1=2, INTERNAL_MASK_FLAGS_2=2, INTERNAL_MASK_FLAGS_3=2)
    assert np.array_equal(read_picture(path).valid, RGB[..., 0] > 99)
    assert np.array_equal(read_picture(path).pixels, RGB)


def test_a_turned_picture_is_shown_upright_unless_it_lies_on_the_earth(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(RGB).save(tmp_path / "a.png", exif=exif)
    assert np.array_equal(read_rgb(tmp_path / "a.png"), np.rot90(RGB, -1))
    assert picture_size(tmp_path / "a.png") == (9, 6)
    Image.fromarray(RGB).save(tmp_path / "a.tif", exif=exif)
    with pytest.raises(InputError, match="orientation 6"):
        read_rgb(tmp_path / "a.tif")


def test_windows_are_whole_where_all_they_see_is_data() -> None:
    valid = np.ones((5, 6), dtype=np.bool_)
    valid[2, 2] = False
    assert np.argwhere(~whole_windows(valid, 1)).tolist() == [[r, c] for r in (1, 2, 3) for c in (1, 2, 3)]
    assert whole_windows(np.ones((2, 2), dtype=np.bool_), 2).all()
    assert whole_windows(valid, 0) is valid


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


@pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.tif", "a.bmp"])
@given(
    share=st.floats(0.2, 1), flips=st.lists(st.tuples(st.floats(0, 0.999), st.integers(1, 255)), max_size=4)
)
@settings(max_examples=40, deadline=None)
def test_damaged_pictures_are_read_or_give_one_line(
    tmp_path_factory: pytest.TempPathFactory, name: str, share: float, flips: list[tuple[float, int]]
) -> None:
    path = save(tmp_path_factory.mktemp("damaged") / name, np.tile(RGB, (4, 4, 1)))
    content = bytearray(path.read_bytes())[: int(share * path.stat().st_size)]
    for place, change in flips:
        content[int(place * len(content))] ^= change
    path.write_bytes(content)
    complaint = ""
    try:
        read_picture(path)
    except InputError as error:
        complaint = str(error)
    assert not complaint or (name in complaint and "\n" not in complaint)


@pytest.mark.parametrize("name", ["a.bmp", "a.tif"])
def test_a_picture_beyond_the_safety_limit_is_refused(tmp_path: Path, name: str) -> None:
    if name == "a.bmp":
        path = save(tmp_path / name, RGB)
        content = bytearray(path.read_bytes())
        content[18:26] = struct.pack("<ii", 100_000, 100_000)
        path.write_bytes(content)
    else:
        rasterio = pytest.importorskip("rasterio")
        path, size = tmp_path / name, {"height": 20_000, "width": 20_000, "count": 1, "dtype": "uint8"}
        place = {"crs": "EPSG:32720", "transform": rasterio.Affine(1, 0, 5, 0, -1, 5)}
        options = {"driver": "GTiff", "sparse_ok": True, "tiled": True}
        rasterio.open(path, "w", **options, **size, **place).close()
    with pytest.raises(
        InputError, match=r"too large to be read at once; the limit is 178,956,970 .*; cut it"
    ):
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
