"""Town and country from the air: roads, houses, fields, woods, trees and rivers on an unbounded plane.

At 0.5 m per pixel. What lies where depends on the seed alone; the season changes fields, grass, water and
where the sun stands, so that two pictures of one place differ as a map and a later flight do.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.samples.noise import Field, cell_random
from wnn2hdl.samples.parcels import Parcels, divide
from wnn2hdl.samples.plane import Window, plane_noise
from wnn2hdl.samples.render import Season

GROUND_SAMPLE_DISTANCE_M = 0.5

WOOD, GRASS, CROP, SOIL, GARDEN, YARD, ROAD, WATER, ROOF = range(9)
"""What covers the ground."""

_COLOURS = {
    "dry": (
        ((34, 54, 38), (56, 76, 48)),
        ((112, 112, 70), (158, 142, 100)),
        ((150, 132, 84), (186, 168, 120)),
        ((136, 108, 84), (176, 148, 120)),
        ((86, 98, 60), (122, 120, 82)),
        ((120, 118, 114), (176, 170, 160)),
        ((112, 110, 110), (128, 126, 122)),
        ((62, 70, 62), (84, 88, 76)),
    ),
    "wet": (
        ((28, 52, 34), (50, 78, 46)),
        ((70, 104, 56), (106, 128, 72)),
        ((58, 92, 48), (112, 136, 70)),
        ((92, 74, 62), (128, 106, 90)),
        ((60, 92, 52), (92, 116, 68)),
        ((104, 104, 104), (158, 154, 150)),
        ((84, 84, 88), (100, 100, 102)),
        ((44, 60, 62), (92, 86, 66)),
    ),
}
"""Darkest and brightest red, green and blue of each cover but roofs."""

_ROOFS = (
    (168, 74, 54),
    (146, 86, 66),
    (186, 186, 190),
    (222, 222, 218),
    (98, 116, 150),
    (112, 108, 104),
    (196, 172, 138),
)

_GRAIN = np.array((0.16, 0.05, 0.06, 0.05, 0.10, 0.06, 0.03, 0.02, 0.02), dtype=np.float32)
_PATCHES = np.array((0.10, 0.10, 0.05, 0.08, 0.06, 0.05, 0.04, 0.03, 0.0), dtype=np.float32)
"""Brightness that texture of 1.5 m and of 15 m adds, a standard deviation, by cover."""

_TREES = np.array((0.0, 0.07, 0.01, 0.01, 0.45, 0.08, 0.0, 0.0, 0.0), dtype=np.float32)
"""Chance of a tree in each cell of `_TREE_CELL` pixels, by cover."""

_TREE_CELL = 18

_SUN = {"dry": ((-1, 1), (-2, 2), (-3, 3), (-4, 4)), "wet": ((1, 1), (2, 1), (3, 2))}
"""Where shadows fall, in rows and columns: the sun stands lower in the dry season's picture."""

_MARGIN = 8
"""Pixels around a window that reach into it, by shadow and blur."""

_TILE = 512


@dataclass(frozen=True, eq=False)
class _Scene:
    """The covers of a window and what they are coloured by."""

    cover: NDArray[np.uint8]
    tall: NDArray[np.bool_]
    tree: NDArray[np.bool_]
    parcels: Parcels


def paint(seed: int, window: Window, season: Season) -> NDArray[np.uint8]:
    """The picture of a window.

    Args:
        seed: the plane's, at least 0.
        window: where, in pixels of half a metre; overlapping windows agree where both look.
        season: dry or wet.

    Returns:
        uint8 ``[height, width, 3]``: red, green, blue. Time grows with the number of pixels; memory beyond
        the picture's own does not.
    """
    picture = np.empty((*window.shape, 3), dtype=np.uint8)
    # Tiles stay in the processor's cache and bound the memory.
    for y in range(0, window.height, _TILE):
        for x in range(0, window.width, _TILE):
            tile = Window(
                window.top + y,
                window.left + x,
                min(_TILE, window.height - y),
                min(_TILE, window.width - x),
            )
            picture[y : y + tile.height, x : x + tile.width] = _paint_tile(seed, tile, season)
    return picture


def _paint_tile(seed: int, tile: Window, season: Season) -> NDArray[np.uint8]:
    window = tile.padded(_MARGIN)
    scene = _lay(seed, window, season)
    colour = _colour(seed, window, scene, season)
    shaded = np.zeros(window.shape, dtype=bool)
    for rows, columns in _SUN[season]:
        shaded |= np.roll(scene.tall, (rows, columns), (0, 1))
    colour *= np.where(shaded & ~scene.tall, np.float32(0.55), np.float32(1))[..., np.newaxis]
    cv2.GaussianBlur(colour, (0, 0), 0.7, dst=colour)
    inner = colour[_MARGIN:-_MARGIN, _MARGIN:-_MARGIN]
    return np.clip(np.rint(inner), 0, 255).astype(np.uint8)


def _lay(seed: int, window: Window, season: Season) -> _Scene:
    """What covers each pixel."""
    parcels = divide(seed, window)
    index = parcels.index
    cover = _uses(parcels)[index]
    house = _houses(parcels) & (cover == GARDEN)
    wood = plane_noise(seed, 40, window, 420, octaves=4) + np.where(parcels.town, -1.2, 0.0)[index]
    cover[wood > 1.0] = WOOD
    cover[house] = ROOF
    tree = _trees(seed, window, cover, parcels.road)
    # A hedge or a row of trees grows along some of the boundaries between fields.
    hedge = (parcels.sides.min(axis=0) < 2.2) & (parcels.number[5] < 0.35)[index] & ~parcels.town[index]
    hedge &= (cover == GRASS) | (cover == CROP) | (cover == SOIL)
    bank = _bank(seed, window)
    tree |= hedge | ((bank < 9 + 5 * plane_noise(seed, 41, window, 30)) & (cover != ROOF))
    cover[parcels.road < 0] = ROAD
    tree &= cover != ROAD
    water = (bank < (0.0 if season == "wet" else -2.0)) & ~parcels.highway
    cover[water] = WATER
    tree &= ~water
    cover[tree] = WOOD
    return _Scene(cover, (cover == WOOD) | (cover == ROOF), tree, parcels)


def _uses(parcels: Parcels) -> NDArray[np.uint8]:
    """Cover of each parcel, uint8 ``[parcels]``, before anything stands on it."""
    chance = parcels.number[0]
    country = np.select(
        [chance < 0.16, chance < 0.48, chance < 0.80, chance < 0.92], [WOOD, GRASS, CROP, SOIL], GARDEN
    )
    town = np.select([chance < 0.78, chance < 0.90, chance < 0.96], [GARDEN, YARD, GRASS], WOOD)
    return np.where(parcels.town, town, country).astype(np.uint8)


def _houses(parcels: Parcels) -> NDArray[np.bool_]:
    """True under roofs: a rectangle in each garden, at its own distance from each side."""
    inside = np.ones(parcels.index.shape, dtype=bool)
    for side, number in zip(parcels.sides, parcels.number[1:5], strict=True):
        inside &= side > (5 + 9 * number)[parcels.index]
    return inside


def _trees(seed: int, window: Window, cover: NDArray[np.uint8], road: Field) -> NDArray[np.bool_]:
    """True under single trees; a cell has room for one, and they keep off roads."""
    row, y = np.divmod(window.rows, _TREE_CELL)
    column, x = np.divmod(window.columns, _TREE_CELL)
    cell_row = np.unique(row)[:, np.newaxis].astype(np.int32)
    cell_column = np.unique(column).astype(np.int32)
    at = np.ix_(row - row[0], column - column[0])
    chance, up, over, size = (cell_random(seed, salt, cell_row, cell_column)[at] for salt in range(50, 54))
    radius = 2.5 + 3.5 * size
    room = _TREE_CELL - 1 - 2 * radius
    from_top = y[:, np.newaxis] - radius - up * room
    from_left = x - radius - over * room
    tree = (from_top**2 + from_left**2 < radius**2) & (road > 1.5)
    return np.asarray(tree & (chance < _TREES[cover]))


def _bank(seed: int, window: Window) -> Field:
    """Pixels to the bank of the nearest river, roughly, negative in the water."""
    level = plane_noise(seed, 60, window.padded(1), 800, octaves=3)
    slope = np.hypot(level[2:, 1:-1] - level[:-2, 1:-1], level[1:-1, 2:] - level[1:-1, :-2]) / 2
    half_width = 13 + 4 * plane_noise(seed, 61, window, 300)
    return np.asarray(np.abs(level[1:-1, 1:-1]) / np.maximum(slope, np.float32(1e-3)) - half_width)


def _colour(seed: int, window: Window, scene: _Scene, season: Season) -> Field:
    """Colour of the covers under an even light, float32 ``[height, width, 3]``."""
    parcels, cover = scene.parcels, scene.cover
    index = parcels.index
    # A field's state is another each season; a yard's or a roof's is not.
    state = parcels.number[6 if season == "dry" else 7].copy()
    patches = plane_noise(seed, 70 if season == "dry" else 71, window, 30, octaves=3)
    grain = plane_noise(seed, 72, window, 3) + np.float32(0.5) * plane_noise(seed, 73, window, 1.5)

    dark = np.array([low for low, _ in _COLOURS[season]] + [(0, 0, 0)], dtype=np.float32)
    bright = np.array([high for _, high in _COLOURS[season]] + [(0, 0, 0)], dtype=np.float32)
    share = state[index]
    share[(cover == ROAD) | (cover == WATER) | scene.tree] = 0.5
    colour = dark[cover] + (bright - dark)[cover] * share[..., np.newaxis]

    roof = cover == ROOF
    kind = (parcels.number[5] * len(_ROOFS)).astype(np.intp)
    lit = np.where(parcels.sides[2] < parcels.sides[3], np.float32(1.08), np.float32(0.84))
    colour[roof] = np.array(_ROOFS, dtype=np.float32)[kind[index[roof]]] * lit[roof, np.newaxis]

    light = 1 + _GRAIN[cover] * grain + _PATCHES[cover] * patches
    furrows = np.sin(np.where(state[index] < 0.5, parcels.along, parcels.across) * np.float32(0.9))
    light += np.float32(0.07) * furrows * ((cover == CROP) | (cover == SOIL))
    # Kerbs and the line in the middle of a highway.
    light += np.float32(0.25) * ((cover == ROAD) & (parcels.road > -1.2))
    light += np.float32(0.35) * ((cover == ROAD) & (parcels.road < -7.4))
    return np.asarray(colour * np.clip(light, 0.5, 1.6)[..., np.newaxis], dtype=np.float32)
