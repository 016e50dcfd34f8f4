"""The classifier of a pixel and its neighbours."""

import numpy as np
import pytest

from hdl_templates import discriminator
from hdl_templates.lookup import LutCell, LutNetwork
from hdl_templates.neighbourhood import Parameters
from wnn2hdl.verify.simulation import simulate

R7, B0 = 23, 0


def table(position: int, *, inverted: bool = False) -> discriminator.Parameters:
    """One bit of the pixel word, or its complement."""
    cell = LutCell("t0", ("a",), 0b01 if inverted else 0b10)
    return discriminator.Parameters((position,), LutNetwork(("a",), (cell,), (("y", "t0"),)))


BOTH = LutNetwork(("tap0", "tap1"), (LutCell("t0", ("tap0", "tap1"), 0b1000),), (("class_bit0", "t0"),))
CORNERS = Parameters(3, ((0, table(R7)), (8, table(B0, inverted=True))), BOTH)


def test_the_golden_model_asks_each_table_about_its_pixel() -> None:
    windows = np.zeros((4, 9), dtype=np.int64)
    windows[1:, 0] = 1 << R7
    windows[2, 8] = 1 << B0
    windows[3, 4] = (1 << 24) - 1
    assert CORNERS.compute(windows).tolist() == [0, 1, 0, 1]


def test_the_hardware_is_the_golden_model() -> None:
    windows = np.random.default_rng(0).integers(0, 1 << 24, (500, 9))
    answers = CORNERS.compute(windows)
    assert 0 < answers.sum() < 500
    assert simulate(CORNERS.create(), {"window": windows}, {"class_bits": answers}).vectors == 500


def test_taps_that_fit_neither_window_nor_lookup_are_refused() -> None:
    with pytest.raises(ValueError, match="2 inputs cannot read 1 taps"):
        Parameters(3, ((0, table(R7)),), BOTH)
    with pytest.raises(ValueError, match="pixels 0 to 8, not 9"):
        Parameters(3, ((0, table(R7)), (9, table(R7))), BOTH)
    two_bits = LutNetwork(("a",), (), (("x", "a"), ("y", "a")))
    with pytest.raises(ValueError, match="not 3"):
        Parameters(3, ((0, table(R7)), (1, discriminator.Parameters((0,), two_bits, 3))), BOTH)
