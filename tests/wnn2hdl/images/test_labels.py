"""Masks say of which class a pixel is, or that it is unlabelled, in every way that people write them."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import UNLABELLED, MaskFormat, Palette, parse_code, read_labels, write_png

CLASSES = np.random.default_rng(0).integers(0, 2, (20, 30), dtype=np.uint8)
SEEN = np.arange(30)[np.newaxis] < np.full((20, 1), 24)
"""Which pixels somebody labelled."""
EXPECTED = np.where(SEEN, CLASSES, UNLABELLED)


def read(path: Path, masks: MaskFormat = MaskFormat()) -> NDArray[np.uint8]:  # noqa: B008
    picture = path.with_name("picture.png")
    Image.new("RGB", (30, 20)).save(picture)
    return read_labels(path, picture, (20, 30), masks).classes


def saved(path: Path, array: NDArray[Any], mode: str | None = None) -> Path:
    picture = Image.fromarray(array)
    (picture if mode is None else picture.convert(mode)).save(path)
    return path


def aux(path: Path, nodata: int) -> Path:
    band = f'<PAMRasterBand band="1"><NoDataValue>{nodata}</NoDataValue></PAMRasterBand>'
    path.with_name(path.name + ".aux.xml").write_text(f"<PAMDataset>{band}</PAMDataset>")
    return path


def with_mask(path: Path) -> Path:
    rasterio = pytest.importorskip("rasterio")
    with (
        warnings.catch_warnings(action="ignore"),
        rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True),
        rasterio.open(path, "r+") as target,
    ):
        target.write_mask(SEEN)
    return path


def or_else(value: int, kind: Any = np.uint8) -> NDArray[Any]:
    """0 and 1, another value for unlabelled pixels: ``[1, 20, 30]``."""
    return np.where(SEEN, CLASSES.astype(int), value).astype(kind)[np.newaxis]


WHITE = 255 * CLASSES
STATED: dict[str, Callable[[Any, Path], Path]] = {
    "255 as nodata": lambda save, to: save(or_else(255), "m.tif", nodata=255),
    "-1 as nodata": lambda save, to: save(or_else(-1, np.int8), "m.tif", nodata=-1),
    "255 in .aux.xml": lambda save, to: aux(save(or_else(255), "m.tif"), 255),
    "255 in .aux.xml of a png": lambda save, to: aux(saved(to / "m.png", or_else(255)[0]), 255),
    "not a number": lambda save, to: save(
        np.where(SEEN, CLASSES, np.nan).astype(np.float32)[np.newaxis], "m.tif"
    ),
    "internal mask": lambda save, to: with_mask(save(or_else(255), "m.tif")),
    "alpha": lambda save, to: saved(
        to / "m.png", np.dstack([WHITE] * 3 + [np.where(SEEN, 255, 0).astype(np.uint8)])
    ),
    "grey and alpha": lambda save, to: saved(
        to / "m.png", np.dstack([WHITE] * 3 + [np.where(SEEN, 255, 0).astype(np.uint8)]), "LA"
    ),
}


@pytest.mark.parametrize("way", STATED)
def test_what_the_file_leaves_out_is_unlabelled(way: str, save: Any, tmp_path: Path) -> None:
    assert np.array_equal(read(STATED[way](save, tmp_path)), EXPECTED)


def test_a_transparent_entry_of_a_palette_is_unlabelled(tmp_path: Path) -> None:
    picture = Image.fromarray(np.where(SEEN, CLASSES, 2)).convert("P")
    picture.putpalette([0, 0, 0, 255, 0, 0, 0, 0, 0])
    picture.save(tmp_path / "m.png", transparency=2)
    assert np.array_equal(read(tmp_path / "m.png"), EXPECTED)


@pytest.mark.parametrize(("value", "kind"), [(255, np.uint8), (-1, np.int8), (-9999, np.int16)])
def test_a_third_value_is_refused_unless_it_is_named(value: int, kind: Any, save: Any) -> None:
    path = save(or_else(value, kind), "m.tif")
    with pytest.raises(InputError, match=rf"holds .*{value}.* besides 0, .*; name .* with --ignore VALUE"):
        read(path)
    assert np.array_equal(read(path, MaskFormat(ignored=frozenset({value}))), EXPECTED)


def test_numbers_of_land_cover_products_need_a_palette(tmp_path: Path) -> None:
    """MapBiomas: 3 is forest, 15 pasture, 0 not observed."""
    path = saved(tmp_path / "m.png", np.where(SEEN, np.where(CLASSES, 15, 3), 0).astype(np.uint8))
    with pytest.raises(InputError, match="the mask holds 3, 15 besides 0"):
        read(path)
    palette = Palette(("forest", "deforested"), ((0, 99, 0), (200, 0, 0)), ((3,), (15, 21)), frozenset({0}))
    assert np.array_equal(read(path, MaskFormat(palette)), EXPECTED)


def test_a_negative_value_is_never_deforested(save: Any) -> None:
    with pytest.raises(InputError, match="holds -1 besides 0"):
        read(save(-CLASSES[np.newaxis].astype(np.int8), "m.tif"))


def test_a_few_pixels_of_a_smoothed_outline_are_no_third_value(tmp_path: Path) -> None:
    smoothed = WHITE.copy()
    smoothed[0, 0] = 128
    labels = np.where(smoothed, 1, 0)
    big, expected = np.tile(smoothed, (1, 1)), labels
    # One of 600 pixels is more than a thousandth; one of 2400 is not.
    with pytest.raises(InputError, match="128, 255 besides 0"):
        read(saved(tmp_path / "m.png", big))
    wide = np.concatenate([smoothed] + [WHITE] * 3)
    Image.new("RGB", (30, 80)).save(tmp_path / "picture.png")
    found = read_labels(saved(tmp_path / "m.png", wide), tmp_path / "picture.png", (80, 30), MaskFormat())
    assert np.array_equal(found.classes[:20], expected)
    assert found.foreground == 255


@pytest.mark.parametrize(("value", "label"), [(0, 0), (1, 1), (255, 1)])
def test_masks_are_zero_or_another_value(tmp_path: Path, value: int, label: int) -> None:
    assert (read(saved(tmp_path / "m.png", np.full((20, 30), value, dtype=np.uint8))) == label).all()


@pytest.mark.parametrize("mode", ["1", "L", "P", "RGB"])
def test_masks_are_black_and_white_in_any_mode(mode: str, tmp_path: Path) -> None:
    for suffix in (".png", ".tif", ".bmp"):
        path = tmp_path / f"m{suffix}"
        Image.fromarray(WHITE).convert("RGB").convert(mode).save(path)
        if mode == "P":
            # Pillow's own palette has no black at 0 alone.
            picture = Image.fromarray(CLASSES).convert("P")
            picture.putpalette([0, 0, 0, 255, 255, 255])
            picture.save(path)
        assert np.array_equal(read(path), CLASSES)


def test_a_palette_mask_must_not_have_two_readings(tmp_path: Path) -> None:
    for name in ("m.png", "m.tif"):
        picture = Image.fromarray(CLASSES).convert("P")
        picture.putpalette([255, 255, 255, 0, 0, 0])
        picture.save(tmp_path / name)
        with pytest.raises(InputError, match="palette must have black at index 0"):
            read(tmp_path / name)


def test_a_mask_of_another_size_names_both_sizes(tmp_path: Path) -> None:
    path = saved(tmp_path / "m.png", np.zeros((6, 9), dtype=np.uint8))
    with pytest.raises(InputError, match=r"different sizes: .*m\.png is 9x6, the picture 30x20"):
        read(path)


def test_a_jpeg_mask_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a JPEG cannot be a mask"):
        read(saved(tmp_path / "m.jpg", WHITE))


def test_a_picture_that_is_turned_and_its_mask_that_is_not_are_noticed(tmp_path: Path) -> None:
    """Turned by half a circle both have the same size, and every label would be wrong."""
    exif = Image.Exif()
    exif[0x0112] = 3
    Image.new("RGB", (30, 20)).save(tmp_path / "picture.jpg", exif=exif)
    mask = saved(tmp_path / "m.png", WHITE)
    with pytest.raises(InputError, match=r"have different orientations: .*\(orientation 1\), .*\(3\)"):
        read_labels(mask, tmp_path / "picture.jpg", (20, 30), MaskFormat())
    Image.fromarray(WHITE).save(mask, exif=exif)
    found = read_labels(mask, tmp_path / "picture.jpg", (20, 30), MaskFormat())
    assert np.array_equal(found.classes, CLASSES[::-1, ::-1])


def test_painting_and_reading_labels_are_inverse(tmp_path: Path) -> None:
    palette = Palette.of(("forest", "pasture", "river", "swamp", "town"))
    labels = np.random.default_rng(1).integers(0, 5, (20, 30), dtype=np.uint8)
    write_png(tmp_path / "m.png", palette.paint(labels))
    assert np.array_equal(read(tmp_path / "m.png", MaskFormat(palette)), labels)


def test_a_colour_outside_the_palette_is_named_or_ignored(tmp_path: Path) -> None:
    palette = Palette(("forest", "river"), ((0, 0, 0), (0, 0, 255)))
    colours = np.zeros((20, 30, 3), dtype=np.uint8)
    colours[0, 0] = (1, 2, 3)
    path = saved(tmp_path / "m.png", colours)
    with pytest.raises(InputError, match=r"1 pixels of the mask .* not in the palette: .*m\.png \(#010203\)"):
        read(path, MaskFormat(palette))
    found = read(path, MaskFormat(palette, frozenset({parse_code("#010203")})))
    assert found[0, 0] == UNLABELLED
    assert np.count_nonzero(found) == 1
