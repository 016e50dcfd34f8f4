"""The bit-packed reference counts what a plain loop counts."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.matching import Window
from wnn2hdl.apps.navigation.matching.brute import brute_scores


@pytest.mark.parametrize("width", [7, 64, 100])
def test_counts_are_those_of_a_plain_loop(width: int) -> None:
    rng = np.random.default_rng(width)
    image, valid = rng.random((2, 30, 160)) < 0.5
    template, mask = rng.random((2, 9, width)) < 0.6
    window = Window(-3, -20, 12, 90)
    agreeing, common = brute_scores(image, valid, template, mask, "match_count", window)
    products, _ = brute_scores(image, valid, template, mask, "correlation", window)
    for row, col in [(0, 0), (-3, -1), (5, 63), (11, 89), (7, 64)]:
        pixels = [
            (image[row + y, col + x], template[y, x])
            for y in range(9)
            for x in range(width)
            if mask[y, x] and 0 <= row + y < 30 and 0 <= col + x < 160 and valid[row + y, col + x]
        ]
        place = row + 3, col + 20
        assert common[place] == len(pixels)
        assert agreeing[place] == sum(f == w for f, w in pixels) / len(pixels)
        assert products[place] == sum(f and w for f, w in pixels)
