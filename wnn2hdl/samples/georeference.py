"""The coordinate system of the embedded flight's map against latitude, longitude and true north.

It is UTM zone 20 south (EPSG:32720), over Rondônia. The grid differs from the ground there in two things:

- *grid convergence*: grid north is not true north; a vector of true azimuth a has the grid azimuth
  a - convergence (about -0.3 degrees here). The headings of poses are from true north, as a compass that
  knows its declination gives them.
- *scale*: a metre on the ground is 1.00006 of the grid's metres here: 6 millimetres in 100 m.

Both are taken at the point below the camera; 250 m from it that is wrong by 0.15 millimetres (measured
against PROJ's geodesics).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import extra_needed

EPSG = 32720
"""UTM zone 20 south."""

WEST, NORTH = 690_000.0, 8_910_000.0
"""Easting and northing of the map's north-west corner, metres; about 9.86 degrees south, 61.27 west."""


class Grid:
    """The map's coordinate system against latitude, longitude and true north."""

    def __init__(self) -> None:
        """Set the projection up.

        Raises:
            ExtraMissingError: pyproj is not installed.
        """
        with extra_needed("geo", "a flight needs pyproj"):
            import pyproj
        self._projection: Any = pyproj.Proj(EPSG)

    def degrees(self, east: float, north: float) -> tuple[float, float]:
        """Latitude and longitude of a place of the grid."""
        longitude, latitude = self._projection(east, north, inverse=True)
        return float(latitude), float(longitude)

    def position(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Easting and northing."""
        east, north = self._projection(longitude, latitude)
        return float(east), float(north)

    def factors(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Convergence in degrees, from true north clockwise to grid north, and the grid's scale."""
        factors = self._projection.get_factors(longitude, latitude)
        return float(factors.meridian_convergence), float(factors.meridional_scale)

    def to_grid(self, offsets: NDArray[np.float64], latitude: float, longitude: float) -> NDArray[np.float64]:
        """Metres true north and east, ``S + (2,)``, to metres of the grid, north and east, around a place."""
        convergence, scale = self.factors(latitude, longitude)
        sin, cos = np.sin(np.radians(convergence)), np.cos(np.radians(convergence))
        north, east = offsets[..., 0], offsets[..., 1]
        return np.stack([north * cos + east * sin, east * cos - north * sin], axis=-1) * scale
