"""Landscapes of the Amazon's arc of deforestation as a satellite camera shows them, with exact labels.

Colours follow Planet's and Sentinel-2's pictures of the region: dark forest, tan or green pasture,
purple-brown burnt soil, bright bare ground and roads, muddy rivers; then sunlight on the relief, haze, the
camera's blur and its noise. A pixel's colour does not give its class away for certain: trees stand in
pastures, wet pasture and young growth are near forest in colour, burnt soil is as dark as canopy.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.samples.ground import BARE, BURNT, FOREST, PASTURE, RIVER, ROAD, Ground, lay_out
from wnn2hdl.samples.noise import Field, grains, smooth

Season = Literal["dry", "wet"]

NOT_DEFORESTED = (FOREST, RIVER)
"""A mask of two classes calls these forest: a river was never felled."""


@dataclass(frozen=True, eq=False)
class Landscape:
    """A picture and the truth about it.

    Attributes:
        image: uint8 ``[height, width, 3]``: red, green, blue.
        labels: uint8 ``[height, width]``: indices into `wnn2hdl.samples.CLASSES`.
    """

    image: NDArray[np.uint8]
    labels: NDArray[np.uint8]

    @property
    def deforested(self) -> NDArray[np.bool_]:
        """The mask of two classes: true for all but forest and river."""
        return ~np.isin(self.labels, NOT_DEFORESTED)


def landscape(height: int, width: int, seed: int, *, season: Season = "dry") -> Landscape:
    """Generate a landscape; the same arguments give the same bytes.

    Args:
        height: pixels, at least 1.
        width: pixels, at least 1.
        seed: at least 0; the layout and all noise depend on it.
        season: pastures are tan in the dry season and green in the wet.

    Returns:
        the picture and its labels. Time grows with the number of pixels, memory to about 110 bytes each.

    Raises:
        InputError: a side without pixels, or a negative seed.
    """
    if min(height, width) < 1 or seed < 0:
        raise InputError(
            "no landscape has this size or seed",
            value=f"{width}x{height}, seed {seed}",
            hint="use sides of at least 1 and a seed of at least 0",
        )
    shape = (height, width)
    rng = np.random.default_rng([seed, 0x57AE])
    ground = lay_out(rng, shape, seed)
    colour = _paint(rng, ground, season)
    colour *= _light(ground)[..., np.newaxis]
    colour *= np.float32(rng.uniform(0.85, 1.15))
    _add_haze(rng, colour)
    colour = np.asarray(cv2.GaussianBlur(colour, (0, 0), 0.55), dtype=np.float32).reshape(height, width, 3)
    for channel in range(3):
        colour[..., channel] += 1.8 * rng.standard_normal(shape, dtype=np.float32)
    return Landscape(np.clip(np.rint(colour), 0, 255).astype(np.uint8), ground.labels)


def _paint(rng: np.random.Generator, ground: Ground, season: Season) -> Field:
    """Colour of the ground itself, float32 ``[height, width, 3]``."""
    shape = (ground.labels.shape[0], ground.labels.shape[1])
    patches = smooth(rng, shape, 40, octaves=4)
    fine = grains(rng, shape, 0.9)
    kinds: dict[int, Callable[[], Field]] = {
        FOREST: lambda: _forest(rng, shape, patches),
        PASTURE: lambda: _pasture(rng, ground, patches, fine, season),
        BURNT: lambda: _burnt(rng, ground, patches) + _grey(4 * fine),
        BARE: lambda: (
            _mix((138, 106, 84), (192, 158, 128), 0.2 + 0.6 * ground.lot[2] + 0.2 * patches) + _grey(4 * fine)
        ),
        RIVER: lambda: _mix((44, 58, 56), (116, 100, 78), float(rng.random()) + 0.05 * patches),
        ROAD: lambda: _mix((150, 118, 94), (196, 166, 138), 0.5 + 0.3 * patches) + _grey(4 * fine),
    }
    colour = np.empty((*shape, 3), dtype=np.float32)
    # Each kind is painted on the whole picture and dropped before the next, to bound the memory.
    for label, paint in kinds.items():
        np.copyto(colour, paint(), where=(ground.labels == label)[..., np.newaxis])
    return colour


def _forest(rng: np.random.Generator, shape: tuple[int, int], patches: Field) -> Field:
    """Canopy: crowns of two sizes, lit from one side, on slow changes of colour; some thinned by fire."""
    crowns = grains(rng, shape, 1.1) + 0.7 * grains(rng, shape, 2.2)
    lit = _shifted(crowns, 1) - crowns
    colour = _mix((32, 52, 41), (50, 72, 50), 0.45 + 0.3 * patches)
    thinned = np.clip(0.9 * smooth(rng, shape, 90, octaves=4) - 1.4, 0, 0.5)
    colour += thinned[..., np.newaxis] * (np.array((88, 88, 66), dtype=np.float32) - colour)
    return np.asarray(colour * (1 + 0.10 * crowns + 0.08 * lit)[..., np.newaxis], dtype=np.float32)


def _burnt(rng: np.random.Generator, ground: Ground, patches: Field) -> Field:
    """Charred ground with pale ash along felled trunks and green that the fire left out."""
    shape = (ground.labels.shape[0], ground.labels.shape[1])
    colour = _mix((58, 50, 50), (100, 84, 76), 0.2 + 0.5 * ground.lot[2] + 0.25 * patches)
    ash = np.clip(smooth(rng, shape, 9, octaves=3) - 1.0, 0, 1)[..., np.newaxis]
    green = np.clip(1.5 * smooth(rng, shape, 26, octaves=3) - 1.8, 0, 0.8)[..., np.newaxis]
    colour += ash * np.array((34, 32, 31), np.float32) + green * np.array((-10, 14, -8), np.float32)
    return colour


def _pasture(rng: np.random.Generator, ground: Ground, patches: Field, fine: Field, season: Season) -> Field:
    """Grass from green to dry by lot, plough lines in some lots, shrubs, single trees."""
    shape = (ground.labels.shape[0], ground.labels.shape[1])
    dryness = {"dry": 0.3, "wet": -0.2}[season] + 0.7 * ground.lot[2] + 0.2 * patches
    colour = _mix((66, 90, 54), (164, 138, 108), dryness)
    lines = np.sin(np.where(ground.lot[3] < 0.5, ground.along, ground.across) * np.float32(1.3))
    ploughed = np.abs(ground.lot[3] - 0.5) < 0.15
    colour += _grey(3 * fine + 3.5 * ploughed * lines)
    # Where a pasture is given up, shrubs close in until only the texture differs from forest.
    shrubs = np.clip(smooth(rng, shape, 45, octaves=5) + 2.2 * ground.lot[0] - 2.0, 0, 0.9)[..., np.newaxis]
    colour += shrubs * (np.array((52, 76, 48), np.float32) + _grey(5 * fine) - colour)
    trees = grains(rng, shape, 1.1) > 2.3 + 1.6 * ground.lot[3]
    colour[trees] = (44, 64, 44)
    return colour


def _light(ground: Ground) -> Field:
    """Brightness of the relief under a low sun in the north-west, and forest edges' shadows."""
    slope = np.zeros_like(ground.relief)
    for axis in range(2):
        if ground.relief.shape[axis] > 1:
            slope += np.gradient(ground.relief, axis=axis)
    standing = (ground.labels == FOREST).astype(np.float32)
    shadow = np.maximum(_shifted(standing, 2) - standing, 0)
    return np.asarray(np.clip(1 + 1.2 * slope, 0.75, 1.25) * (1 - 0.35 * shadow), dtype=np.float32)


def _add_haze(rng: np.random.Generator, colour: Field) -> None:
    """Thin smoke that covers contrast and adds its own pale blue."""
    shape = (colour.shape[0], colour.shape[1])
    veil = np.clip(rng.uniform(0.02, 0.12) + 0.035 * smooth(rng, shape, 380, octaves=3), 0, 0.4)[
        ..., np.newaxis
    ]
    colour *= 1 - veil
    colour += veil * np.array((168, 176, 184), dtype=np.float32)


def _mix(low: tuple[int, int, int], high: tuple[int, int, int], share: Field | float) -> Field:
    """From colour ``low`` at share 0 to ``high`` at 1, float32 ``S + (3,)``; shares are cut to that range."""
    weight = np.clip(np.asarray(share, dtype=np.float32), 0, 1)[..., np.newaxis]
    return np.asarray(
        np.array(low, np.float32) + weight * (np.array(high, np.float32) - np.array(low, np.float32))
    )


def _shifted(field: Field, by: int) -> Field:
    """The field moved down and to the right, its border repeated."""
    return np.pad(field, ((by, 0), (by, 0)), mode="edge")[: field.shape[0], : field.shape[1]]


def _grey(values: Field) -> Field:
    return values[..., np.newaxis]
