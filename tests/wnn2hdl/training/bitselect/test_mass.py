import numpy as np
from numpy.typing import NDArray

from wnn2hdl.training.bitselect.drift import Colours
from wnn2hdl.training.bitselect.mass import CUBE_SHARE, POOL, WHOLE, signed_mass

DARK = (0, 0, 0)
RED = (128, 0, 0)


def red_is_surely_the_second(rgb: NDArray[np.int64]) -> NDArray[np.float64]:
    return (rgb[:, 0] >= 128).astype(np.float64)


def test_mass_is_the_share_of_the_pixels_signed_by_the_reference() -> None:
    colours = Colours(np.array([DARK, RED]), np.array([[3.0, 0], [0, 1]]))
    mass = signed_mass(colours, red_is_surely_the_second)
    dark, red = POOL.codes(np.array([DARK, RED]))
    np.testing.assert_allclose(mass[dark], -0.75 * WHOLE, rtol=1e-3)
    np.testing.assert_allclose(mass[red], 0.25 * WHOLE, rtol=1e-3)


def test_codes_never_seen_get_the_references_answer() -> None:
    colours = Colours(np.array([DARK]), np.array([[1.0], [0]]))
    mass = signed_mass(colours, red_is_surely_the_second)
    unseen = POOL.codes(np.array([[200, 200, 200], [100, 200, 200]]))
    assert (np.sign(mass[unseen]) == [1, -1]).all()


def test_mass_sums_stay_exact_in_floating_point() -> None:
    colours = Colours(np.array([DARK]), np.array([[1.0], [0]]))
    total = np.abs(signed_mass(colours, red_is_surely_the_second)).sum()
    assert total <= WHOLE * (1 + CUBE_SHARE) + (1 << POOL.width) < 2**53
