"""Layered drawing of a graph: an order in each layer with few crossings, and places without overlap.

Sugiyama, Tagawa and Toda, "Methods for visual understanding of hierarchical system structures", IEEE Trans.
Syst., Man, Cybern. 11(2), 1981: barycentre sweeps; the places are least squares under the order found.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

Place = tuple[str, int]
"""Something at a layer: a box, or where a wire passes."""

Edge = tuple[Place, Place]
"""A connection from a layer to the next."""

_SWEEPS = 12


def order(columns: Sequence[Sequence[Place]], edges: Sequence[Edge]) -> list[list[Place]]:
    """The order in each layer with the fewest crossings that was found.

    Args:
        columns: the places of each layer, in any order.
        edges: their connections.
    """
    current = [list(column) for column in columns]
    best, fewest = [list(column) for column in columns], crossings(columns, edges)
    before, after = defaultdict(list), defaultdict(list)
    for left, right in edges:
        before[right].append(left)
        after[left].append(right)
    for sweep in range(_SWEEPS):
        forward = sweep % 2 == 0
        for column in current if forward else current[::-1]:
            ranks = _ranks(current)
            near = before if forward else after
            centres = {
                place: float(np.mean([ranks[x] for x in near[place]])) if near[place] else ranks[place]
                for place in column
            }
            column.sort(key=centres.__getitem__)
        if (found := crossings(current, edges)) < fewest:
            best, fewest = [list(column) for column in current], found
    return best


def crossings(columns: Sequence[Sequence[Place]], edges: Sequence[Edge]) -> int:
    """How many pairs of connections cross."""
    ranks = _ranks(columns)
    total = 0
    for layer in range(len(columns) - 1):
        ends = [(ranks[a], ranks[b]) for a, b in edges if a[1] == layer]
        left, right = np.array(ends, dtype=np.int64).reshape(-1, 2).T
        total += int(((left[:, np.newaxis] < left) & (right[:, np.newaxis] > right)).sum())
    return total


def middles(
    columns: Sequence[Sequence[Place]], edges: Sequence[Edge], heights: Mapping[Place, float], gap: float
) -> dict[Place, float]:
    """The middle of every place: near those it is connected with, in order, at least a gap apart.

    Args:
        columns: the places of each layer, in order.
        edges: their connections.
        heights: of each place.
        gap: between two places of a layer.

    Returns:
        The middles; the highest place begins at 0.
    """
    from scipy.optimize import isotonic_regression

    near = defaultdict(list)
    for left, right in edges:
        near[left].append(right)
        near[right].append(left)
    found: dict[Place, float] = {}
    stacked = []
    for column in columns:
        sizes = np.array([heights[place] for place in column])
        stack = np.cumsum(sizes + gap) - sizes / 2
        stacked.append(stack)
        found |= dict(zip(column, (stack - stack.mean()).tolist(), strict=True))
    for sweep in range(_SWEEPS):
        layers = list(zip(columns, stacked, strict=True))
        for column, stack in layers if sweep % 2 == 0 else layers[::-1]:
            wanted = [np.mean([found[x] for x in near[place] or [place]]) for place in column]
            # Least squares under a fixed order and least distances is isotonic regression.
            placed = isotonic_regression(np.array(wanted) - stack).x + stack
            found |= dict(zip(column, placed.tolist(), strict=True))
    top = min((found[place] - heights[place] / 2 for place in found), default=0.0)
    return {place: y - top for place, y in found.items()}


def straightened(points: Sequence[tuple[float, float]]) -> str:
    """An SVG path through points that is level at each of them."""
    path = "M{:.1f} {:.1f}".format(*points[0])
    for (x0, y0), (x1, y1) in pairwise(points):
        middle = (x0 + x1) / 2
        path += f"C{middle:.1f} {y0:.1f} {middle:.1f} {y1:.1f} {x1:.1f} {y1:.1f}"
    return path


def _ranks(columns: Sequence[Sequence[Place]]) -> dict[Place, int]:
    return {place: rank for column in columns for rank, place in enumerate(column)}
