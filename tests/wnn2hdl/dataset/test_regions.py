"""Labelled rectangles and the squares drawn inside them."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.dataset import from_regions
from wnn2hdl.dataset.regions import Region
from wnn2hdl.errors import InputError
from wnn2hdl.images import write_png

HEADER = "chip,label,x,y,width,height\n"


@pytest.fixture
def chips(tmp_path: Path) -> Path:
    """One chip, 100 wide and 60 high, whose red is the column and whose green is the row."""
    rgb = np.zeros((60, 100, 3), dtype=np.uint8)
    rgb[..., 0] = np.arange(100)
    rgb[..., 1] = np.arange(60)[:, np.newaxis]
    write_png(tmp_path / "a.png", rgb)
    return tmp_path


def regions(chips: Path, rows: str, header: str = HEADER) -> Path:
    path = chips / "regions.csv"
    path.write_text(header + rows)
    return path


def test_ten_squares_of_twenty_pixels_are_drawn_for_each_class(chips: Path) -> None:
    path = regions(chips, "a.png,forest,0,0,50,60\na.png,deforested,50,10,50,50\n")
    image = from_regions(path, chips, seed=0).load("a.png")
    assert np.bincount(image.labels).tolist() == [4000, 4000]
    column, row = image.pixels[:, 0], image.pixels[:, 1]
    assert (column[image.labels == 0] < 50).all()
    assert (column[image.labels == 1] >= 50).all()
    assert (row[image.labels == 1] >= 10).all()
    for square in image.pixels.reshape(-1, 20, 20, 3):
        assert square[0, -1, 0] - square[0, 0, 0] == 19
        assert square[-1, 0, 1] - square[0, 0, 1] == 19


def test_a_rectangle_too_small_for_a_square_is_used_whole(chips: Path) -> None:
    path = regions(chips, "a.png,forest,3,4,19,40\na.png,deforested,50,0,20,20\n")
    image = from_regions(path, chips, seed=0).load("a.png")
    assert np.bincount(image.labels).tolist() == [19 * 40, 4000]
    assert len(np.unique(image.pixels[image.labels == 0], axis=0)) == 19 * 40


def test_the_seed_decides_the_squares(chips: Path) -> None:
    path = regions(chips, "a.png,forest,0,0,100,60\n")
    one, same, other = (from_regions(path, chips, seed=seed).load("a.png").pixels for seed in (0, 0, 1))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)


def test_a_subset_draws_the_same_squares(chips: Path) -> None:
    write_png(chips / "b.png", np.zeros((30, 30, 3), dtype=np.uint8))
    path = regions(chips, "b.png,deforested,0,0,30,30\na.png,forest,0,0,100,60\n")
    dataset = from_regions(path, chips, seed=0)
    assert dataset.names == ("a.png", "b.png")
    assert np.array_equal(next(iter(dataset.subset(["a.png"]))).pixels, dataset.load("a.png").pixels)


def test_columns_may_stand_in_any_order_with_blanks_and_a_byte_order_mark(chips: Path) -> None:
    path = regions(chips, "20, 20, 0, 0, forest, a.png\n", header="\ufeffwidth, height, x, y, label, chip\n")
    assert len(from_regions(path, chips, seed=0).load("a.png").labels) == 4000


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("b.png,forest,0,0,20,20", r"row 3 of .*regions\.csv: no such chip in .*: 'b\.png'"),
        ("../a.png,forest,0,0,20,20", r"row 3 .*: no such chip"),
        ("a.png,Forest,0,0,20,20", r"row 3 .*: unknown label: 'Forest'; use forest or deforested"),
        ("a.png,forest,1.5,0,20,20", r"row 3 .*: x is not a whole number of pixels: '1\.5'"),
        ("a.png,forest,0,-1,20,20", r"row 3 .*: y is not a whole number of pixels: '-1'"),
        ("a.png,forest,0,0,20", r"row 3 .*: height is not a whole number of pixels: ''"),
        ("a.png,forest,0,0,20,20,7", r"row 3 .* too many cells"),
        ("a.png,forest,0,0,0,20", r"row 3 .*: the rectangle is empty: 0x20"),
        ("a.png,forest,81,0,20,20", r"row 3 .*: .*outside the picture of 100x60 pixels: x 81, y 0, 20x20"),
        ("a.png,forest,0,41,20,20", r"row 3 .*: .*outside the picture of 100x60 pixels"),
        ("a.png,deforested,19,19,20,20", r"row 3 .*: the rectangle overlaps that of row 2"),
    ],
)
def test_a_wrong_row_is_numbered_and_explained(chips: Path, row: str, message: str) -> None:
    path = regions(chips, f"a.png,forest,0,0,20,20\n{row}\n")
    with pytest.raises(InputError, match=message):
        from_regions(path, chips, seed=0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"has other columns"),
        (b"chip;label;x;y;width;height\n", r"its first line should be chip,label,x,y,width,height"),
        (HEADER.encode(), r"has no rows"),
        (b"\xff\xfe\x00", r"is not CSV text"),
        (HEADER.encode() + b'a.png,"forest,0,0,20,20\n', r"is not CSV text"),
    ],
)
def test_a_file_that_is_no_list_of_regions_is_refused(chips: Path, content: bytes, message: str) -> None:
    path = chips / "regions.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        from_regions(path, chips, seed=0)


def test_a_missing_file_is_named(chips: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read the file of regions: .*gone\.csv \(No such file"):
        from_regions(chips / "gone.csv", chips, seed=0)


@given(st.lists(st.integers(0, 6), min_size=8, max_size=8))
def test_overlap_is_a_shared_pixel(numbers: list[int]) -> None:
    one, other = (Region(0, 0, x, y, w + 1, h + 1) for x, y, w, h in (numbers[:4], numbers[4:]))
    field = np.zeros((16, 16), dtype=np.int64)
    for region in (one, other):
        field[region.y : region.y + region.height, region.x : region.x + region.width] += 1
    assert one.overlaps(other) == (field.max() == 2)


@pytest.mark.realdata
def test_the_published_regions_can_be_used(realdata: Path) -> None:
    dataset = from_regions(realdata / "paper" / "regions.csv", realdata / "paper" / "chips", seed=0)
    assert len(dataset) == 8
    labels = np.concatenate([image.labels for image in dataset])
    assert np.bincount(labels).tolist() == [20000, 28000]
