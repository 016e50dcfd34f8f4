"""Rays from pixels to the ground, against formulas of single angles and against OpenCV's projection."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.samples.raycast import SampleCamera, SamplePose, ground_points, look_up

HEIGHT = 100.0
FOCAL = 50.0


def pose(yaw: float = 0, pitch: float = 0, roll: float = 0, height: float = HEIGHT) -> SamplePose:
    return SamplePose("f.jpg", 0, 0, height, yaw, pitch, roll)


def camera(tilt: float = 0, distortion: tuple[float, ...] = ()) -> SampleCamera:
    return SampleCamera(FOCAL, 41, 31, tilt, distortion)


def test_level_flight_north_sees_north_above_and_east_to_the_right() -> None:
    ground = ground_points(camera(), pose())
    assert ground.shape == (31, 41, 2)
    assert ground[15, 20] == pytest.approx([0, 0])
    assert ground[0, 20] == pytest.approx([15 / FOCAL * HEIGHT, 0])
    assert ground[15, 40] == pytest.approx([0, 20 / FOCAL * HEIGHT])


def test_flying_east_sees_east_above_and_south_to_the_right() -> None:
    ground = ground_points(camera(), pose(yaw=90))
    assert ground[0, 20] == pytest.approx([0, 30])
    assert ground[15, 40] == pytest.approx([-40, 0], abs=1e-9)


@pytest.mark.parametrize(("tilt", "pitch"), [(12, 0), (0, 12), (7, 5), (20, -8)])
def test_tilt_and_a_lifted_nose_look_forward(tilt: float, pitch: float) -> None:
    ground = ground_points(camera(tilt), pose(pitch=pitch))
    for row in (0, 15, 30):
        angle = math.radians(tilt + pitch) + math.atan((15 - row) / FOCAL)
        assert ground[row, 20] == pytest.approx([HEIGHT * math.tan(angle), 0])


def test_a_lowered_right_side_looks_left() -> None:
    ground = ground_points(camera(), pose(roll=9))
    for column in (0, 20, 40):
        angle = math.atan((column - 20) / FOCAL) - math.radians(9)
        assert ground[15, column] == pytest.approx([0, HEIGHT * math.tan(angle)])


angles = st.floats(-12, 12)


@settings(deadline=None, max_examples=40)
@given(st.floats(0, 360), angles, angles, st.floats(-15, 15), st.floats(20, 500), st.booleans())
def test_opencv_projects_ground_points_back_to_their_pixels(
    yaw: float, pitch: float, roll: float, tilt: float, height: float, bent: bool
) -> None:
    lens = (-0.12, 0.03, 0.002, -0.001, 0.005) if bent else ()
    taken = camera(tilt, lens)
    ground = ground_points(taken, pose(yaw, pitch, roll, height))
    points = np.concatenate([ground, np.full((31, 41, 1), height)], axis=2).reshape(-1, 1, 3)

    def turn(axis: tuple[int, int, int], degrees: float) -> np.ndarray:
        return np.asarray(cv2.Rodrigues(np.array(axis) * math.radians(degrees))[0])

    attitude = turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)
    mount = turn((0, 1, 0), tilt) @ turn((0, 0, 1), 90)
    backward, _ = cv2.Rodrigues((attitude @ mount).T)
    matrix = np.array([[FOCAL, 0, 20], [0, FOCAL, 15], [0, 0, 1]])
    pixels, _ = cv2.projectPoints(points, backward, np.zeros(3), matrix, np.array(lens or (0.0,) * 5))
    y, x = np.mgrid[:31, :41]
    assert np.abs(pixels.reshape(31, 41, 2) - np.stack([x, y], axis=2)).max() < 1e-5


def test_looking_at_the_horizon_is_refused() -> None:
    with pytest.raises(InputError, match="the camera sees the horizon"):
        ground_points(camera(tilt=70), pose(pitch=10))


@pytest.mark.parametrize(
    ("focal", "width", "height"), [(0, 10, 10), (math.inf, 10, 10), (10, 0, 10), (10, 10, -1)]
)
def test_impossible_cameras_are_refused(focal: float, width: int, height: int) -> None:
    with pytest.raises(InputError, match="no camera has this size or focal length"):
        SampleCamera(focal, width, height)


@pytest.mark.parametrize("tilt", [90, -81, math.nan])
def test_cameras_that_do_not_look_down_are_refused(tilt: float) -> None:
    with pytest.raises(InputError, match="does not look down"):
        camera(tilt)


def test_lenses_that_cannot_be_undone_are_refused() -> None:
    with pytest.raises(InputError, match="not the coefficients of a lens"):
        SampleCamera(10, 10, 10, distortion=(0.1,))
    with pytest.raises(InputError, match="no inverse within the frame"):
        SampleCamera(10, 40, 40, distortion=(-0.9, 0, 0, 0)).rays()


def test_interpolation_is_exact_between_pixels_and_repeats_the_border() -> None:
    picture = np.zeros((2, 3, 3), dtype=np.uint8)
    picture[..., 0] = [[0, 100, 200], [10, 110, 210]]
    rows, columns = np.array([0.0, 0.123, 1.0, -5.0]), np.array([0.25, 1.456, 2.0, 9.0])
    found = look_up(picture, rows, columns)
    assert found.shape == (4, 3)
    assert found[:, 0] == pytest.approx([25, 145.6 + 1.23, 210, 200])
    assert not found[:, 1:].any()
