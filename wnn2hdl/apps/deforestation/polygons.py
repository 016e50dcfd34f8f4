"""Outlines of a class raster's regions, with their areas."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.areas import ClassArea, require_names
from wnn2hdl.apps.deforestation.class_raster import STRIP_PIXELS, open_classes, read_strip, staged, strip_rows
from wnn2hdl.apps.deforestation.ellipsoid import SQUARE_METRES, PixelAreas
from wnn2hdl.apps.deforestation.polygon_files import WRITERS, Outlines
from wnn2hdl.apps.deforestation.regions import Regions, find_regions
from wnn2hdl.errors import InputError
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Georeference

if TYPE_CHECKING:
    from rasterio.io import DatasetReader


def write_polygons(
    raster: Path,
    output: Path,
    names: Sequence[str],
    progress: Progress,
    *,
    strip_pixels: int = STRIP_PIXELS,
) -> tuple[ClassArea, ...]:
    """Outline every region of every class but the background, which is class 0.

    A region is a set of pixels of one class connected by their sides; each becomes one polygon with the
    properties ``class``, ``area_ha`` (the sum of its pixels' areas on the ellipsoid WGS 84) and ``area_px``.
    GeoJSON is as RFC 7946 wants it: longitude from -180 to 180 and latitude (EPSG:4326), a region across the
    antimeridian cut there into a multipolygon. GeoPackage is in the raster's coordinate system, where nothing
    is cut, so that polygons lie on the raster. Without a georeference coordinates are pixels, x to the right
    and y downwards from the top left corner, and ``area_ha`` is null; such a GeoJSON says so in its member
    ``coordinates``.

    Memory grows with the number of regions, about 35 bytes each, and with the outlines of those that reach
    into the strip being worked on or across it; finished ones are written at once.

    Args:
        raster: a class raster.
        output: a file ending in ``.geojson`` or ``.gpkg``.
        names: class names by index.
        progress: called with each strip, twice over.
        strip_pixels: how many pixels are worked on at a time; the polygons do not depend on it, only their
            order does.

    Returns:
        what each class other than the background covers, the sum over its polygons.

    Raises:
        ExtraMissingError: the extra ``geo`` is not installed.
        InputError: a file cannot be read or written, or a class has no name.
    """
    writer = WRITERS.get(output.suffix.lower())
    if writer is None:
        raise InputError(
            "polygons are written as GeoJSON or GeoPackage",
            value=output,
            hint=f"end its name in {' or '.join(WRITERS)}",
        )
    pixels, hectares = np.zeros(len(names), dtype=np.int64), np.zeros(len(names))
    with open_classes(raster) as dataset, staged(output) as unfinished:
        strips = strip_rows(dataset, strip_pixels)
        place = Georeference.of(dataset)
        areas = PixelAreas(place, *dataset.shape) if place.located else None
        regions = find_regions(
            dataset, strips, lambda done: progress("finding regions", done, len(strips)), areas
        )
        by_class = np.zeros(256, dtype=np.int64)
        np.add.at(by_class, regions.classes, regions.pixels)
        require_names(by_class, names, raster)
        with writer(unfinished, dataset, names) as write:
            for done, outlines in enumerate(_outlines(dataset, strips, regions), start=1):
                if len(outlines.polygons):
                    write(outlines)
                np.add.at(pixels, outlines.classes, outlines.pixels)
                np.add.at(hectares, outlines.classes, outlines.hectares)
                progress("outlining regions", done, len(strips))
    return tuple(
        ClassArea(name, int(pixels[i]), float(hectares[i]) if areas else None)
        for i, name in enumerate(names)
        if i
    )


def _outlines(
    dataset: "DatasetReader", strips: Sequence[tuple[int, int]], regions: Regions
) -> Iterator[Outlines]:
    """After each strip the regions that are finished, in the order of their numbers."""
    import shapely

    unfinished: dict[int, list[Any]] = defaultdict(list)
    for index, rows in enumerate(strips):
        strip = read_strip(dataset, rows)
        labels = regions.label(index, strip)
        wanted = strip.valid & (strip.classes != 0)
        for number, part in zip(*_parts(labels, wanted, rows[0]), strict=True):
            unfinished[number].append(part)
        done = np.array(sorted(n for n in unfinished if regions.last_strip[n] == index), dtype=np.int64)
        polygons = np.array([_merged(unfinished.pop(n)) for n in done.tolist()], dtype=object)
        yield Outlines(
            shapely.normalize(polygons),
            regions.classes[done],
            regions.pixels[done],
            regions.square_metres[done] / SQUARE_METRES,
        )


def _merged(parts: list[Any]) -> Any:
    import shapely

    if len(parts) == 1:
        return parts[0]
    # A union has corners where its parts met, which are none of the region's; one may be where it starts.
    return shapely.simplify(shapely.normalize(shapely.union_all(parts)), 0)


def _parts(
    labels: NDArray[np.int32], wanted: NDArray[np.bool_], row: int
) -> tuple[list[int], NDArray[np.object_]]:
    """Region and polygon, in the raster's pixels, of each connected part of the strip from ``row`` on."""
    import shapely
    from rasterio import Affine
    from rasterio.features import shapes

    numbers: list[int] = []
    rings: list[NDArray[np.float64]] = []
    polygon_of: list[int] = []
    for polygon, number in shapes(labels, mask=wanted, connectivity=4, transform=Affine.translation(0, row)):
        parts = [np.array(ring) for ring in polygon["coordinates"]]
        rings += parts
        polygon_of += [len(numbers)] * len(parts)
        numbers.append(int(number))
    if not numbers:
        return [], np.zeros(0, dtype=object)
    # All at once: a polygon made alone costs as much as a hundred corners.
    ring_of = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    lines = shapely.linearrings(np.concatenate(rings), indices=ring_of)
    return numbers, shapely.polygons(lines, indices=polygon_of)
