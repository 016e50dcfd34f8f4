"""Writing outlined regions as GeoJSON or GeoPackage, some at a time."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.antimeridian import DECIMALS, within_the_world
from wnn2hdl.apps.deforestation.ellipsoid import to_degrees
from wnn2hdl.errors import InputError, extra_needed
from wnn2hdl.muted import recorded
from wnn2hdl.raster import Georeference

if TYPE_CHECKING:
    from rasterio.io import DatasetReader

LONGEST_EDGE = 128
"""Pixels of a straight edge in GeoJSON: what is straight in the raster's coordinates is bent in degrees."""


@dataclass(frozen=True, eq=False)
class Outlines:
    """Some regions to be written.

    Attributes:
        polygons: shapely polygons ``[n]`` in pixels: x to the right, y downwards, corners at whole numbers.
        classes: uint8 ``[n]``, class indices.
        pixels: int64 ``[n]``.
        hectares: float64 ``[n]``, NaN without a georeference.
    """

    polygons: NDArray[np.object_]
    classes: NDArray[np.uint8]
    pixels: NDArray[np.int64]
    hectares: NDArray[np.float64]


Write = Callable[[Outlines], None]


@contextmanager
def geojson(path: Path, dataset: "DatasetReader", names: Sequence[str]) -> Iterator[Write]:
    """A feature collection in longitude and latitude, one feature per line.

    Without a georeference coordinates stay pixels, and the collection's member ``coordinates`` says so.

    Args:
        path: the file.
        dataset: the raster that the regions are of.
        names: class names by index.

    Yields:
        what writes some regions.
    """
    located = Georeference.of(dataset).located
    carry = _to_degrees(dataset) if located else None
    note = "" if located else ',"coordinates":"pixels: x to the right, y downwards; no georeference"'
    with path.open("w", encoding="utf-8") as stream:
        stream.write(f'{{"type":"FeatureCollection"{note},"features":[')
        separator = "\n"

        def write(outlines: Outlines) -> None:
            nonlocal separator
            for text in _features(outlines, names, carry):
                stream.write(separator + text)
                separator = ",\n"

        yield write
        stream.write("\n]}\n")


def _features(
    outlines: Outlines,
    names: Sequence[str],
    carry: Callable[[NDArray[np.float64]], NDArray[np.float64]] | None,
) -> Iterator[str]:
    shapely = _shapely()
    polygons = outlines.polygons
    if carry is not None:
        polygons = within_the_world(shapely.transform(shapely.segmentize(polygons, LONGEST_EDGE), carry))
    texts = shapely.to_geojson(polygons)
    for text, index, pixels, hectares in zip(
        texts, outlines.classes, outlines.pixels.tolist(), outlines.hectares.tolist(), strict=True
    ):
        properties = {
            "class": names[index],
            "area_ha": None if np.isnan(hectares) else round(hectares, 6),
            "area_px": pixels,
        }
        head = json.dumps(properties, ensure_ascii=False, separators=(",", ":"))
        yield f'{{"type":"Feature","properties":{head},"geometry":{text}}}'


def _to_degrees(dataset: "DatasetReader") -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    to_map, transformer = _to_map(dataset), to_degrees(dataset.crs.to_wkt())

    def carry(pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.stack(transformer.transform(*to_map(pixels).T), axis=1).round(DECIMALS)

    return carry


def _to_map(dataset: "DatasetReader") -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """From pixels ``[n, 2]`` to the raster's coordinates ``[n, 2]``."""
    a, b, c, d, e, f = tuple(dataset.transform)[:6]
    return lambda pixels: pixels @ np.array([[a, d], [b, e]]) + np.array([c, f])


@contextmanager
def geopackage(path: Path, dataset: "DatasetReader", names: Sequence[str]) -> Iterator[Write]:
    """A table ``regions`` of polygons in the raster's coordinate system; arguments as for `geojson`.

    Raises:
        ExtraMissingError: pyogrio is not installed.
        InputError: the file cannot be written.
    """
    with extra_needed("geo", "GeoPackage needs pyogrio"):
        from pyogrio import raw, set_gdal_config_options
        from pyogrio.errors import DataLayerError, DataSourceError, FeatureError
    shapely = _shapely()
    located = Georeference.of(dataset).located
    to_map = _to_map(dataset)
    class_names = np.array(names, dtype=object)

    def write(outlines: Outlines, *, append: bool = True) -> None:
        polygons = shapely.transform(outlines.polygons, to_map) if located else outlines.polygons
        fields = {
            "class": class_names[outlines.classes],
            "area_ha": outlines.hectares,
            "area_px": outlines.pixels,
        }
        # Recorded, since on a full disk some of GDAL's errors come as warnings; that there is no coordinate
        # system is known.
        with recorded() as noted:
            try:
                raw.write(
                    path,
                    shapely.to_wkb(polygons),
                    list(fields.values()),
                    list(fields),
                    layer="regions",
                    driver="GPKG",
                    geometry_type="Polygon",
                    crs=dataset.crs.to_wkt() if located else None,
                    append=append,
                )
            except (DataSourceError, DataLayerError, FeatureError) as error:
                raise _unwritten(path, error) from error
        for warning in noted:
            if issubclass(warning.category, RuntimeWarning):
                raise _unwritten(path, warning.message)

    # An empty table first, so that a raster without regions makes a file too.
    none = np.zeros(0)
    # GeoPackage notes when its content changed; the same regions are to give the same bytes.
    set_gdal_config_options({"OGR_CURRENT_DATE": "2000-01-01T00:00:00.000Z"})
    write(Outlines(none.astype(object), none.astype(np.uint8), none.astype(np.int64), none), append=False)
    try:
        yield write
    finally:
        set_gdal_config_options({"OGR_CURRENT_DATE": None})


def _unwritten(path: Path, reason: object) -> InputError:
    return InputError("cannot write the polygons", value=f"{path} ({reason})", hint="the disk may be full")


def _shapely() -> Any:
    with extra_needed("geo", "polygons need shapely"):
        import shapely
    return shapely


WRITERS: dict[str, Callable[[Path, "DatasetReader", Sequence[str]], AbstractContextManager[Write]]] = {
    ".geojson": geojson,
    ".gpkg": geopackage,
}
"""By the file's suffix in lower case."""
