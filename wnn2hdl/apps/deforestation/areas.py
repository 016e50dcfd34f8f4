"""How much of a class raster belongs to each class."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import STRIP_PIXELS, open_classes, read_strip, strip_rows
from wnn2hdl.apps.deforestation.ellipsoid import SQUARE_METRES, PixelAreas
from wnn2hdl.apps.deforestation.overlap import shown_by
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference


@dataclass(frozen=True)
class ClassArea:
    """What one class covers.

    Attributes:
        name: the class.
        pixels: how many.
        hectares: their area on the ellipsoid; None if the raster has no georeference.
    """

    name: str
    pixels: int
    hectares: float | None


def class_areas(raster: Path, names: Sequence[str], elsewhere: Sequence[Path] = ()) -> tuple[ClassArea, ...]:
    """Pixels and area of each class, those without data left out; a strip of rows is in memory at a time.

    Args:
        raster: a class raster.
        names: class names by index.
        elsewhere: class rasters of ground that is not counted here, because it is counted there.

    Raises:
        ExtraMissingError: the extra ``geo`` is not installed.
        InputError: the file cannot be read, or holds an index without a name.
    """
    pixels, square_metres = np.zeros(256, dtype=np.int64), np.zeros(256)
    with open_classes(raster) as dataset, shown_by(elsewhere, dataset) as shown:
        place = Georeference.of(dataset)
        areas = PixelAreas(place, *dataset.shape) if place.located else None
        for rows in strip_rows(dataset, STRIP_PIXELS):
            strip = read_strip(dataset, rows)
            counted = strip.valid & ~shown(*rows)
            present = strip.classes[counted]
            pixels += np.bincount(present, minlength=256)
            if areas:
                square_metres += np.bincount(present, areas.rows(*rows)[counted], minlength=256)
        georeferenced = areas is not None
    require_names(pixels, names, raster)
    return tuple(
        ClassArea(name, int(pixels[i]), float(square_metres[i]) / SQUARE_METRES if georeferenced else None)
        for i, name in enumerate(names)
    )


def require_names(pixels: NDArray[np.int64], names: Sequence[str], raster: Path) -> None:
    """Refuse a raster with pixels (int64 ``[256]`` by class index) of a class that has no name."""
    if pixels[len(names) :].any():
        raise InputError(
            f"the raster has a class of index {int(np.flatnonzero(pixels)[-1])}, and there are "
            f"{len(names)} names of classes",
            value=raster,
            hint="give the raster that belongs to the model",
        )
