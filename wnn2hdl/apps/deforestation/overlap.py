"""Ground that several class rasters show: found, so that totals count it once."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.ellipsoid import to_degrees
from wnn2hdl.raster import NODATA, Georeference
from wnn2hdl.raster.gdal import gdal, open_raster

if TYPE_CHECKING:
    from rasterio.io import DatasetReader

_NODES = 9
"""Points along each side of a raster whose places on the Earth say where it lies."""

_TOUCHING = 0.01
"""Rasters of one system that share a strip no wider than this part of a pixel only touch."""


@dataclass(frozen=True, eq=False)
class Footprint:
    """Where a raster lies.

    Attributes:
        crs: its coordinate system as WKT.
        bounds: float64 ``[2, 2]``, the least and the greatest x and y in that system.
        pixel: about the side of a pixel in that system.
        box: float64 ``[2, 3]``, the least and the greatest coordinates of a box around it on the unit sphere,
            which has no seam at the antimeridian or at a pole.
    """

    crs: str
    bounds: NDArray[np.float64]
    pixel: float
    box: NDArray[np.float64]

    @classmethod
    def of(cls, raster: Path) -> "Footprint | None":
        """Of a raster; None if it lies nowhere that is known."""
        with gdal(raster) as rasterio, open_raster(rasterio, raster) as dataset:
            place = Georeference.of(dataset)
            height, width = dataset.shape
        if not place.located or place.crs is None or place.transform is None:
            return None
        down, right = np.meshgrid(
            np.linspace(0, height, _NODES), np.linspace(0, width, _NODES), indexing="ij"
        )
        a, b, c, d, e, f = place.transform
        map_places = np.stack([a * right + b * down + c, d * right + e * down + f])
        box = _box(*(np.radians(angle) for angle in to_degrees(place.crs).transform(*map_places)))
        bounds = np.stack([map_places.min(axis=(1, 2)), map_places.max(axis=(1, 2))])
        return cls(place.crs, bounds, abs(a * e - b * d) ** 0.5, box)

    def may_share(self, other: "Footprint") -> bool:
        """Whether rasters whose boxes meet may share ground; False is certain."""
        if self.crs != other.crs:
            return True
        both = np.stack([self.bounds, other.bounds])
        shared = both[:, 1].min(axis=0) - both[:, 0].max(axis=0)
        return bool((shared > _TOUCHING * min(self.pixel, other.pixel)).all())


def _box(longitude: NDArray[np.float64], latitude: NDArray[np.float64]) -> NDArray[np.float64]:
    sphere = np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    )
    if not np.isfinite(sphere).all():
        # Some of it lies beyond its projection: it may share ground with any other.
        return np.array([[-1.0] * 3, [1.0] * 3])
    # Between two points the sphere rises above their chord by less than the chord's length squared.
    rise = max(float((np.diff(sphere, axis=axis) ** 2).sum(axis=0).max()) for axis in (1, 2))
    return np.stack([sphere.min(axis=(1, 2)) - rise, sphere.max(axis=(1, 2)) + rise])


def later_ones(rasters: Sequence[Path]) -> Mapping[Path, tuple[Path, ...]]:
    """For each raster that may share ground with ones later in the sequence: which these are.

    Raises:
        InputError: a raster cannot be read.
    """
    footprints = {raster: footprint for raster in rasters if (footprint := Footprint.of(raster))}
    located = list(footprints)
    boxes = np.array([footprint.box for footprint in footprints.values()]).reshape(-1, 2, 3)
    found = {}
    for index, raster in enumerate(located):
        low, high = boxes[index]
        meeting = ((boxes[index + 1 :, 0] <= high) & (boxes[index + 1 :, 1] >= low)).all(axis=1)
        later = tuple(
            located[number]
            for number in (np.flatnonzero(meeting) + index + 1).tolist()
            if footprints[raster].may_share(footprints[located[number]])
        )
        if later:
            found[raster] = later
    return found


@contextmanager
def shown_by(
    rasters: Sequence[Path], dataset: "DatasetReader"
) -> Iterator[Callable[[int, int], NDArray[np.bool_]]]:
    """Open class rasters in the grid of another, whatever their own coordinate systems.

    Args:
        rasters: the class rasters.
        dataset: the open raster whose grid it is.

    Yields:
        a function that says which pixels of rows ``first`` to before ``end`` have data in any of them, at the
        pixels' middles: bool ``[end - first, width]``. Grids that differ by whole pixels are compared pixel
        by pixel.
    """
    from rasterio.enums import Resampling
    from rasterio.vrt import WarpedVRT

    grid = {name: getattr(dataset, name) for name in ("crs", "transform", "height", "width")}
    with ExitStack() as stack:
        others = []
        for raster in rasters:
            rasterio = stack.enter_context(gdal(raster))
            opened = stack.enter_context(open_raster(rasterio, raster))
            warped = WarpedVRT(opened, **grid, resampling=Resampling.nearest, nodata=NODATA)
            others.append(stack.enter_context(warped))

        def shown(first: int, end: int) -> NDArray[np.bool_]:
            found = np.zeros((end - first, dataset.width), dtype=np.bool_)
            for other in others:
                if found.all():
                    break
                found |= other.read(1, window=((first, end), (0, dataset.width))) != NODATA
            return found

        yield shown
