"""Pictures under more or less light, and through haze."""

import numpy as np

from wnn2hdl.images import exposed, hazed


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
