"""Class rasters: read in strips of rows, so that size does not matter."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.files import make_folder
from wnn2hdl.raster import NODATA
from wnn2hdl.raster.gdal import gdal, open_raster

if TYPE_CHECKING:
    from rasterio.io import DatasetReader

STRIP_PIXELS = 1 << 22
"""Pixels of a strip: with what is made of them, some 100 MB."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Some rows of a class raster, over its whole width.

    Attributes:
        row: the first of them.
        classes: uint8 ``[rows, width]``, class indices.
        valid: bool ``[rows, width]``, False where the raster has no data.
    """

    row: int
    classes: NDArray[np.uint8]
    valid: NDArray[np.bool_]


@contextmanager
def open_classes(path: Path) -> "Iterator[DatasetReader]":
    """A class raster, opened: one band of 8-bit class indices.

    Raises:
        ExtraMissingError: rasterio is not installed.
        InputError: the file cannot be read or is not a class raster.
    """
    with gdal(path) as rasterio, open_raster(rasterio, path) as dataset:
        if dataset.count != 1 or dataset.dtypes[0] != "uint8":
            raise InputError(
                "a class raster has one band of 8 bits",
                value=f"{path} ({dataset.count} of {dataset.dtypes[0]})",
                hint="give a raster that `wnn2hdl scan` wrote",
            )
        yield dataset


def strip_rows(dataset: "DatasetReader", pixels: int) -> tuple[tuple[int, int], ...]:
    """First row and end of each strip of about ``pixels`` pixels, top to bottom."""
    rows = max(1, pixels // dataset.width)
    return tuple((row, min(row + rows, dataset.height)) for row in range(0, dataset.height, rows))


def read_strip(dataset: "DatasetReader", rows: tuple[int, int]) -> Strip:
    """The rows from the first to before the second of ``rows``."""
    window = rows, (0, dataset.width)
    return Strip(rows[0], dataset.read(1, window=window), dataset.read_masks(1, window=window) != 0)


def colours(dataset: "DatasetReader") -> tuple[tuple[int, int, int], ...]:
    """Red, green and blue of each class of an open raster by its colour table; greys if it has none."""
    if dataset.colorinterp[0].name != "palette":
        return tuple((grey, grey, grey) for grey in range(NODATA))
    table = dataset.colormap(1)
    return tuple(table[index][:3] for index in range(NODATA) if index in table)


@contextmanager
def staged(path: Path) -> Iterator[Path]:
    """Where to write a file that is to be ``path``: it is moved there when all went well.

    Raises:
        InputError: the folder cannot be made or written, or it has no room.
    """
    make_folder(path.parent)
    try:
        with tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as folder:
            unfinished = Path(folder) / path.name
            yield unfinished
            unfinished.replace(path)
    except OSError as error:
        raise InputError(
            "cannot write",
            value=f"{path} ({error.strerror})",
            hint="choose a folder you may write to, with room in it",
        ) from error
