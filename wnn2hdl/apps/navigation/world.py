"""The map: a georeferenced picture, laid out as the grid that matching happens on."""

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.apps.navigation.grid import MapGrid, local_crs, transformer
from wnn2hdl.errors import InputError, extra_needed
from wnn2hdl.images import PlainPicture, Source, open_picture
from wnn2hdl.ir.window import SIDE
from wnn2hdl.raster import Reading

if TYPE_CHECKING:
    from affine import Affine
    from pyproj import Transformer

AS_STATED = Reading()
"""Bands and values as the file states them."""

_WARP_TOLERANCE_PX = 0.01
"""How far GDAL may miss by interpolating coordinates instead of computing each."""

_VOID_SHARE = 0.001
"""A plain black or white region at the map's edge is taken for no picture if it is this part of the map."""

_MOST_PIXELS = 1 << 30
"""Of a map or a grid: its picture takes 3 GB then."""


@dataclass(frozen=True)
class WorldMap:
    """A georeferenced picture, from a file or in memory.

    Attributes:
        source: the picture, read when a grid is made of it.
        transform: affine map from (column, row) of pixel corners to the coordinate system; it may be rotated.
        crs: the coordinate system, as anything PROJ takes: WKT, ``"EPSG:4326"``.
    """

    source: Source
    transform: "Affine"
    crs: str

    @classmethod
    def read(cls, path: Path, reading: Reading = AS_STATED) -> Self:
        """Open a georeferenced picture, by the same rules as every other: `wnn2hdl.images.open_picture`.

        Raises:
            ExtraMissingError: rasterio or pyproj is not installed.
            InputError: the file cannot be read, has no georeference, or does not say what its samples are.
        """
        rasterio = _rasterio()
        source = open_picture(path, reading)
        place = source.georeference
        if place.crs is None or place.transform is None:
            raise InputError(
                "the map has no georeference",
                value=path,
                hint="give a GeoTIFF with a coordinate system and a transform",
            )
        shape = source.height, source.width
        if shape[0] * shape[1] > _MOST_PIXELS:
            raise InputError(
                "the map is too large",
                value=f"{path} ({shape[1]}x{shape[0]})",
                hint="cut out the country that was flown over",
            )
        return cls(source, rasterio.Affine(*place.transform), place.crs)

    @classmethod
    def of_array(cls, image: NDArray[np.uint8], transform: Iterable[float], crs: str) -> Self:
        """A map in memory.

        Args:
            image: uint8 ``[rows, columns, 3]``.
            transform: coefficients a … f of an affine map from (column, row) of pixel corners, as rasterio's.
            crs: the coordinate system.
        """
        rasterio = _rasterio()
        return cls(PlainPicture(image), rasterio.Affine(*islice(transform, 6)), crs)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.source.height, self.source.width

    @property
    def note(self) -> str:
        """What had to be assumed about the file's bands and pages; empty if nothing."""
        return self.source.note

    @cached_property
    def _geographic(self) -> "Transformer":
        from pyproj.exceptions import ProjError

        try:
            return transformer(self.crs)
        except ProjError as error:
            raise InputError(
                "the map's coordinate system does not give latitudes and longitudes",
                value=self.crs,
                hint="give a map in a geographic or projected coordinate system, as UTM",
            ) from error

    def to_pixel(
        self, latitude: ArrayLike, longitude: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rows and columns of this picture, as `MapGrid.to_pixel`."""
        x, y = self._geographic.transform(np.asarray(longitude, float), np.asarray(latitude, float))
        columns, rows = _applied(~self.transform, np.asarray(x), np.asarray(y))
        return rows - 0.5, columns - 0.5

    def to_geographic(
        self, row: ArrayLike, column: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Latitudes and longitudes of pixels of this picture, as `MapGrid.to_geographic`."""
        x, y = _applied(self.transform, np.asarray(column, float) + 0.5, np.asarray(row, float) + 0.5)
        longitude, latitude = self._geographic.transform(x, y, direction="INVERSE")
        return np.asarray(latitude), np.asarray(longitude)

    @cached_property
    def gsd_m(self) -> float:
        """Ground sample distance in the middle, metres: the square root of a pixel's area there.

        Raises:
            InputError: the pixels have no area, or are not on the earth.
        """
        rows, columns = (extent / 2 - 0.5 for extent in self.shape)
        corners = self.to_geographic(rows + np.array([0, 0, 1]), columns + np.array([0, 1, 0]))
        self._check_on_earth(corners)
        latitude, longitude = (float(axis[0]) for axis in corners)
        east, north = transformer(local_crs(latitude, longitude)).transform(corners[1], corners[0])
        across, down = ((east[i], north[i]) for i in (1, 2))
        area = abs(across[0] * down[1] - across[1] * down[0])
        if self.transform.is_degenerate or not area:
            raise InputError(
                "the map's pixels have no size on the ground",
                value=tuple(self.transform)[:6],
                hint="give it a transform that can be inverted",
            )
        return float(np.sqrt(area))

    def digest(self) -> str:
        """SHA-256 of the pixels, which of them are shown, and where they lie: 64 hexadecimal digits.

        Raises:
            InputError: the map cannot be read.
        """
        picture, shown = self._pixels
        found = hashlib.sha256(repr((self.shape, tuple(self.transform), self.crs)).encode())
        found.update(np.ascontiguousarray(picture).data)
        found.update(np.packbits(shown).data)
        return found.hexdigest()

    def resampled(self, gsd_m: float | None = None) -> MapGrid:
        """Lay the map on a north-up metric grid.

        Done by GDAL's warper, bilinear, its kernel widened where the grid is coarser than the picture.
        Outside the picture, where the file's mask or no-data value says so, and in plain black or white
        regions that reach the picture's edge (mosaics are often saved without a mask), the grid is not valid.

        Args:
            gsd_m: metres per pixel; the map's own if not given.

        Raises:
            InputError: the map cannot be read, lies nowhere, or is too small or too large for such a grid.
        """
        rasterio = _rasterio()
        from rasterio.enums import Resampling
        from rasterio.warp import reproject

        own_m = self.gsd_m
        gsd_m = gsd_m or own_m
        middle = self.to_geographic((self.shape[0] - 1) / 2, (self.shape[1] - 1) / 2)
        latitude, longitude = (float(axis) for axis in middle)
        local = local_crs(latitude, longitude)
        west, south, east, north = self._extent(local)
        columns, rows = (int((high - low) / gsd_m) for low, high in ((west, east), (south, north)))
        if min(rows, columns) < SIDE:
            raise InputError(
                f"the map has less than {SIDE}x{SIDE} pixels to find edges in",
                value=f"{columns}x{rows} of {gsd_m:g} m",
                hint="give a larger map",
            )
        if rows * columns > _MOST_PIXELS:
            raise InputError(
                "the map is too large to be laid on a grid",
                value=f"{columns}x{rows} pixels of {gsd_m:g} m",
                hint="cut out the country that was flown over",
            )
        transform = rasterio.Affine(gsd_m, 0, west, 0, -gsd_m, north)
        picture, shown = self._pixels
        image = np.zeros((3, rows, columns), dtype=np.uint8)
        valid = np.zeros((rows, columns), dtype=np.uint8)
        geo = {
            "src_transform": self.transform,
            "src_crs": self.crs,
            "dst_transform": transform,
            "dst_crs": local,
            "tolerance": _WARP_TOLERANCE_PX,
        }
        reproject(np.moveaxis(picture, -1, 0), image, resampling=Resampling.bilinear, **geo)
        reproject(shown.astype(np.uint8), valid, resampling=Resampling.nearest, **geo)
        image[:, valid == 0] = 0
        return MapGrid(
            np.ascontiguousarray(np.moveaxis(image, 0, -1)),
            valid > 0,
            gsd_m,
            (west + gsd_m / 2, north - gsd_m / 2),
            latitude,
            longitude,
        )

    def _extent(self, local: str) -> tuple[float, float, float, float]:
        rows, columns = self.shape
        along = np.linspace(-0.5, rows - 0.5, 33)
        across = np.linspace(-0.5, columns - 0.5, 33)
        outline = np.concatenate(
            [
                np.stack(np.broadcast_arrays(row, column), axis=-1)
                for row, column in (
                    (along, -0.5),
                    (along, columns - 0.5),
                    (-0.5, across),
                    (rows - 0.5, across),
                )
            ]
        )
        latitude, longitude = self.to_geographic(outline[:, 0], outline[:, 1])
        self._check_on_earth((latitude, longitude))
        east, north = transformer(local).transform(longitude, latitude)
        return float(min(east)), float(min(north)), float(max(east)), float(max(north))

    def _check_on_earth(self, positions: tuple[NDArray[np.float64], NDArray[np.float64]]) -> None:
        if not np.isfinite(positions).all():
            raise InputError(
                "the map is not on the earth",
                value=f"{self.crs}, {tuple(self.transform)[:6]}",
                hint="correct its coordinate system or its transform",
            )

    @cached_property
    def _pixels(self) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """The picture, uint8 ``[rows, columns, 3]``, and which of its pixels it shows."""
        picture, valid = self.source.read(0, 0, *self.shape)
        picture = np.ascontiguousarray(picture)
        shown = np.ones(self.shape, dtype=np.bool_) if valid is None else valid
        for plain in (0, 255):
            shown = shown & ~_void(picture, plain)
        return picture, shown


def _applied(
    affine: "Affine", x: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return affine.a * x + affine.b * y + affine.c, affine.d * x + affine.e * y + affine.f


def _void(picture: NDArray[np.uint8], plain: int) -> NDArray[np.bool_]:
    """Regions of one plain value that reach the picture's edge and are large."""
    equal = np.asarray((picture == plain).all(axis=-1), dtype=np.uint8)
    _, regions, statistics, _ = cv2.connectedComponentsWithStats(equal, connectivity=4)
    border = np.unique(np.concatenate([regions[0], regions[-1], regions[:, 0], regions[:, -1]]))
    large = statistics[:, cv2.CC_STAT_AREA] >= _VOID_SHARE * equal.size
    return np.isin(regions, [region for region in border if region and large[region]])


def _rasterio() -> Any:
    with extra_needed("geo", "georeferenced maps need rasterio and pyproj"):
        import pyproj  # noqa: F401  # fails here rather than later
        import rasterio
    return rasterio
