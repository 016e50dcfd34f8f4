"""Longitudes and polygons as RFC 7946 wants them."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.deforestation.antimeridian import within_the_world

shapely = pytest.importorskip("shapely")


def cut(polygon: Any) -> Any:
    """The polygon within the world, after checking what holds of every one."""
    (found,) = within_the_world(np.array([polygon], dtype=object))
    assert found.is_valid
    west, _, east, _ = found.bounds
    assert west >= -180
    assert east <= 180
    for part in shapely.get_parts(found):
        assert part.exterior.is_ccw
        assert not any(ring.is_ccw for ring in part.interiors)
    return found


def wrapped(polygon: Any) -> Any:
    """The same with longitudes of -180…180, corner by corner, as coordinate transforms give them."""
    return shapely.transform(
        polygon, lambda places: np.stack([(places[:, 0] + 180) % 360 - 180, places[:, 1]], axis=1)
    )


@pytest.mark.parametrize("turn", [-360, 0, 360])
@pytest.mark.parametrize("form", [lambda polygon: polygon, wrapped])
def test_a_clearing_across_the_antimeridian_has_a_part_on_either_side(turn: int, form: Any) -> None:
    clearing = shapely.box(179.9 + turn, -17, 180.2 + turn, -16.9)
    found = cut(form(clearing))
    assert found.geom_type == "MultiPolygon"
    assert found.equals(
        shapely.union(shapely.box(179.9, -17, 180, -16.9), shapely.box(-180, -17, -179.8, -16.9))
    )


def test_longitudes_to_360_are_brought_home() -> None:
    hole = shapely.box(300.02, -9.98, 300.03, -9.95)
    found = cut(shapely.box(300, -10, 300.1, -9.9).difference(hole))
    at_home = shapely.box(-59.98, -9.98, -59.97, -9.95)
    assert found.equals(shapely.box(-60, -10, -59.9, -9.9).difference(at_home))


@pytest.mark.parametrize("west", [179, -180, -181, 180])
def test_what_only_touches_the_antimeridian_stays_whole(west: int) -> None:
    assert cut(shapely.box(west, -17, west + 1, -16)).geom_type == "Polygon"
    assert cut(wrapped(shapely.box(west + 0.0, -17, west + 1, -16))).area == pytest.approx(1)


def test_holes_on_and_beside_the_antimeridian_stay_holes() -> None:
    for hole in (
        shapely.box(179.5, -16.5, 180.5, -15.5),
        shapely.box(180.2, -16.5, 180.5, -15.5),
        shapely.box(180, -16.5, 180.5, -15.5),
    ):
        around = shapely.box(179, -17, 181, -15).difference(hole)
        for form in (around, wrapped(around)):
            assert cut(form).area == pytest.approx(around.area)


def test_a_ring_round_a_pole_encloses_it() -> None:
    ring = [(longitude, -80) for longitude in range(-180, 180, 10)]
    island = shapely.polygons(ring)
    assert cut(island).equals(shapely.box(-180, -90, 180, -80))
    lake = [(longitude, -85) for longitude in range(-180, 180, 10)]
    assert cut(shapely.polygons(ring, holes=[lake])).equals(shapely.box(-180, -85, 180, -80))


def test_what_is_within_the_world_is_only_wound() -> None:
    polygon = shapely.reverse(shapely.box(10, 10, 20, 20).difference(shapely.box(12, 12, 13, 13)))
    assert shapely.equals_exact(
        cut(polygon), polygon if polygon.exterior.is_ccw else shapely.reverse(polygon)
    )


@given(
    st.integers(-180, 540),
    st.lists(st.tuples(st.integers(-40, 40), st.integers(-60, 60)), min_size=3, max_size=9),
)
def test_no_area_is_lost_or_made(middle: int, corners: list[tuple[int, int]]) -> None:
    polygon = shapely.convex_hull(shapely.multipoints([(middle + x, y) for x, y in corners]))
    if polygon.geom_type == "Polygon":
        for form in (polygon, wrapped(polygon)):
            assert cut(form).area == pytest.approx(polygon.area)
