"""The search over poses finds the turn and the scale that a frame was taken with."""

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.navigate.matching import MapIndex, Window, search_poses

SIDE = 120


def blobs() -> NDArray[np.uint8]:
    noise = np.random.default_rng(4).normal(size=(400, 400))
    smooth = cv2.GaussianBlur(noise, (0, 0), 3)
    return np.asarray(np.clip(128 + 400 * smooth, 0, 255), dtype=np.uint8)


def turned(picture: NDArray[np.uint8], yaw: float, scale: float) -> NDArray[np.uint8]:
    """A square of the map around (200, 180), turned and scaled."""
    matrix = cv2.getRotationMatrix2D((180.0, 200.0), yaw, scale)
    whole = cv2.warpAffine(picture, matrix, (400, 400))
    return np.asarray(whole[200 - SIDE // 2 : 200 + SIDE // 2, 180 - SIDE // 2 : 180 + SIDE // 2], np.uint8)


def test_yaw_and_scale_are_found() -> None:
    picture = blobs()
    frame = turned(picture, 12, 1.1)

    def template(yaw: float, scale: float) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        matrix = cv2.getRotationMatrix2D((SIDE / 2, SIDE / 2), -yaw, 1 / scale)
        laid = cv2.warpAffine(frame, matrix, (SIDE, SIDE))
        inside = cv2.warpAffine(np.ones_like(frame), matrix, (SIDE, SIDE)) > 0
        return np.asarray(laid, np.uint8), np.asarray(inside)

    best = search_poses(MapIndex(picture), template, range(-18, 19, 6), (0.9, 1.0, 1.1))
    assert best is not None
    assert (best.yaw, best.scale) == (12, 1.1)
    assert max(abs(best.match.row - 140), abs(best.match.col - 120)) <= 1


def test_each_pose_has_its_own_window() -> None:
    picture = blobs()
    asked: list[tuple[float, float]] = []

    def window(yaw: float, scale: float) -> Window:
        asked.append((yaw, scale))
        return Window(0, 0, 5, 5) if yaw == 0 else Window(900, 900, 901, 901)

    mask = np.ones((30, 30), dtype=np.bool_)
    best = search_poses(
        MapIndex(picture), lambda yaw, scale: (picture[2:32, 3:33], mask), (1.0, 0.0), window=window
    )
    assert asked == [(1.0, 1.0), (0.0, 1.0)]
    assert best is not None
    assert (best.yaw, best.match.row, best.match.col) == (0.0, 2, 3)
    nowhere = Window(900, 900, 901, 901)
    assert (
        search_poses(MapIndex(picture), lambda *_: (picture[:9, :9], mask[:9, :9]), (0.0,), window=nowhere)
        is None
    )
