"""Tiles hold every position once."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.matching.peaks import Window
from wnn2hdl.apps.navigation.matching.spectra import Layers
from wnn2hdl.apps.navigation.matching.tiles import SMALLEST, Tiles, tile_side


@pytest.mark.parametrize(("template", "side"), [(1, 512), (129, 512), (130, 1024), (257, 1024), (258, 2048)])
def test_a_tile_is_wide_enough_for_its_templates(template: int, side: int) -> None:
    assert tile_side(template) == side
    assert side % SMALLEST == 0


def test_every_position_of_a_window_is_in_one_tile() -> None:
    whole = np.ones((60, 90), dtype=np.bool_)
    tiles = Tiles(Layers.of(whole, whole, np.float32), 32)
    window = Window(-7, -7, 60, 90)
    seen = np.zeros((67, 97), dtype=np.int64)
    for area, _ in tiles.within(window):
        part = area.clip(window)
        seen[part.top + 7 : part.bottom + 7, part.left + 7 : part.right + 7] += 1
    assert (seen == 1).all()


def test_tiles_without_a_valid_pixel_are_left_out() -> None:
    inside = np.zeros((60, 90), dtype=np.bool_)
    inside[:10, :10] = True
    full, few = (Tiles(Layers.of(inside | more, inside | more, np.float32), 32) for more in (True, False))
    assert 0 < few.nbytes < full.nbytes
