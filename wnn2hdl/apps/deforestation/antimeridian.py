"""Polygons in longitude and latitude as RFC 7946 wants them: within ±180 degrees, and cut where they cross.

The package `antimeridian` does the same, but fails on polygons whose holes cross (0.4.9).
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import extra_needed

DECIMALS = 8
"""Of a degree: a millimetre."""


def within_the_world(polygons: NDArray[np.object_]) -> NDArray[np.object_]:
    """Cut polygons at the antimeridian and bring all longitudes to -180…180.

    Args:
        polygons: shapely polygons ``[n]``, x longitude and y latitude in degrees. No edge is half the world
            wide: where two longitudes of an edge differ by more than 180, it crosses the antimeridian.

    Returns:
        shapely polygons and multipolygons ``[n]``, outer rings anticlockwise and inner ones clockwise.
    """
    shapely = _shapely()
    west, _, east, _ = shapely.bounds(polygons).T
    beyond = (west < -180) | (east > 180) | (east - west > 180)
    wound = np.where(shapely.is_ccw(shapely.get_exterior_ring(polygons)), polygons, shapely.reverse(polygons))
    wound[beyond] = [_cut(polygon) for polygon in polygons[beyond]]
    return np.asarray(wound)


def _cut(polygon: Any) -> Any:
    shapely = _shapely()
    holes = shapely.union_all([_pieces(ring) for ring in polygon.interiors])
    # Rounded here, since what is moved by 360 degrees is no longer a decimal.
    whole = shapely.transform(
        shapely.difference(_pieces(polygon.exterior), holes), lambda places: places.round(DECIMALS)
    )
    parts = [shapely.geometry.polygon.orient(part) for part in shapely.get_parts(whole)]
    return parts[0] if len(parts) == 1 else shapely.multipolygons(parts)


def _pieces(ring: Any) -> Any:
    """What a ring encloses, as polygons within the world."""
    shapely = _shapely()
    longitude, latitude = shapely.get_coordinates(ring).T
    longitude = np.unwrap(longitude, period=360)
    places = np.stack([longitude, latitude], axis=1)
    if abs(longitude[-1] - longitude[0]) > 180:
        # The ring goes round the world, so a pole lies within it.
        pole = math.copysign(90, latitude.mean())
        places = np.concatenate([places, [[longitude[-1], pole], [longitude[0], pole]]])
    shape = shapely.polygons(places)
    worlds = range(round(longitude.min() / 360), round(longitude.max() / 360) + 1)
    pieces = []
    for turn in (360 * world for world in worlds):
        inside = shapely.get_parts(shapely.intersection(shape, shapely.box(turn - 180, -90, turn + 180, 90)))
        # Where a shape only touches the antimeridian, a line or a point of it lies in the next world.
        flat = inside[shapely.get_dimensions(inside) == 2]
        pieces += list(shapely.transform(flat, lambda places, turn=turn: places - (turn, 0)))
    return shapely.union_all(pieces)


def _shapely() -> Any:
    with extra_needed("geo", "polygons need shapely"):
        import shapely
        import shapely.geometry
    return shapely
