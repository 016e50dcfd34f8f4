"""Distances over the ground: on the sphere, as the reference counts, and on the ellipsoid; both by PROJ.

How much they differ depends on latitude and direction, as the ellipsoid's radii of curvature depart from the
mean radius. Of 100 m by geodesic, the great circle makes (measured over all directions, north-south to
east-west): 100.56 to 99.89 m at the equator, 100.39 to 99.83 m at latitude 24, 100.13 to 99.74 m at latitude
41 and 99.81 to 99.64 m at latitude 60.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import extra_needed

EARTH_RADIUS_M = 6_371_008.8
"""Mean radius R1 = (2 a + b) / 3 of the WGS 84 ellipsoid (IUGG)."""

_SPHERE = f"+a={EARTH_RADIUS_M} +b={EARTH_RADIUS_M}"
_WGS84 = "+ellps=WGS84"


def great_circle_m(
    latitude_1: ArrayLike, longitude_1: ArrayLike, latitude_2: ArrayLike, longitude_2: ArrayLike
) -> NDArray[np.float64]:
    """Distance on a sphere of `EARTH_RADIUS_M`.

    It equals the reference's ``R arccos(…)`` but keeps its digits at short distances, where the arccosine of
    nearly 1 loses half of them.

    Args:
        latitude_1: degrees, north positive; arrays of one shape, or numbers.
        longitude_1: degrees, east positive.
        latitude_2: as ``latitude_1``.
        longitude_2: as ``longitude_1``.

    Returns:
        float64, metres.

    Raises:
        ExtraMissingError: pyproj is not installed.
    """
    return _inverse(_SPHERE, latitude_1, longitude_1, latitude_2, longitude_2)[1]


def geodesic_m(
    latitude_1: ArrayLike, longitude_1: ArrayLike, latitude_2: ArrayLike, longitude_2: ArrayLike
) -> NDArray[np.float64]:
    """Distance on the WGS 84 ellipsoid (Karney's algorithm); arguments and errors as `great_circle_m`."""
    return _inverse(_WGS84, latitude_1, longitude_1, latitude_2, longitude_2)[1]


def course_deg(
    latitude_1: ArrayLike, longitude_1: ArrayLike, latitude_2: ArrayLike, longitude_2: ArrayLike
) -> NDArray[np.float64]:
    """Azimuth of the geodesic at its start, degrees clockwise from north; arguments as `great_circle_m`."""
    return _inverse(_WGS84, latitude_1, longitude_1, latitude_2, longitude_2)[0]


def _inverse(
    earth: str,
    latitude_1: ArrayLike,
    longitude_1: ArrayLike,
    latitude_2: ArrayLike,
    longitude_2: ArrayLike,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Azimuths in degrees and distances in metres, on an ellipsoid as PROJ writes it."""
    with extra_needed("geo", "geodesics need pyproj"):
        from pyproj import Geod
    ends = np.broadcast_arrays(longitude_1, latitude_1, longitude_2, latitude_2)
    from_lon, from_lat, to_lon, to_lat = (np.array(axis, dtype=np.float64) for axis in ends)
    azimuth, _, metres = Geod(earth).inv(from_lon, from_lat, to_lon, to_lat)
    return np.asarray(azimuth, dtype=np.float64), np.asarray(metres, dtype=np.float64)
