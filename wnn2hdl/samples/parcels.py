"""How people divide land: highways, roads within their meshes, and parcels down to single lots.

Each mesh between two pairs of highways is cut in two again and again, the longer side first, at places
of its own; cuts are roads, lanes or mere boundaries by how early they were made. Unlike a regular grid, no
two places look alike, as navigation needs.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.samples.noise import Field, cell_random
from wnn2hdl.samples.plane import Window, plane_noise

MESH = 900
"""Pixels between highways, on average."""

DEPTH = 10
"""Cuts from a mesh to its smallest lots."""

_HIGHWAY = 8.0
_HALF_WIDTHS = (5.0, 5.0, 4.0, 4.0, 2.5, 2.5)
_STREET = 3.5
"""Half widths in pixels of highways, of the cuts by age, and of later cuts in towns."""

_FIELD_AREA, _LOT_AREA = 130.0**2, 52.0**2
"""A field or a lot of this size, in square pixels, is not cut further."""

_TOWN_DEPTH, _STREET_DEPTH = 4, 8


@dataclass(frozen=True, eq=False)
class Parcels:
    """The parcels of a window.

    Attributes:
        index: int32 ``[height, width]``, the pixel's parcel, an index into the fields of parcels.
        sides: float32 ``[4, height, width]``, pixels to the parcel's sides: low and high, along and across.
        road: float32 ``[height, width]``, pixels to the nearest road's edge, negative on it.
        highway: bool ``[height, width]``, true on highways.
        along: float32 ``[height, width]``, the direction of one family of roads; furrows follow it.
        across: float32 ``[height, width]``, the other.
        town: bool ``[parcels]``, whether it is part of a town.
        number: float32 ``[8, parcels]``, eight numbers of the parcel in ``[0, 1)``.
    """

    index: NDArray[np.int32]
    sides: Field
    road: Field
    highway: NDArray[np.bool_]
    along: Field
    across: Field
    town: NDArray[np.bool_]
    number: Field


def divide(seed: int, window: Window) -> Parcels:
    """Divide the land of a window; overlapping windows agree."""
    angle = np.pi * float(cell_random(seed, 1, np.zeros(1, np.int32), np.zeros(1, np.int32))[0])
    y, x = window.rows[:, np.newaxis].astype(np.float32), window.columns.astype(np.float32)
    cos, sin = np.float32(np.cos(angle)), np.float32(np.sin(angle))
    along = x * cos + y * sin + 45 * plane_noise(seed, 2, window, 600) + 3 * plane_noise(seed, 3, window, 90)
    across = y * cos - x * sin + 45 * plane_noise(seed, 4, window, 600) + 3 * plane_noise(seed, 5, window, 90)

    column, column_lines, first_column = _meshes(seed, 6, along)
    row, row_lines, first_row = _meshes(seed, 7, across)
    mesh_y, mesh_x = (
        grid.ravel()
        for grid in np.meshgrid(
            np.arange(len(row_lines) - 1), np.arange(len(column_lines) - 1), indexing="ij"
        )
    )
    tree = _Tree(
        seed,
        np.stack([column_lines[mesh_x], column_lines[mesh_x + 1], row_lines[mesh_y], row_lines[mesh_y + 1]]),
        (mesh_y + first_row).astype(np.int32),
        (mesh_x + first_column).astype(np.int32),
    )
    index = tree.locate(row * np.int32(len(column_lines) - 1) + column, along, across)
    edges = tree.edges.reshape(4, -1).astype(np.float32)
    sides = np.stack(
        [
            along - edges[0][index],
            edges[1][index] - along,
            across - edges[2][index],
            edges[3][index] - across,
        ]
    )
    widths = tree.widths.reshape(4, -1)
    # A boundary without a road is infinitely far from being one.
    from_road = np.stack([side - width[index] for side, width in zip(sides, widths, strict=True)])
    highway = np.zeros(window.shape, dtype=bool)
    for side, width in zip(sides, widths, strict=True):
        highway |= (side < _HIGHWAY) & (width[index] == _HIGHWAY)
    return Parcels(
        index, sides, from_road.min(axis=0), highway, along, across, tree.town.ravel(), tree.numbers()
    )


def _meshes(seed: int, salt: int, place: Field) -> tuple[NDArray[np.int32], NDArray[np.float64], int]:
    """Mesh of each pixel along one axis, from 0; the highways between them; the first one's number."""
    first, last = int(np.floor(place.min() / MESH)) - 1, int(np.floor(place.max() / MESH)) + 3
    numbers = np.arange(first, last, dtype=np.int32)
    jitter = cell_random(seed, salt, numbers, np.zeros_like(numbers)) - 0.5
    lines = (numbers + 0.5 * jitter.astype(np.float64)) * MESH
    return np.searchsorted(lines, place).astype(np.int32) - 1, lines, first


class _Tree:
    """The cuts of several meshes: complete binary trees whose last cuts may do nothing."""

    def __init__(
        self,
        seed: int,
        edges: NDArray[np.float64],
        row: NDArray[np.int32],
        column: NDArray[np.int32],
    ) -> None:
        """Cut meshes.

        Args:
            seed: the plane's.
            edges: float64 ``[4, meshes]``: low and high, along and across.
            row: mesh numbers across, int32 ``[meshes]``.
            column: mesh numbers along.
        """
        self._seed, self._row, self._column = seed, row, column
        meshes = len(row)
        self.edges = edges[:, :, np.newaxis]
        self.widths = np.full((4, meshes, 1), _HIGHWAY, dtype=np.float32)
        self.town = np.zeros((meshes, 1), dtype=bool)
        self._cuts: list[tuple[Field, NDArray[np.bool_]]] = []
        node = np.ones((meshes, 1), dtype=np.int32)
        quarter = self._random(11, node)
        for depth in range(DEPTH):
            if depth == 2:
                quarter = self._random(11, node)
            if depth == _TOWN_DEPTH:
                self.town = self._random(12, node) < np.where(quarter < 0.45, 0.85, 0.1)
            node = self._cut(depth, node)
            # Children of a quarter lie side by side, as do all fields of the tree.
            quarter, self.town = np.repeat(quarter, 2, axis=1), np.repeat(self.town, 2, axis=1)
        self._node = node

    def _random(self, salt: int, node: NDArray[np.int32]) -> Field:
        mixed = self._row[:, np.newaxis] * np.int32(9176) + self._column[:, np.newaxis]
        return cell_random(self._seed, salt, mixed, node)

    def _cut(self, depth: int, node: NDArray[np.int32]) -> NDArray[np.int32]:
        """Cut every parcel in two that is large enough; the next level's nodes."""
        low, high = self.edges[0::2], self.edges[1::2]
        size = high - low
        smallest = np.where(self.town, _LOT_AREA, _FIELD_AREA)
        # Some parcels stay large: a park, a factory, a wide field.
        stays = (size.prod(axis=0) < smallest) | ((self._random(13, node) < 0.06) & (depth >= _TOWN_DEPTH))
        axis = (size[1] > size[0]).astype(np.intp)
        share = 0.36 + 0.28 * self._random(14, node).astype(np.float64)
        chosen = axis[np.newaxis]
        place = np.take_along_axis(low, chosen, 0)[0] + share * np.take_along_axis(size, chosen, 0)[0]
        # Everything lies below a cut at infinity, so the upper child is never reached.
        self._cuts.append((np.where(stays, np.inf, place).astype(np.float32), axis == 1))

        if depth < len(_HALF_WIDTHS):
            width = np.full(node.shape, _HALF_WIDTHS[depth], dtype=np.float32)
        else:
            street = self.town if depth < _STREET_DEPTH else np.zeros_like(self.town)
            width = np.where(street, np.float32(_STREET), np.float32(-np.inf))
        edges, widths = np.repeat(self.edges, 2, axis=2), np.repeat(self.widths, 2, axis=2)
        for along in (0, 1):
            cut = ~stays & (axis == along)
            for child, side in ((0, 2 * along + 1), (1, 2 * along)):
                edges[side, :, child::2] = np.where(cut, place, edges[side, :, child::2])
                widths[side, :, child::2] = np.where(cut, width, widths[side, :, child::2])
        self.edges, self.widths = edges, widths
        return np.stack([2 * node, 2 * node + 1], axis=2).reshape(len(node), -1)

    def locate(self, mesh: NDArray[np.int32], along: Field, across: Field) -> NDArray[np.int32]:
        """Parcel of each pixel, as an index into the flattened fields."""
        index = mesh
        for place, over in self._cuts:
            coordinate = np.where(over.ravel()[index], across, along)
            index = 2 * index + (coordinate > place.ravel()[index])
        return np.asarray(index, dtype=np.int32)

    def numbers(self) -> Field:
        """Eight numbers of every parcel, float32 ``[8, parcels]``."""
        return np.stack([self._random(20 + salt, self._node).ravel() for salt in range(8)])
