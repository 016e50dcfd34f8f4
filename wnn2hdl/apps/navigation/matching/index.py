"""A map made ready for many searches: coarse first, then exact."""

from threading import Lock

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching.peaks import Cells, Match, Peak, Window, find_peaks, keep_apart
from wnn2hdl.apps.navigation.matching.query import Query
from wnn2hdl.apps.navigation.matching.scores import Picture, Score, Sums, Values, check_score
from wnn2hdl.apps.navigation.matching.spectra import Layers, Spectra, cut, slide
from wnn2hdl.apps.navigation.matching.tiles import Tiles, tile_side
from wnn2hdl.errors import InputError

DIRECT = 1 << 22
"""Searches of up to this many positions are scored exactly by default."""

CELL = 32
CELLS = 64
"""How many squares of what side a coarse search names, all positions of which are then scored exactly."""


class MapIndex:
    """A map, and what searches in it share.

    A search of at most ``direct`` positions scores each of them exactly: sums by transforms in double
    precision, rounded to the whole numbers they are, ties to the lowest row, then column. (The error of a
    sum before rounding is at most about ``3 eps log2(size) |f| |w|``: 0.002 for squares of 8-bit pictures, a
    template of 500 x 500 and a patch of 4096 x 4096.)

    A larger search first scores all positions of map and template shrunk by ``reduction``, with spectra of
    the map that are kept from search to search, and then exactly the `CELLS` most promising squares. Scores
    returned are exact; that the best position of all lies in one of the squares is likely, not certain: what
    is finer than the shrunk pixels is lost at first, and with it weak matches of thin noisy edges. Mean and
    deviation of a match are then those of the shrunk scores, whose deviation is smaller: confidences of large
    and of small searches are not of one scale.

    Args:
        image: ``[height, width]``, bool, uint8 or float32; kept, not copied.
        valid: bool ``[height, width]``, the pixels that hold the map; all by default; kept, not copied.
        reduction: factor by which the coarse search shrinks: 1, 2, 4 or 8.
        direct: searches of at most this many positions are exact throughout.

    Raises:
        InputError: types or shapes do not fit.
    """

    def __init__(
        self,
        image: Picture,
        valid: NDArray[np.bool_] | None = None,
        *,
        reduction: int = 2,
        direct: int = DIRECT,
    ) -> None:
        self._image, self._valid = _checked(image, valid)
        if reduction not in (1, 2, 4, 8):
            raise InputError("a map cannot be shrunk by this", value=reduction, hint="use 1, 2, 4 or 8")
        self._reduction = reduction
        self._direct = direct
        self._tiles: dict[int, Tiles] = {}
        # Searches may run in threads: they wait for the tiles instead of each making them.
        self._making = Lock()

    @property
    def nbytes(self) -> int:
        """Memory held for searches, without image and valid pixels themselves."""
        return sum(tiles.nbytes for tiles in self._tiles.values())

    def search(
        self,
        template: Picture,
        mask: NDArray[np.bool_] | None = None,
        score: Score = "ncc",
        window: Window | None = None,
        *,
        min_overlap: float = 0.75,
        exclusion: int = 20,
    ) -> Match | None:
        """Where the template fits best.

        Args:
            template: of the map's type, ``[h, w]``.
            mask: bool ``[h, w]``, its pixels that count (a rotated frame's footprint); all by default.
            score: how a position is judged.
            window: allowed positions of the template's top left pixel; by default all that touch the map.
            min_overlap: least share of the mask's pixels that must be common with the map's valid ones. Below
                1 a template may reach beyond the map; only common pixels are then scored.
            exclusion: peaks are more than this many rows or columns apart.

        Returns:
            the match; None if no position has enough common pixels.

        Raises:
            InputError: types or shapes do not fit, or the score is not for such pictures.
        """
        template, mask = _checked(template, mask)
        if template.dtype != self._image.dtype:
            raise InputError(
                "template and map are of different types", value=f"{template.dtype}, {self._image.dtype}"
            )
        check_score(score, template)
        query = Query(Layers.of(template, mask, np.float64), score, min_overlap)
        height, width = template.shape
        touching = Window(1 - height, 1 - width, *self._image.shape)
        window = touching if window is None else window.clip(touching)
        if not window.positions:
            return None
        if window.positions <= self._direct:
            return find_peaks(self._exact(query, window), window, exclusion)
        cells = self._coarse(query, window)
        peaks: list[Peak] = []
        for cell in cells.best:
            # Map and template are cut into coarse pixels at different phases: up to one either side.
            top, left = (first * self._reduction - self._reduction for first in (cell.row, cell.col))
            side = CELL + 2 * self._reduction
            near = Window(top, left, top + side, left + side).clip(window)
            found = find_peaks(self._exact(query, near), near, exclusion) if near.positions else None
            peaks += found.peaks if found is not None else ()
        return Match(keep_apart(peaks, exclusion), cells.mean, cells.std) if peaks else None

    def _exact(self, query: Query, window: Window) -> Values:
        """Exact scores of a window, minus infinity where too few pixels are common."""
        rows, cols = window.shape
        height, width = query.layers.value.shape
        size = rows + height - 1, cols + width - 1
        piece = Layers.of(
            cut(self._image, window.top, window.left, size),
            cut(self._valid, window.top, window.left, size),
            np.float64,
        )
        # OpenCV transforms no matrix of a single column with padding below.
        shape = cv2.getOptimalDFTSize(size[0]), cv2.getOptimalDFTSize(max(size[1], 2))
        whole = bool(piece.inside.all())
        sums = slide(Spectra.of(piece, shape, whole=whole), query.spectra(shape), query.score, window.shape)
        if self._image.dtype != np.float32:
            sums = Sums(*(np.rint(part) for part in (sums.count, sums.f, sums.ff, sums.w, sums.ww, sums.fw)))
        return query.evaluate(sums, slack=0.5)

    def _coarse(self, query: Query, window: Window) -> Cells:
        """The most promising squares of a window, in pixels of the shrunk map."""
        by = self._reduction
        small = query.shrink(by)
        side = tile_side(max(small.layers.value.shape))
        with self._making:
            if side not in self._tiles:
                self._tiles[side] = Tiles(self._shrunk(), side)
        spectra = small.spectra((side, side))
        within = Window(window.top // by, window.left // by, -(-window.bottom // by), -(-window.right // by))
        slack = float(sum(small.layers.value.shape))
        cells = Cells(CELLS, CELL // by)
        for area, tile in self._tiles[side].within(within):
            scores = small.evaluate(slide(tile, spectra, query.score, area.shape), slack)
            part = area.clip(within)
            rows = slice(part.top - area.top, part.bottom - area.top)
            cols = slice(part.left - area.left, part.right - area.left)
            cells.add(scores[rows, cols], part.top, part.left)
        return cells

    def _shrunk(self) -> Layers:
        """The map shrunk, strip by strip: layers of the full map would take 4 or 8 bytes per pixel each."""
        strip = 256 * self._reduction
        strips = [
            Layers.of(self._image[top : top + strip], self._valid[top : top + strip], np.float32).shrink(
                self._reduction
            )
            for top in range(0, self._image.shape[0], strip)
        ]
        return Layers.stack(strips)


def _checked(picture: Picture, inside: NDArray[np.bool_] | None) -> tuple[Picture, NDArray[np.bool_]]:
    """The picture and which of its pixels count.

    Raises:
        InputError: a type or shape that cannot be matched.
    """
    if picture.dtype not in (np.bool_, np.uint8, np.float32) or picture.ndim != 2 or picture.size == 0:
        raise InputError(
            "this is not a picture to match",
            value=f"{picture.dtype} of shape {picture.shape}",
            hint="use bool, uint8 or float32 of shape [height, width]",
        )
    if inside is None:
        return picture, np.ones(picture.shape, dtype=np.bool_)
    if inside.dtype != np.bool_ or inside.shape != picture.shape:
        raise InputError(
            "a mask does not fit its picture",
            value=f"{inside.dtype} {inside.shape}, {picture.shape}",
            hint="use bool of the picture's shape",
        )
    return picture, inside
