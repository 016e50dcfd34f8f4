"""Labelled images from rectangles of one class each, listed in a CSV file."""

import csv
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from wnn2hdl.dataset.labelled import CLASSES, Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.images import picture_size, read_picture
from wnn2hdl.raster import Reading

REGION_COLUMNS = ("chip", "label", "x", "y", "width", "height")

SQUARE_SIDE = 20

SQUARES = 10
"""Squares of 20x20 pixels drawn for each class of an image, as in the reference design."""


@dataclass(frozen=True)
class Region:
    """A rectangle of one class.

    Attributes:
        row: its line in the file.
        label: class index.
        x: left edge in pixels.
        y: top edge in pixels, downwards.
        width: pixels.
        height: pixels.
    """

    row: int
    label: int
    x: int
    y: int
    width: int
    height: int

    def overlaps(self, other: "Region") -> bool:
        """Whether a pixel lies in both."""
        return (
            max(self.x, other.x) < min(self.x + self.width, other.x + other.width)
            and max(self.y, other.y) < min(self.y + self.height, other.y + other.height)
        )  # fmt: skip


def from_regions(
    regions: Path,
    chips: Path,
    *,
    seed: int,
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> Dataset:
    """Squares drawn inside labelled rectangles, as the reference design chose its training pixels.

    For each class of a chip, `SQUARES` squares of `SQUARE_SIDE` are drawn, every place where one fits
    inside a rectangle being equally likely; squares may overlap, and each counts in full. A rectangle too
    small for a square is used whole, once. Pixels of a square that are no data are left out. The draw
    depends on the seed and on the chip's place among the file's chips.

    Args:
        regions: a CSV file with the columns `REGION_COLUMNS`; labels are those of `CLASSES`.
        chips: the folder of the pictures that the column ``chip`` names.
        seed: at least 0.
        reading: how the chips are read.

    Raises:
        InputError: the file cannot be read, or a row is wrong: an unknown chip or label, a number that is
            none, a rectangle that reaches outside its picture or overlaps one of another label.
    """
    by_chip = _read_regions(regions, chips, reading)
    names = tuple(sorted(by_chip))

    def load(name: str) -> LabelledImage:
        rng = np.random.default_rng([seed, names.index(name)])
        picture = read_picture(chips / name, reading)
        parts = []
        for square in _draw_squares(by_chip[name], rng):
            inside = np.s_[square.y : square.y + square.height, square.x : square.x + square.width]
            parts.append((picture.pixels[inside][picture.valid[inside]], square.label))
        pixels = np.concatenate([part for part, _ in parts])
        labels = np.repeat(
            np.array([label for _, label in parts], dtype=np.uint8), [len(part) for part, _ in parts]
        )
        return LabelledImage(name, pixels, labels)

    return Dataset(CLASSES, names, load)


def _draw_squares(regions: list[Region], rng: np.random.Generator) -> Iterator[Region]:
    for label in range(len(CLASSES)):
        mine = [region for region in regions if region.label == label]
        large = [region for region in mine if min(region.width, region.height) >= SQUARE_SIDE]
        yield from (region for region in mine if region not in large)
        if not large:
            continue
        places = np.array([(r.width - SQUARE_SIDE + 1) * (r.height - SQUARE_SIDE + 1) for r in large])
        for chosen in rng.choice(len(large), size=SQUARES, p=places / places.sum()):
            region = large[chosen]
            yield replace(
                region,
                x=region.x + int(rng.integers(region.width - SQUARE_SIDE + 1)),
                y=region.y + int(rng.integers(region.height - SQUARE_SIDE + 1)),
                width=SQUARE_SIDE,
                height=SQUARE_SIDE,
            )


def _read_regions(path: Path, chips: Path, reading: Reading) -> dict[str, list[Region]]:
    by_chip: dict[str, list[Region]] = {}
    sizes: dict[str, tuple[int, int]] = {}
    for line, cells in _rows(path):
        where = f"row {line} of {path}"
        chip, label = cells["chip"], cells["label"]
        if chip not in sizes:
            if Path(chip).name != chip or not (chips / chip).is_file():
                raise InputError(
                    f"{where}: no such chip in {chips}", value=repr(chip), hint="correct its name"
                )
            sizes[chip] = picture_size(chips / chip, reading)
        if label not in CLASSES:
            raise InputError(f"{where}: unknown label", value=repr(label), hint=f"use {' or '.join(CLASSES)}")
        region = Region(
            line, CLASSES.index(label), *(_whole_number(cells, name, where) for name in REGION_COLUMNS[2:])
        )
        _check_region(region, sizes[chip], by_chip.setdefault(chip, []), where)
        by_chip[chip].append(region)
    if not by_chip:
        raise InputError("the file of regions has no rows", value=path, hint="add a labelled rectangle")
    return by_chip


def _rows(path: Path) -> Iterator[tuple[int, dict[str, str]]]:
    """Line number and cells of each row, blanks around a cell removed."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.DictReader(stream, strict=True, restval="")
            columns = [name.strip() for name in reader.fieldnames or ()]
            if Counter(columns) != Counter(REGION_COLUMNS):
                raise InputError(
                    "the file of regions has other columns",
                    value=f"{path} ({','.join(columns)})",
                    hint=f"its first line should be {','.join(REGION_COLUMNS)}",
                )
            reader.fieldnames = columns
            for cells in reader:
                if None in cells:
                    raise InputError(
                        f"row {reader.line_num} of {path} has too many cells", value=len(columns) + 1
                    )
                yield reader.line_num, {name: text.strip() for name, text in cells.items()}
    except OSError as error:
        raise InputError("cannot read the file of regions", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError("the file of regions is not CSV text", value=f"{path} ({error})") from error


def _whole_number(cells: dict[str, str], name: str, where: str) -> int:
    text = cells[name]
    if not (text.isascii() and text.isdigit() and len(text) <= 9):
        raise InputError(f"{where}: {name} is not a whole number of pixels", value=repr(text))
    return int(text)


def _check_region(region: Region, size: tuple[int, int], earlier: list[Region], where: str) -> None:
    height, width = size
    if not region.width or not region.height:
        raise InputError(f"{where}: the rectangle is empty", value=f"{region.width}x{region.height}")
    if region.x + region.width > width or region.y + region.height > height:
        raise InputError(
            f"{where}: the rectangle reaches outside the picture of {width}x{height} pixels",
            value=f"x {region.x}, y {region.y}, {region.width}x{region.height}",
            hint="correct it",
        )
    for other in earlier:
        if other.label != region.label and other.overlaps(region):
            raise InputError(
                f"{where}: the rectangle overlaps that of row {other.row}, which has another label",
                hint="make them disjoint",
            )
