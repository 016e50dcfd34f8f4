"""Areas of a raster's pixels on the ellipsoid, whatever its coordinate system."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError, extra_needed
from wnn2hdl.raster import Georeference

if TYPE_CHECKING:
    from pyproj import Transformer

SQUARE_METRES = 10_000
"""Of a hectare."""

_SEMI_MAJOR = 6378137.0
_FLATTENING = 1 / 298.257223563
_ECCENTRICITY = (_FLATTENING * (2 - _FLATTENING)) ** 0.5
"""WGS 84."""

_NODE_METRES = 1000.0
_NODE_PIXELS = 128
"""Areas are computed at pixels at most this far apart and interpolated linearly between them.

Linear interpolation over 1 km errs by the area's second derivative, at most about 2 / R**2 in UTM and along
meridians: by 1 part in 10**8.
"""


class PixelAreas:
    """The area of every pixel of a raster on the ellipsoid WGS 84.

    A pixel's corners are carried to longitude and latitude, and from there to the cylindrical equal-area
    projection (x = a * longitude, y = a * q / 2 with the authalic function q of latitude; Snyder, *Map
    Projections: A Working Manual*, 1987, equations 10-15 and 3-12), where plane areas are those on the
    ellipsoid. In a raster of whole parallels and meridians this is exact at any size of pixel.

    Args:
        place: where the raster lies; it is located.
        height: pixels.
        width: pixels.

    Attributes:
        middle: area of the pixel in the middle, m².

    Raises:
        ExtraMissingError: pyproj is not installed.
        InputError: the pixels have no area; `rows` raises it, too, where some lie beyond the projection.
    """

    def __init__(self, place: Georeference, height: int, width: int) -> None:
        assert place.crs is not None
        assert place.transform is not None
        self._transform = place.transform
        self._to_degrees = to_degrees(place.crs)
        self._width, self._height = width, height
        self.middle = float(self._corner_areas(np.array([height // 2]), np.array([width // 2]))[0, 0])
        # What lies beyond the projection begins at the edge: reported now rather than when everything is
        # classified.
        self._corner_areas(np.array([0, height - 1]), np.array([0, width - 1]))
        if not self.middle:
            raise self._no_area()
        self._spacing = int(np.clip(_NODE_METRES // self.middle**0.5, 1, _NODE_PIXELS))

    def rows(self, first: int, end: int) -> NDArray[np.float64]:
        """Areas of the pixels of rows ``first`` to before ``end``: float64 ``[end - first, width]``, m²."""
        node_columns, across = _nodes(0, self._width, self._width, self._spacing)
        node_rows, down = _nodes(first, end, self._height, self._spacing)
        return np.asarray(down @ self._corner_areas(node_rows, node_columns) @ across.T)

    def _corner_areas(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Areas of the pixels at these rows and columns, each with each: m²."""
        down, right = np.array([0, 0, 1, 1]), np.array([0, 1, 1, 0])
        row, column = np.broadcast_arrays(
            rows[:, np.newaxis, np.newaxis] + down, columns[np.newaxis, :, np.newaxis] + right
        )
        a, b, c, d, e, f = self._transform
        longitude, latitude = self._to_degrees.transform(a * column + b * row + c, d * column + e * row + f)
        if not np.isfinite(longitude).all():
            raise self._no_area()
        # A pixel may lie across the meridian of 180 degrees, where longitudes jump.
        east = np.radians((longitude - longitude[..., :1] + 180) % 360 - 180) * _SEMI_MAJOR
        north = _SEMI_MAJOR / 2 * _authalic(np.radians(np.clip(latitude, -90, 90)))
        north = north - north[..., :1]
        shoelace = east * np.roll(north, -1, axis=-1) - np.roll(east, -1, axis=-1) * north
        return np.asarray(abs(shoelace.sum(axis=-1)) / 2)

    def _no_area(self) -> InputError:
        return InputError(
            "the pixels have no area on the Earth",
            value=f"transform {self._transform}",
            hint="correct the picture's transform or coordinate system, for instance with gdal_edit",
        )


def to_degrees(crs: str) -> "Transformer":
    """From the coordinates of a system, given as WKT, to longitude and latitude in degrees, in this order.

    Raises:
        ExtraMissingError: pyproj is not installed.
        InputError: the system is not one of the Earth.
    """
    with extra_needed("geo", "areas on the ellipsoid need pyproj"):
        from pyproj import Transformer
        from pyproj.exceptions import ProjError
    try:
        return Transformer.from_crs(crs, "EPSG:4326", always_xy=True)
    except ProjError as error:
        raise InputError(
            "the raster's coordinate system does not lead to longitude and latitude on the Earth",
            value=error,
            hint="correct the system, for instance with gdal_edit.py -a_srs",
        ) from error


def _authalic(latitude: NDArray[np.float64]) -> NDArray[np.float64]:
    """Snyder's q, doubled area of the zone from the equator to a latitude in radians, over 2 pi a²."""
    sine, e = np.sin(latitude), _ECCENTRICITY
    return np.asarray((1 - e**2) * (sine / (1 - (e * sine) ** 2) + np.arctanh(e * sine) / e))


def _nodes(first: int, end: int, size: int, spacing: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Nodes around ``first`` to before ``end``, and the weight of each (columns) at each place (rows).

    Nodes lie at multiples of the spacing and at the last pixel, wherever a strip begins.
    """
    every = np.append(np.arange(0, size - 1, spacing), size - 1)
    low = int(np.searchsorted(every, first, side="right")) - 1
    high = int(np.searchsorted(every, end - 1, side="left"))
    nodes = every[low : high + 1]
    places = np.arange(first, end)
    weights = np.stack([np.interp(places, nodes, unit) for unit in np.eye(len(nodes))], axis=1)
    return nodes, weights
