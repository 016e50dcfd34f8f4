"""The weightless edges that a frame and a map of another date are matched by.

Three binary images (`binarise`) each pass four 3x3 edge filters: one set of patterns in
four turns, for edges whose brighter side lies east, north, west or south. That makes twelve binary edge
images, the channels. In hardware these are twelve edge filters, all with the same 512-entry table but for the
order of its nine inputs, behind two box means and three comparators.

Edges without a direction are poor evidence: in a town every place has some, and those of another date lie
beside them. A direction must agree as well, which a wrong place does by chance a quarter of the time.

The patterns are learned as a WiSARD learns: a RAM addressed by the window counts, over frames whose place is
known, how often the map has an edge with its brighter side east at the same place; a threshold on the counts,
as in bleaching, makes them the 512 bits of an `EdgeFilter`. The four discriminators share what they see, each
turned and mirrored to its own direction.

All of this works at `GSD_M`: map and patches are laid out at that ground sample distance, coarse enough that
leaning buildings, shadows and a pose that is a little off move edges by about a pixel. Scores of the channels
are combined by adding their sums, as `wnn2hdl.apps.navigation.channels.ChannelIndex` does.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.binarise import binary_images, shrunk
from wnn2hdl.apps.navigation.channels import ChannelIndex, Channels
from wnn2hdl.apps.navigation.geometry import Patch
from wnn2hdl.apps.navigation.matching import Window
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.ir import WINDOW_BITS, WINDOW_CODES, EdgeFilter, bits_to_codes, codes_to_bits, window_codes

GSD_M = 2.0
"""Ground sample distance that the edges are taken at, metres per pixel."""

THRESHOLD_M = 30.0
"""Side of the square whose mean is the local threshold: larger than a house, smaller than a field."""

LIFT = 1.25
"""A pattern is learned if the map has the edge this many times as often there as anywhere."""

PRIOR = 20.0
"""Each pattern counts as seen this many times beforehand, beside edges as often as anywhere."""

REGISTER_M = 40.0
"""How far around its place a training frame is looked for: what a tilt of 18 degrees makes at 120 m."""

TURNS = 4
_WINDOWS = codes_to_bits(np.arange(WINDOW_CODES), WINDOW_BITS).reshape(WINDOW_CODES, 3, 3)


@dataclass(frozen=True, eq=False)
class Sighting:
    """A training frame.

    Attributes:
        patches: the frame laid on the ground, once for each heading that is thought possible.
        row: of the point below the UAV, pixels of the map's grid.
        column: of the same point.
    """

    patches: tuple[Patch, ...]
    row: float
    column: float


@dataclass(frozen=True, eq=False)
class WeightlessEdges:
    """Binary images and edge filters, of which only one direction's patterns are kept.

    Attributes:
        gsd_m: ground sample distance of the pictures that it is meant for, metres per pixel.
        side: of the local threshold's square, pixels, odd.
        east: the filter of edges whose brighter side lies east.
    """

    gsd_m: float
    side: int
    east: EdgeFilter

    @cached_property
    def filters(self) -> tuple[EdgeFilter, ...]:
        """The four filters: brighter side east, north, west, south."""
        return tuple(
            EdgeFilter(f"{self.east.name}-{side}", self.east.patterns[_turned(-turn)])
            for turn, side in enumerate(("east", "north", "west", "south"))
        )

    def extract(
        self, picture: NDArray[np.uint8], valid: NDArray[np.bool_]
    ) -> tuple[Channels, NDArray[np.bool_]]:
        """The edges of a map or of a patch.

        Args:
            picture: uint8 ``[height, width, 3]``, at least 3x3, at `gsd_m`.
            valid: bool ``[height, width]``.

        Returns:
            bool ``[12, height, width]``, by binary image, then direction; and bool ``[height, width]``, where
            all pixels of the 3x3 window are valid. Edges are false elsewhere.
        """
        inside = shrunk(valid, 1)
        codes = _codes(picture, valid, self.side)
        edges = np.stack([one.evaluate(code) for code in codes for one in self.filters])
        return np.asarray(edges & inside), inside

    def to_json(self) -> dict[str, Any]:
        """A JSON object of all three attributes."""
        return {"gsd_m": self.gsd_m, "side": self.side, "east": self.east.to_json()}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`.

        Raises:
            ModelFileError: it is anything else, or of another ground sample distance than `GSD_M`.
        """
        east = EdgeFilter.from_json(data["east"])
        if data["gsd_m"] != GSD_M or data["side"] != _odd(THRESHOLD_M / GSD_M):
            raise ModelFileError(
                "the weightless edges are meant for another grid",
                value=f"{data['gsd_m']} m, {data['side']} pixels",
            )
        return cls(GSD_M, data["side"], east)


def by_rule(gsd_m: float = GSD_M) -> WeightlessEdges:
    """Edges without training: a pattern is one of the side towards which its Sobel gradient points.

    A pattern whose gradient points between two sides belongs to both.
    """
    gradient = np.array([[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]])
    across = (_WINDOWS * gradient).sum(axis=(1, 2))
    down = (_WINDOWS * gradient.T).sum(axis=(1, 2))
    patterns = (across > 0) & (across >= np.abs(down))
    return WeightlessEdges(gsd_m, _odd(THRESHOLD_M / gsd_m), EdgeFilter("gradient", patterns))


def learn(
    picture: NDArray[np.uint8],
    valid: NDArray[np.bool_],
    sightings: Iterable[Sighting],
    gsd_m: float = GSD_M,
) -> WeightlessEdges:
    """Learn the patterns from frames whose place is known to some 40 m, and the map under them.

    Each frame is first registered: the heading and place near the given one whose edges by rule fit the map
    best. Then window by window, the map's edge at the same place is counted. What is counted from frame to
    map is counted from map to frame too, as both are to be filtered by the same patterns.

    Args:
        picture: the map, uint8 ``[rows, columns, 3]``, at ``gsd_m``.
        valid: bool ``[rows, columns]``.
        sightings: training frames; none that is scored later.
        gsd_m: ground sample distance of map and patches.

    Raises:
        InputError: no frame shows anything of the map.
    """
    rule = by_rule(gsd_m)
    ground, inside = rule.extract(picture, valid)
    index = ChannelIndex(ground, inside)
    radius = REGISTER_M / gsd_m
    map_codes = _codes(picture, valid, rule.side)
    pairs = np.zeros((WINDOW_CODES, WINDOW_CODES))
    for sighting in sightings:
        registered = _registered(index, rule, sighting, radius)
        if registered is None:
            continue
        patch, row, column = registered
        rows, columns = (
            _overlap(row, patch.valid.shape[0], inside.shape[0]),
            _overlap(column, patch.valid.shape[1], inside.shape[1]),
        )
        under = np.s_[rows.start + row : rows.stop + row, columns.start + column : columns.stop + column]
        common = shrunk(patch.valid, 1)[rows, columns] & inside[under]
        patch_codes = _codes(patch.image, patch.valid, rule.side)
        for seen, codes in zip(patch_codes, map_codes, strict=True):
            both = seen[rows, columns][common] * WINDOW_CODES + codes[under][common]
            pairs += np.bincount(both, minlength=pairs.size).reshape(pairs.shape)
    if not pairs.any():
        raise InputError(
            "no training frame shows anything of the map",
            hint="train on frames that the map shows, or correct their positions",
        )
    return WeightlessEdges(gsd_m, rule.side, EdgeFilter("learned", _patterns(pairs, rule.east.patterns)))


def _codes(picture: NDArray[np.uint8], valid: NDArray[np.bool_], side: int) -> list[NDArray[np.int64]]:
    """Of each binary image the code of every pixel's window, ``[height, width]``; 0 at the rim."""
    return [np.pad(window_codes(image), 1) for image in binary_images(picture, valid, side)]


def _registered(
    index: ChannelIndex, edges: WeightlessEdges, sighting: Sighting, radius: float
) -> tuple[Patch, int, int] | None:
    """The patch that fits best near where it should be, and map row and column of its top left pixel."""
    best: tuple[float, Patch, int, int] | None = None
    for patch in sighting.patches:
        window = Window.around(sighting.row - patch.nadir_row, sighting.column - patch.nadir_col, radius)
        match = index.search(*edges.extract(patch.image, patch.valid), "ncc", window)
        if match is not None and (best is None or match.score > best[0]):
            best = match.score, patch, match.row, match.col
    return None if best is None else best[1:]


def _patterns(pairs: NDArray[np.float64], target: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Windows beside which the other picture has a window of ``target`` often: bool ``[512]``."""
    symmetries: Sequence[NDArray[np.int64]] = [
        codes for turn in range(TURNS) for codes in (_turned(turn), _turned(turn)[_MIRRORED])
    ]
    pooled = sum((pairs[np.ix_(codes, codes)] for codes in symmetries), np.zeros_like(pairs))
    pooled = pooled + pooled.T
    seen, hits = pooled.sum(axis=1), pooled[:, target].sum(axis=1)
    usual = hits.sum() / seen.sum()
    return np.asarray(hits + PRIOR * usual > LIFT * usual * (seen + PRIOR))


def _turned(quarters: int) -> NDArray[np.int64]:
    """For each window code that of the window turned counter-clockwise: int64 ``[512]``."""
    return bits_to_codes(np.rot90(_WINDOWS, quarters, axes=(1, 2)).reshape(WINDOW_CODES, WINDOW_BITS))


_MIRRORED = bits_to_codes(_WINDOWS[:, ::-1].reshape(WINDOW_CODES, WINDOW_BITS))
"""For each window code that of the window with its rows in reverse."""


def _overlap(first: int, length: int, limit: int) -> slice:
    """Indices of something of a length, laid at ``first``, that lie within 0 to ``limit``."""
    return slice(max(-first, 0), max(min(length, limit - first), 0))


def _odd(pixels: float) -> int:
    return 2 * round((pixels - 1) / 2) + 1
