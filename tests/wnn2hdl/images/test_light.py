"""Pictures under other light and air, and by other cameras."""

import numpy as np

from wnn2hdl.images import balanced, curved, exposed, hazed


def test_levels_are_multiplied_rounded_and_stop_where_a_camera_saturates() -> None:
    pixels = np.array([[0, 1, 2], [100, 170, 171]], dtype=np.uint8)
    assert exposed(pixels, 1.5).tolist() == [[0, 2, 3], [150, 255, 255]]
    assert exposed(pixels, 0.25).tolist() == [[0, 0, 1], [25, 43, 43]]
    assert exposed(pixels, 1.0).tolist() == pixels.tolist()


def test_haze_blends_white_air_into_the_ground() -> None:
    pixels = np.array([0, 100, 255], dtype=np.uint8)
    assert hazed(pixels, 0.0).tolist() == [0, 100, 255]
    assert hazed(pixels, 0.1).tolist() == [26, 116, 255]
    assert hazed(pixels, 1.0).tolist() == [255, 255, 255]


def test_a_warmer_white_balance_raises_red_and_lowers_blue() -> None:
    pixels = np.array([[[100, 100, 100], [200, 7, 3]]], dtype=np.uint8)
    assert balanced(pixels, 1.25).tolist() == [[[125, 100, 80], [250, 7, 2]]]
    assert balanced(pixels, 2.0).tolist() == [[[200, 100, 50], [255, 7, 2]]]
    assert balanced(pixels, 1.0).tolist() == pixels.tolist()


def test_gamma_bends_levels_between_black_and_white() -> None:
    pixels = np.array([0, 51, 128, 255], dtype=np.uint8)
    assert curved(pixels, 2.0).tolist() == [0, 10, 64, 255]
    assert curved(pixels, 0.5).tolist() == [0, 114, 181, 255]
    assert curved(pixels, 1.0).tolist() == pixels.tolist()
