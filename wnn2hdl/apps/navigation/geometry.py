"""From a frame to the ground it shows: the plane homography of the reference, and its simpler rival.

    H = A' (R - t n^T / d) A^-1

takes pixels of the frame to pixels of a second, imagined camera: A and A' are the calibration matrices, R
the rotation from the first camera's axes to the second's, t the second camera's place in its own axes as seen
from the first, n the ground's normal in the first camera's axes and d the distance to the ground. Here the
second camera hangs at the same height, looks straight down with north up, and has the focal length that makes
its pixels one ground sample distance wide, so that its picture is a piece of a north-up map.

Axes and signs, everywhere in this module:

- ground: north, east, down;
- body: forward, right, down; yaw positive from north to east, pitch nose up, roll right side down:
  ``body to ground = Rz(yaw) Ry(pitch) Rx(roll)``, the reference's equation 4;
- camera: right in the image, down in the image, along the optical axis. With no mount angles image-up is
  forward and the axis is down: ``camera to body: (x, y, z) -> (-y, x, z)``. The mount's twist, tilt and lean
  turn as yaw, pitch and roll do, before them;
- map and patch: column east, row south; whole numbers are centres of pixels.
"""

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.errors import InputError
from wnn2hdl.ir.window import SIDE

MOST_PIXELS = 8 << 20
"""Of a patch: matching one takes some 2.5 GB."""

MAX_OBLIQUE_DEG = 75.0
"""Ground seen at a flatter angle from straight down is left out: a pixel there covers 15 times the ground."""

_CAMERA_TO_BODY = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=np.float64)
_GROUND_TO_PATCH = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], dtype=np.float64)


@dataclass(frozen=True)
class Patch:
    """A frame laid on the ground: a north-up picture with square pixels.

    Attributes:
        image: uint8 ``[rows, columns]`` or ``[rows, columns, 3]``; 0 where not valid.
        valid: bool ``[rows, columns]``: the frame shows this pixel.
        nadir_row: row of the ground point straight below the UAV; it may lie outside the patch.
        nadir_col: column of it.
        gsd_m: ground sample distance, metres per pixel.
    """

    image: NDArray[np.uint8]
    valid: NDArray[np.bool_]
    nadir_row: float
    nadir_col: float
    gsd_m: float


def camera_to_ground(pose: Pose, camera: Camera) -> NDArray[np.float64]:
    """Rotation from the camera's axes to north, east, down: float64 ``[3, 3]``, by the module's signs."""
    steady = camera.stabilised
    body = _rotation(pose.yaw_deg, 0 if steady else pose.pitch_deg, 0 if steady else pose.roll_deg)
    mount = _rotation(camera.twist_deg, camera.tilt_deg, camera.lean_deg)
    return np.asarray(body @ mount @ _CAMERA_TO_BODY)


def homography(
    camera: Camera,
    rotation: NDArray[np.float64],
    height_m: float,
    target: NDArray[np.float64],
    offset_m: tuple[float, float],
) -> NDArray[np.float64]:
    """H = A' (R - t n^T / d) A^-1, from pixels of the undistorted frame to pixels of the patch.

    Args:
        camera: A.
        rotation: R, from the camera's axes to east, south, down.
        height_m: d, the camera's height over the ground.
        target: A'.
        offset_m: metres east and south from the camera to the imagined one: t.

    Returns:
        float64 ``[3, 3]``, for points (x, y, 1).
    """
    shift = np.array([*offset_m, 0.0])
    normal = rotation.T @ (0.0, 0.0, 1.0)
    plane = rotation - np.outer(shift, normal) / height_m
    return np.asarray(target @ plane @ np.linalg.inv(camera.matrix))


def ground_patch(frame: NDArray[np.uint8], pose: Pose, camera: Camera, gsd_m: float) -> Patch:
    """Lay a frame on level ground, by all angles of the pose and the mount.

    Where a pixel of the patch covers several of the frame, they are averaged (the frame is first reduced by
    area to the patch's resolution at its middle), so that nothing finer than the map can hold aliases.

    Args:
        frame: uint8 ``[height, width]`` or ``[height, width, 3]``, of the camera's size or scaled from it.
        pose: where the camera was and how it was turned.
        camera: the camera.
        gsd_m: metres per pixel of the patch.

    Returns:
        A patch around all the frame shows, up to `MAX_OBLIQUE_DEG` from straight down.

    Raises:
        InputError: the frame shows no ground or too little, or has another shape than the camera's.
    """
    camera = camera.scaled(frame.shape[1], frame.shape[0])
    rotation = np.asarray(_GROUND_TO_PATCH @ camera_to_ground(pose, camera))
    return _laid(frame, camera, rotation, pose, gsd_m, _footprint(camera, rotation, pose))


def rotated_patch(frame: NDArray[np.uint8], pose: Pose, camera: Camera, gsd_m: float) -> Patch:
    """The simpler rival: turn a frame by its yaw and scale it, as if the camera looked straight down.

    Pitch, roll and the mount's tilt and lean are left out, so the middle of the frame counts as the point
    below the UAV. Arguments, result and errors as `ground_patch`.
    """
    level = replace(pose, pitch_deg=0.0, roll_deg=0.0)
    return ground_patch(frame, level, replace(camera, tilt_deg=0.0, lean_deg=0.0), gsd_m)


def _laid(
    frame: NDArray[np.uint8],
    camera: Camera,
    rotation: NDArray[np.float64],
    pose: Pose,
    gsd_m: float,
    box: tuple[float, float, float, float],
) -> Patch:
    height_m = pose.height_m
    west, north, east, south = box
    columns, rows = (math.ceil(extent / gsd_m) for extent in (east - west, south - north))
    if min(columns, rows) < SIDE:
        raise InputError(
            f"the frame {pose.frame} shows less than {SIDE}x{SIDE} pixels of ground to find edges in",
            value=f"{columns}x{rows} of {gsd_m:g} m",
            hint="check the focal length, the heights and the map's ground sample distance",
        )
    if columns * rows > MOST_PIXELS:
        raise InputError(
            f"the frame {pose.frame} shows more than {MOST_PIXELS >> 20} million pixels of ground",
            value=f"{columns}x{rows} of {gsd_m:g} m",
            hint="check its height and the focal length, or give a coarser map",
        )
    middle = ((west + east) / 2, (north + south) / 2)
    focal = height_m / gsd_m
    target = np.array([[focal, 0, (columns - 1) / 2], [0, focal, (rows - 1) / 2], [0, 0, 1]])
    seen = np.full(frame.shape[:2], 255, dtype=np.uint8)
    if camera.distortion:
        lens = (camera.matrix, np.array(camera.distortion))
        frame, seen = (_bytes(cv2.undistort(picture, *lens)) for picture in (frame, seen))
    # Pixels of the frame to one of the patch, at the middle of the frame.
    ratio = max(camera.fx, camera.fy) * gsd_m * float(rotation[2, 2]) / height_m
    if ratio > 1:
        size = max(1, round(camera.width / ratio)), max(1, round(camera.height / ratio))
        frame, seen = (
            _bytes(cv2.resize(picture, size, interpolation=cv2.INTER_AREA)) for picture in (frame, seen)
        )
        camera = camera.resized(*size)
    matrix = homography(camera, rotation, height_m, target, middle)
    image, valid = (
        _bytes(cv2.warpPerspective(picture, matrix, (columns, rows))) for picture in (frame, seen)
    )
    shown = (valid == 255) & _in_front(matrix, rows, columns)
    image[~shown] = 0
    return Patch(
        image,
        shown,
        (rows - 1) / 2 - middle[1] / gsd_m,
        (columns - 1) / 2 - middle[0] / gsd_m,
        gsd_m,
    )


def _bytes(picture: cv2.typing.MatLike) -> NDArray[np.uint8]:
    return np.asarray(picture, dtype=np.uint8)


def _in_front(matrix: NDArray[np.float64], rows: int, columns: int) -> NDArray[np.bool_]:
    """Which ground is before the camera: a homography also shows, mirrored, what is behind it."""
    back = np.linalg.inv(matrix)
    depth = back[2, 0] * np.arange(columns) + back[2, 1] * np.arange(rows)[:, None] + back[2, 2]
    return np.asarray(depth > 0)


def _footprint(
    camera: Camera, rotation: NDArray[np.float64], pose: Pose
) -> tuple[float, float, float, float]:
    """West, north, east and south end of what the frame shows, metres east and south of the UAV."""
    across = np.linspace(0, camera.width - 1, 17)
    down = np.linspace(0, camera.height - 1, 17)
    edges = (
        (across, np.zeros(17)),
        (across, np.full(17, camera.height - 1.0)),
        (np.zeros(17), down),
        (np.full(17, camera.width - 1.0), down),
    )
    columns, rows = (np.concatenate(axis) for axis in zip(*edges, strict=True))
    rays = camera.rays(columns, rows) @ rotation.T
    flat = np.hypot(rays[:, 0], rays[:, 1])
    steepest = math.tan(math.radians(MAX_OBLIQUE_DEG))
    slope = np.full(flat.shape, steepest)
    np.divide(flat, rays[:, 2], out=slope, where=rays[:, 2] > 0)
    if (slope >= steepest).all():
        raise InputError(
            f"the frame {pose.frame} shows no ground",
            value=f"pitch {pose.pitch_deg:g}, roll {pose.roll_deg:g}",
            hint="check the angles of its pose and the camera's tilt",
        )
    reach = np.minimum(slope, steepest) * pose.height_m / np.maximum(flat, 1e-12)
    east, south = rays[:, 0] * reach, rays[:, 1] * reach
    return float(east.min()), float(south.min()), float(east.max()), float(south.max())


def _rotation(yaw_deg: float, pitch_deg: float, roll_deg: float) -> NDArray[np.float64]:
    """``Rz(yaw) Ry(pitch) Rx(roll)`` of the reference's equation 4."""
    cos_y, cos_p, cos_r = (math.cos(math.radians(angle)) for angle in (yaw_deg, pitch_deg, roll_deg))
    sin_y, sin_p, sin_r = (math.sin(math.radians(angle)) for angle in (yaw_deg, pitch_deg, roll_deg))
    yaw = np.array([[cos_y, -sin_y, 0], [sin_y, cos_y, 0], [0, 0, 1]])
    pitch = np.array([[cos_p, 0, sin_p], [0, 1, 0], [-sin_p, 0, cos_p]])
    roll = np.array([[1, 0, 0], [0, cos_r, -sin_r], [0, sin_r, cos_r]])
    return np.asarray(yaw @ pitch @ roll)
