"""Calibration: what a synthetic camera was, found again from its frames."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.calibrate import Calibration, Fit, calibrate
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.geometry import camera_to_ground
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.errors import InputError

GUESS = Camera.of_focal(150, 200, 150)
HEIGHT_M = 100.0
LATITUDE, LONGITUDE = 24.0, 120.0
FIT = Fit(3, 2.5, 2.0, 0.7)


def country(side: int = 250, seed: int = 0) -> MapGrid:
    """A map of smooth blobs, two metres per pixel."""
    noise = np.random.default_rng(seed).normal(size=(side, side)).astype(np.float32)
    blobs = cv2.GaussianBlur(noise, (0, 0), 2)
    picture = np.clip(128 + 40 * blobs / blobs.std(), 1, 254).astype(np.uint8)
    half = (side - 1) / 2
    return MapGrid(
        np.repeat(picture[..., None], 3, axis=-1),
        np.ones((side, side), dtype=np.bool_),
        2.0,
        (-2 * half, 2 * half),
        LATITUDE,
        LONGITUDE,
    )


def photographed(grid: MapGrid, camera: Camera, pose: Pose) -> NDArray[np.uint8]:
    """What the camera sees of the map, ray by ray."""
    x, y = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    rays = camera.rays(x.astype(float), y.astype(float)) @ camera_to_ground(pose, camera).T
    row, column = (float(axis) for axis in grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
    rows, columns = (
        (at + sign * rays[..., axis] / rays[..., 2] * pose.height_m / grid.gsd_m).astype(np.float32)
        for at, sign, axis in ((row, -1, 0), (column, 1, 1))
    )
    return np.asarray(cv2.remap(grid.image[..., 0], columns, rows, cv2.INTER_CUBIC), dtype=np.uint8)


def flown(grid: MapGrid, frames: int = 7, seed: int = 1) -> list[Pose]:
    """Poses all over the map's middle, with wind."""
    rng = np.random.default_rng(seed)
    rows, columns = rng.uniform(90, 160, (2, frames))
    latitude, longitude = grid.to_geographic(rows, columns)
    return [
        Pose(f"f{i}.png", latitude[i], longitude[i], HEIGHT_M, rng.uniform(-180, 180), *rng.normal(0, 6, 2))
        for i in range(frames)
    ]


def fitted(
    grid: MapGrid, cameras: list[Camera], poses: list[Pose], logged: list[Pose] | None = None
) -> Calibration:
    frames = [photographed(grid, camera, pose) for camera, pose in zip(cameras, poses, strict=True)]
    return calibrate(grid, grid.image[..., 0], frames, logged or poses, GUESS, lambda *_: None)


def test_finds_a_strapped_camera_again() -> None:
    grid = country()
    poses = flown(grid)
    truth = Camera.of_focal(159, 200, 150, tilt_deg=8)
    truth = replace(truth, lean_deg=-3)
    found = fitted(grid, [truth] * len(poses), poses)
    camera = found.cameras[0]
    assert not camera.stabilised
    assert camera.fx == pytest.approx(159, rel=0.015)
    assert camera.tilt_deg == pytest.approx(8, abs=0.7)
    assert camera.lean_deg == pytest.approx(-3, abs=0.7)
    assert found.heading_search_deg == 0
    assert len(found.stretches) == 1
    assert found.report()["before"]["mean_miss_m"] > 10
    assert found.report()["after"]["mean_miss_m"] < 2


def test_finds_out_that_a_gimbal_keeps_the_camera_level() -> None:
    grid = country(seed=2)
    poses = flown(grid)
    truth = replace(GUESS, tilt_deg=5, stabilised=True)
    camera = fitted(grid, [truth] * len(poses), poses).cameras[0]
    assert camera.stabilised
    assert camera.tilt_deg == pytest.approx(5, abs=0.7)


def test_finds_where_the_tilt_was_set_anew() -> None:
    grid = country(seed=3)
    poses = flown(grid, frames=10)
    cameras = [replace(GUESS, tilt_deg=9 if i < 6 else 1) for i in range(10)]
    found = fitted(grid, cameras, poses)
    assert [frame for frame, _ in found.stretches] == ["f0.png", "f6.png"]
    assert [tilt for _, tilt in found.stretches] == pytest.approx([9, 1], abs=0.8)
    early, late = found.cameras[0], found.cameras[-1]
    assert found.cameras_at("f5.png") == (early,)
    assert found.cameras_at("f17.png") == (late,)


def test_a_log_of_bad_headings_asks_for_a_search() -> None:
    grid = country(seed=4)
    poses = flown(grid)
    errors = np.random.default_rng(5).choice([-24, -12, 0, 12, 24], len(poses))
    logged = [replace(pose, yaw_deg=pose.yaw_deg + error) for pose, error in zip(poses, errors, strict=True)]
    found = fitted(grid, [GUESS] * len(poses), poses, logged)
    assert found.heading_search_deg >= 18
    assert found.report()["after"]["median_miss_m"] < 3


def test_too_little_to_calibrate_on_is_refused() -> None:
    grid = country()
    poses = flown(grid, frames=2)
    with pytest.raises(InputError, match="at least 3 frames: 2"):
        fitted(grid, [GUESS] * 2, poses)
    away = [replace(pose, latitude_deg=LATITUDE + 1) for pose in flown(grid, frames=4)]
    with pytest.raises(InputError, match="too few calibration frames match the map: 0 of 4"):
        calibrate(
            grid,
            grid.image[..., 0],
            [np.zeros((150, 200), np.uint8)] * 4,
            away,
            GUESS,
            lambda *_: None,
        )


def test_a_frame_has_the_camera_of_its_stretch_or_of_either_beside_it() -> None:
    early, late = replace(GUESS, tilt_deg=9), replace(GUESS, tilt_deg=1)
    frames = ("IMG_008.jpg", "IMG_012.jpg", "IMG_100.jpg")
    found = Calibration(frames, (early, early, late), 0.0, FIT, FIT)
    assert found.cameras_at("IMG_001.jpg") == (early,)
    assert found.cameras_at("IMG_9.jpg") == (early,)
    assert found.cameras_at("IMG_012.jpg") == (early,)
    assert found.cameras_at("IMG_013.jpg") == (early, late)
    assert found.cameras_at("IMG_100.jpg") == (late,)
    assert found.cameras_at("IMG_101.jpg") == (late,)
    for name in ("DJI_013.jpg", "last.jpg"):
        assert found.cameras_at(name) == (early, late), "where it lies is not known"


def test_a_frame_of_the_calibration_has_its_own_camera_whatever_its_name() -> None:
    early, late = replace(GUESS, tilt_deg=9), replace(GUESS, tilt_deg=1)
    found = Calibration(("river.jpg", "town.jpg"), (early, late), 0.0, FIT, FIT)
    assert found.cameras_at("river.jpg") == (early,)
    assert found.cameras_at("town.jpg") == (late,)
