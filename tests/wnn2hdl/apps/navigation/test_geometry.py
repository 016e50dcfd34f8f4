"""Frames on the ground: against rays cast at a known plane by another library's rotations."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.geometry import Patch, ground_patch, rotated_patch
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.errors import InputError

CAMERA = Camera.of_focal(400, 480, 360)
LENS = replace(CAMERA, distortion=(-0.12, 0.03, 0.001, -0.002, 0.0))
SPACING_M = 12.0
RADIUS_M = 1.2
"""Bright round marks on dark ground, one every 12 m north and east of the point below the UAV."""


def pose(yaw: float = 0, pitch: float = 0, roll: float = 0, height: float = 80) -> Pose:
    return Pose("frame", 10.0, 20.0, height, yaw, pitch, roll)


def ground_points(camera: Camera, at: Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Metres north and east that each pixel of an undistorted frame sees, by intrinsic Euler angles."""
    x, y = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    ahead, right = -(y - camera.cy) / camera.fy, (x - camera.cx) / camera.fx
    body = np.stack([ahead, right, np.ones_like(ahead)], axis=-1)
    mount = Rotation.from_euler("ZYX", [camera.twist_deg, camera.tilt_deg, camera.lean_deg], degrees=True)
    attitude = Rotation.from_euler("ZYX", [at.yaw_deg, at.pitch_deg, at.roll_deg], degrees=True)
    rays = (attitude * mount).apply(body.reshape(-1, 3)).reshape(body.shape)
    return tuple(rays[..., axis] / rays[..., 2] * at.height_m for axis in (0, 1))  # type: ignore[return-value]


def rendered(camera: Camera, at: Pose) -> NDArray[np.uint8]:
    """A frame of the marks."""
    north, east = ground_points(camera, at)
    distance = np.hypot(*(axis - np.round(axis / SPACING_M) * SPACING_M for axis in (north, east)))
    return np.asarray(np.clip(255 * np.exp(-((distance / RADIUS_M) ** 2)), 0, 255), dtype=np.uint8)


def largest_miss_px(patch: Patch) -> float:
    """How far, at most, a mark's centroid in the patch is from where it lies on the ground."""
    step = SPACING_M / patch.gsd_m
    reach = round(2.5 * RADIUS_M / patch.gsd_m)
    misses = []
    for north in range(-30, 31):
        for east in range(-30, 31):
            row, column = patch.nadir_row - north * step, patch.nadir_col + east * step
            top, left = round(row) - reach, round(column) - reach
            part = np.s_[top : top + 2 * reach + 1, left : left + 2 * reach + 1]
            if top < 0 or left < 0 or patch.valid[part].shape != (2 * reach + 1, 2 * reach + 1):
                continue
            if not patch.valid[part].all():
                continue
            weight = patch.image[part] + 1e-3
            rows, columns = np.mgrid[part]
            found = [(axis * weight).sum() / weight.sum() for axis in (rows, columns)]
            misses.append(np.hypot(found[0] - row, found[1] - column))
    assert len(misses) >= 10
    return float(max(misses))


ATTITUDES = [
    pose(),
    pose(yaw=90),
    pose(yaw=-33, pitch=8),
    pose(yaw=152, roll=-11),
    pose(yaw=247, pitch=-9, roll=14),
    pose(yaw=20, pitch=12, roll=-7, height=60),
]


@pytest.mark.parametrize("at", ATTITUDES, ids=lambda at: f"{at.yaw_deg:g},{at.pitch_deg:g},{at.roll_deg:g}")
@pytest.mark.parametrize(
    "camera", [CAMERA, replace(CAMERA, tilt_deg=12), replace(CAMERA, tilt_deg=5, lean_deg=-4, twist_deg=7)]
)
def test_marks_of_a_known_plane_lie_within_a_tenth_of_a_pixel(at: Pose, camera: Camera) -> None:
    assert largest_miss_px(ground_patch(rendered(camera, at), at, camera, 0.3)) < 0.1


def test_coarser_than_the_frame_still_a_tenth_of_a_pixel() -> None:
    at = ATTITUDES[4]
    assert largest_miss_px(ground_patch(rendered(CAMERA, at), at, CAMERA, 0.6)) < 0.1


def test_yaw_alone_suffices_only_for_a_level_camera() -> None:
    for at in ATTITUDES[:2]:
        assert largest_miss_px(rotated_patch(rendered(CAMERA, at), at, CAMERA, 0.3)) < 0.1
    tilted = ATTITUDES[2]
    assert largest_miss_px(rotated_patch(rendered(CAMERA, tilted), tilted, CAMERA, 0.3)) > 1


@pytest.mark.parametrize(
    ("at", "camera", "north", "east"),
    [
        (pose(yaw=0, pitch=10), CAMERA, 1, 0),
        (pose(yaw=90, pitch=10), CAMERA, 0, 1),
        (pose(yaw=0, roll=10), CAMERA, 0, -1),
        (pose(yaw=90, roll=10), CAMERA, 1, 0),
        (pose(yaw=0), replace(CAMERA, tilt_deg=10), 1, 0),
        (pose(yaw=0), replace(CAMERA, lean_deg=10), 0, -1),
    ],
    ids=["nose up", "nose up, east", "right down", "right down, east", "tilt", "lean"],
)
def test_signs(at: Pose, camera: Camera, north: int, east: int) -> None:
    """A nose that rises turns the camera's view forward; a right side that sinks turns it to the left."""
    patch = ground_patch(np.full((360, 480), 255, dtype=np.uint8), at, camera, 0.5)
    middle = (patch.valid.shape[0] - 1) / 2, (patch.valid.shape[1] - 1) / 2
    ahead = (patch.nadir_row - middle[0]) * patch.gsd_m, (middle[1] - patch.nadir_col) * patch.gsd_m
    shift = 80 * np.tan(np.radians(10))
    # The footprint stretches away from the UAV, so its middle is some metres further than the axis.
    assert ahead == pytest.approx((north * shift, east * shift), abs=6)


def test_image_up_is_forward_and_image_right_is_right() -> None:
    frame = np.zeros((360, 480, 3), dtype=np.uint8)
    frame[:60, :, 0] = 255
    frame[:, -60:, 1] = 255
    patch = ground_patch(frame, pose(yaw=90), CAMERA, 0.5)
    rows, columns = patch.valid.shape
    assert patch.image[rows // 2, columns - 5, 0] > 250  # heading east: what is ahead lies east
    assert patch.image[rows - 5, columns // 2, 1] > 250  # and what is to the right lies south


def test_a_gimbal_keeps_pitch_and_roll_from_the_camera() -> None:
    steady, level = replace(CAMERA, tilt_deg=6, stabilised=True), replace(CAMERA, tilt_deg=6)
    frame = rendered(level, pose(yaw=40))
    through_gimbal = ground_patch(frame, pose(yaw=40, pitch=9, roll=-13), steady, 0.3)
    assert (through_gimbal.image == ground_patch(frame, pose(yaw=40), level, 0.3).image).all()


def test_a_distorted_lens_is_undone() -> None:
    at = ATTITUDES[3]
    straight = rendered(CAMERA, at).astype(np.float32)
    # Where a pixel of the distorted frame looks, by the lens's own inverse; sampled from a straight frame.
    import cv2

    x, y = np.meshgrid(np.arange(480.0), np.arange(360.0))
    rays = LENS.rays(x, y)
    maps = (
        (rays[..., 0] * 400 + LENS.cx).astype(np.float32),
        (rays[..., 1] * 400 + LENS.cy).astype(np.float32),
    )
    bent = np.asarray(cv2.remap(straight, *maps, cv2.INTER_CUBIC).clip(0, 255), dtype=np.uint8)
    assert largest_miss_px(ground_patch(bent, at, CAMERA, 0.3)) > 1
    assert largest_miss_px(ground_patch(bent, at, LENS, 0.3)) < 0.1


def test_nothing_finer_than_the_grid_aliases() -> None:
    """Stripes of one and the same mean as grey, far below the grid's resolution, become grey."""
    frame = np.zeros((360, 480), dtype=np.uint8)
    frame[:, ::2] = 254
    patch = ground_patch(frame, pose(yaw=30, pitch=5), CAMERA, 1.7)
    assert abs(patch.image[patch.valid].astype(int) - 127).max() <= 8


def test_a_smaller_frame_gives_the_same_patch() -> None:
    at = ATTITUDES[1]
    small = Camera.of_focal(200, 240, 180)
    full, half = (ground_patch(rendered(camera, at), at, CAMERA, 0.5) for camera in (CAMERA, small))
    assert full.nadir_row == pytest.approx(half.nadir_row, abs=1)
    assert largest_miss_px(half) < 0.1


def test_the_horizon_is_cut_off_and_the_sky_refused() -> None:
    frame = np.full((360, 480), 255, dtype=np.uint8)
    patch = ground_patch(frame, pose(pitch=60), CAMERA, 2.0)
    assert patch.valid.any()
    assert patch.nadir_row * patch.gsd_m <= 80 * np.tan(np.radians(75)) + 2
    with pytest.raises(InputError, match="shows no ground"):
        ground_patch(frame, pose(roll=150), CAMERA, 2.0)


def test_a_frame_of_too_little_ground_is_refused() -> None:
    frame = np.full((360, 480), 255, dtype=np.uint8)
    with pytest.raises(
        InputError, match="shows less than 3x3 pixels of ground to find edges in: 2x2 of 60 m"
    ):
        ground_patch(frame, pose(), CAMERA, 60.0)


def test_a_frame_of_too_much_ground_is_refused() -> None:
    frame = np.full((360, 480), 255, dtype=np.uint8)
    with pytest.raises(InputError, match="frame f shows more than 8 million pixels of ground"):
        ground_patch(frame, replace(pose(), frame="f", height_m=9_000), CAMERA, 0.5)
