"""A map's spectra, tile by tile, made once and used by all searches: overlap-save.

A tile of N x N pixels gives the sums at its first ``STEP * N`` rows and columns of positions, for all
templates of at most ``(1 - STEP) * N + 1`` pixels in height and width.
"""

from collections.abc import Iterator

from wnn2hdl.apps.navigation.matching.peaks import Window
from wnn2hdl.apps.navigation.matching.spectra import Layers, Spectra

SMALLEST = 512
"""Pixels of a tile's side: its spectra and the sums made of them stay within a core's cache of 2 MB."""

STEP = 0.75


def tile_side(template: int) -> int:
    """Side of the tiles for templates whose longer side has this many pixels."""
    side = SMALLEST
    while template > side - round(STEP * side) + 1:
        side *= 2
    return side


class Tiles:
    """Spectra of a map cut into tiles, for positions from where a template only just touches the map.

    Args:
        layers: the map.
        side: pixels of a tile's side.
    """

    def __init__(self, layers: Layers, side: int) -> None:
        self.side = side
        self.step = round(STEP * side)
        self.margin = side - self.step
        height, width = layers.value.shape
        self._spectra: dict[tuple[int, int], Spectra] = {}
        for top in range(-self.margin, height, self.step):
            for left in range(-self.margin, width, self.step):
                piece = layers.cut(top, left, (side, side))
                if piece.inside.any():
                    whole = bool((piece.inside == 1).all())
                    self._spectra[top, left] = Spectra.of(piece, (side, side), whole=whole)

    def within(self, window: Window) -> Iterator[tuple[Window, Spectra]]:
        """The tiles that have positions in a window: all their positions, and their spectra."""
        for (top, left), spectra in self._spectra.items():
            area = Window(top, left, top + self.step, left + self.step)
            if area.clip(window).positions:
                yield area, spectra

    @property
    def nbytes(self) -> int:
        """Memory held."""
        return sum(spectra.nbytes for spectra in self._spectra.values())
