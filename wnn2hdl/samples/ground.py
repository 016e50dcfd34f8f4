"""What lies where: roads, lots, clearings, rivers and forest of a landscape, before any colour.

The pattern is the Amazon's: a highway, side roads at right angles to it ("fishbone"), lots cleared from the
side roads inwards, forest left standing along streams and far from roads.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.samples.noise import Field, cell_random, smooth

CLASSES = ("forest", "pasture", "burnt soil", "bare ground", "river", "road")
"""Kinds of ground; a label is an index into them."""

FOREST, PASTURE, BURNT, BARE, RIVER, ROAD = range(len(CLASSES))

HIGHWAY_SPACING = 900.0
SIDE_ROAD_SPACING = 150.0
RIVER_SPACING = 1100.0
LOT_DEPTH = 80.0
"""Pixels between highways, between side roads, between rivers, and along a lot."""


@dataclass(frozen=True, eq=False)
class Ground:
    """A landscape without colour.

    Attributes:
        labels: uint8 ``[height, width]``, indices into `CLASSES`.
        relief: float32 ``[height, width]``, height above the mean, standard deviation 1.
        lot: float32 ``[4, height, width]``, four numbers in ``[0, 1)`` that belong to the pixel's lot.
        along: float32 ``[height, width]``, pixels along the highway, the direction of plough lines.
        across: float32 ``[height, width]``, pixels across it.
        bank: float32 ``[height, width]``, pixels to the river's nearer bank, negative in the water.
    """

    labels: NDArray[np.uint8]
    relief: Field
    lot: Field
    along: Field
    across: Field
    bank: Field


def lay_out(rng: np.random.Generator, shape: tuple[int, int], seed: int) -> Ground:
    """Lay a landscape out.

    Args:
        rng: where the noise comes from.
        shape: height and width in pixels, both at least 1.
        seed: the lots' random numbers.

    Returns:
        the ground; about a third to two thirds of it is forest.
    """
    height, width = shape
    y, x = np.meshgrid(np.arange(height, dtype=np.float32), np.arange(width, dtype=np.float32), indexing="ij")
    # The highway passes near the middle, so that every picture of some size shows both kinds of ground.
    y -= np.float32(height * rng.uniform(0.3, 0.7))
    x -= np.float32(width * rng.uniform(0.3, 0.7))
    relief = smooth(rng, shape, 220, octaves=5)

    angle = rng.uniform(0, np.pi)
    bend = smooth(rng, shape, 300, octaves=2)
    along = x * np.float32(np.cos(angle)) + y * np.float32(np.sin(angle)) + 10 * bend
    across = (
        y * np.float32(np.cos(angle))
        - x * np.float32(np.sin(angle))
        + 14 * smooth(rng, shape, 260, octaves=2)
    )

    labels, lot = _clear(rng, seed, along, across, relief)
    bank = _river_bank(rng, x, y, angle + rng.uniform(0.6, 2.2))
    gallery = (bank < 10 + 5 * smooth(rng, shape, 24, octaves=2)) & (labels != ROAD)
    labels[gallery] = FOREST
    labels[(bank < 0) & (labels != ROAD)] = RIVER
    return Ground(labels, relief, lot, along, across, bank)


def _clear(
    rng: np.random.Generator, seed: int, along: Field, across: Field, relief: Field
) -> tuple[NDArray[np.uint8], Field]:
    """Labels of forest, cleared ground and roads, and the random numbers of each lot."""
    shape = along.shape
    rough = smooth(rng, (shape[0], shape[1]), 12, octaves=2)
    highway = np.round(across / HIGHWAY_SPACING).astype(np.int32)
    from_highway = across - highway * np.float32(HIGHWAY_SPACING)
    side_road = np.round(along / SIDE_ROAD_SPACING).astype(np.int32)
    from_side_road = along - side_road * np.float32(SIDE_ROAD_SPACING)

    # A lot's column is one side of one side road; columns are staggered against each other.
    column = 2 * side_road + (from_side_road > 0)
    stagger = cell_random(seed, 0, highway, column)
    row = np.floor(across / np.float32(LOT_DEPTH) + stagger).astype(np.int32)
    lot = np.stack([cell_random(seed, salt, row, column) for salt in range(1, 5)])

    reach = 90 + 330 * cell_random(seed, 5, highway, side_road) ** 2
    depth = np.float32(SIDE_ROAD_SPACING) * (0.22 + 0.4 * lot[0])
    cleared = (
        (np.abs(from_highway) < reach + 4 * rough)
        & (np.abs(from_side_road) < depth + 2.5 * rough)
        & (cell_random(seed, 6, row, column) < 0.84)
    )
    # Plots of slash and burn without a road, and what was left standing or has grown again.
    plots = smooth(rng, (shape[0], shape[1]), 60, octaves=3)
    cleared |= plots > 2.1
    streams = np.abs(smooth(rng, (shape[0], shape[1]), 170, octaves=4) + 0.15 * relief)
    gallery = 0.05 + 0.09 * np.maximum(smooth(rng, (shape[0], shape[1]), 90), 0)
    cleared &= (streams > gallery + 0.02 * rough) & (plots > -1.35 + 0.1 * rough)

    use = lot[1]
    labels = np.zeros(shape, dtype=np.uint8)
    labels[cleared] = PASTURE
    labels[cleared & (use < 0.15)] = BARE
    labels[cleared & (use > 0.87)] = BURNT
    tracks = (np.abs(from_side_road) < 0.9) & (np.abs(from_highway) < reach)
    labels[tracks | (np.abs(from_highway) < 1.7)] = ROAD
    return labels, lot


def _river_bank(rng: np.random.Generator, x: Field, y: Field, angle: float) -> Field:
    """Pixels to the nearer bank of a meandering river, negative in the water."""
    shape = (x.shape[0], x.shape[1])
    offset = rng.uniform(-0.35, 0.35) * min(shape)
    downstream = x * np.float32(np.cos(angle)) + y * np.float32(np.sin(angle)) + 22 * smooth(rng, shape, 70)
    over = y * np.float32(np.cos(angle)) - x * np.float32(np.sin(angle)) + 16 * smooth(rng, shape, 60)
    over -= np.float32(offset)
    for length, swing in ((120, 22), (290, 45), (700, 80)):
        # Two sines of unrelated length do not repeat within a picture.
        phase, other = rng.uniform(0, 2 * np.pi, 2)
        over += swing * np.sin(downstream * np.float32(2 * np.pi / length) + phase)
        over += 0.6 * swing * np.sin(downstream * np.float32(2 * np.pi / (1.618 * length)) + other)
    middle = np.abs(over - np.round(over / RIVER_SPACING) * np.float32(RIVER_SPACING))
    # The meanders stretch distances; dividing by the gradient gives the river an even width.
    steepness = np.hypot(*np.gradient(over)) if min(shape) > 1 else np.float32(1)
    half_width = np.float32(rng.uniform(2.5, 9)) + 0.8 * smooth(rng, shape, 50)
    return np.asarray(middle / np.maximum(steepness, np.float32(0.5)) - half_width)
