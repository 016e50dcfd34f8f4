"""Layers in an order with few crossings, and places that do not overlap."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.report.placement import Edge, Place, crossings, middles, order, straightened


@st.composite
def layered(draw: st.DrawFn) -> tuple[list[list[Place]], list[Edge]]:
    sizes = draw(st.lists(st.integers(1, 5), min_size=1, max_size=4))
    columns = [[(f"n{i}", layer) for i in range(size)] for layer, size in enumerate(sizes)]
    possible = [(a, b) for left, right in pairwise(columns) for a in left for b in right]
    return columns, draw(st.lists(st.sampled_from(possible), unique=True)) if possible else []


def test_two_wires_that_cross_are_untangled() -> None:
    columns: list[list[Place]] = [[("a", 0), ("b", 0)], [("c", 1), ("d", 1)]]
    edges: list[Edge] = [(("a", 0), ("d", 1)), (("b", 0), ("c", 1))]
    assert crossings(columns, edges) == 1
    assert crossings(order(columns, edges), edges) == 0


@given(layered())
def test_the_order_keeps_every_place_and_crosses_no_more_than_before(
    graph: tuple[list[list[Place]], list[Edge]],
) -> None:
    columns, edges = graph
    found = order(columns, edges)
    assert [sorted(column) for column in found] == [sorted(column) for column in columns]
    assert crossings(found, edges) <= crossings(columns, edges)


@given(layered())
def test_places_stand_in_order_with_a_gap(graph: tuple[list[list[Place]], list[Edge]]) -> None:
    columns, edges = graph
    heights = {place: 10.0 + 5 * place[1] for column in columns for place in column}
    ys = middles(columns, edges, heights, 4)
    for column in columns:
        for above, below in pairwise(column):
            least = (heights[above] + heights[below]) / 2 + 4
            assert ys[below] - ys[above] >= least - 1e-6
    assert abs(min(ys[place] - heights[place] / 2 for place in ys)) < 1e-6


def test_a_straight_wire_is_a_straight_path() -> None:
    assert straightened([(0, 5), (10, 5)]) == "M0.0 5.0C5.0 5.0 5.0 5.0 10.0 5.0"
