"""Light as it varies between training pixels."""

import numpy as np

from wnn2hdl.training.light import LEAST, MOST, varied

GREY = np.full((4000, 3), 100, dtype=np.uint8)


def test_pixels_get_darker_and_brighter_and_keep_nearly_their_ratios() -> None:
    lit = varied(GREY, np.random.default_rng(0)).astype(np.float64)
    assert lit.min() < 100 * LEAST + 10
    assert lit.max() > 100 * MOST - 10
    ratios = lit[:, 0] / lit[:, 2]
    assert 0.02 < ratios.std() < 0.08


def test_what_is_too_bright_saturates() -> None:
    lit = varied(GREY + 120, np.random.default_rng(0))
    assert (lit == 255).mean() > 0.1
    assert lit.min() > 100
