"""What a camera under a UAV sees of flat ground, one ray for each pixel.

Nothing here uses homographies: code that uses them is tested against these pictures, which must not come
from the same formula.

Axes: north, east, down; of the body forward, right, down; of the camera right, image-down, and the
direction of view. The body's yaw turns clockwise as seen from above, from north; then pitch lifts the nose;
then roll lowers the right side. The camera looks down, image-up is forward, and its tilt swings the
direction of view forward, as pitch does.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from wnn2hdl.errors import InputError

LOWEST_SINE = 0.1
"""Rays must point below the horizon by at least this sine, about 6 degrees."""

_EXACT_PX = 1e-6
_MOST_ITERATIONS = 200
_LEAST_RADIAL = 0.2
"""The inverse of a distortion is found to this part of a pixel in this many steps, or does not exist: where
the radial factor comes near zero, two pixels share a ray."""


@dataclass(frozen=True)
class SampleCamera:
    """A pinhole camera with its principal point in the middle of the frame.

    The centre of the top left pixel is (0, 0), so the middle is ``((width - 1) / 2, (height - 1) / 2)``.

    Attributes:
        focal_px: focal length in pixels.
        width: of a frame, pixels.
        height: of a frame, pixels.
        tilt_deg: from straight down towards image-up.
        distortion: ``k1, k2, p1, p2[, k3]`` of OpenCV's model; empty for none.
    """

    focal_px: float
    width: int
    height: int
    tilt_deg: float = 0.0
    distortion: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if min(self.width, self.height) < 1 or not (math.isfinite(self.focal_px) and self.focal_px > 0):
            raise InputError(
                "no camera has this size or focal length",
                value=f"{self.width}x{self.height}, {self.focal_px}",
                hint="use sides of at least 1 pixel and a focal length above 0",
            )
        if not abs(self.tilt_deg) <= 80:
            raise InputError("the camera does not look down", value=f"tilt {self.tilt_deg:g} degrees")
        if len(self.distortion) not in (0, 4, 5) or not all(map(math.isfinite, self.distortion)):
            raise InputError(
                "not the coefficients of a lens", value=self.distortion, hint="give k1, k2, p1, p2 and k3"
            )

    def rays(self) -> NDArray[np.float64]:
        """Directions of all pixels in the camera's axes, float64 ``[height, width, 3]``; the last is 1.

        Raises:
            InputError: the distortion has no inverse within the frame.
        """
        x, y = np.meshgrid(np.arange(self.width, dtype=np.float64), np.arange(self.height, dtype=np.float64))
        x, y = (x - (self.width - 1) / 2) / self.focal_px, (y - (self.height - 1) / 2) / self.focal_px
        if self.distortion:
            x, y = self._undistorted(x, y)
        return np.stack([x, y, np.ones_like(x)], axis=-1)

    def _undistorted(
        self, seen_x: NDArray[np.float64], seen_y: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where pixels would lie without distortion, which has no inverse in closed form, by iteration."""
        k1, k2, p1, p2, k3 = (*self.distortion, 0.0)[:5]
        x, y = seen_x, seen_y
        for _ in range(_MOST_ITERATIONS):
            r2 = x * x + y * y
            radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
            if radial.min() < _LEAST_RADIAL:
                break
            next_x = (seen_x - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial
            next_y = (seen_y - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial
            step = max(np.abs(next_x - x).max(), np.abs(next_y - y).max())
            x, y = next_x, next_y
            if step * self.focal_px < _EXACT_PX:
                return x, y
        raise InputError(
            "the lens's distortion has no inverse within the frame",
            value=self.distortion,
            hint="use smaller coefficients or a longer focal length",
        )


@dataclass(frozen=True)
class SamplePose:
    """Where the UAV is and how it is turned when it takes a frame.

    Attributes:
        frame: name of the frame's file.
        latitude_deg: WGS 84, north positive.
        longitude_deg: WGS 84, east positive; NaN if not known.
        height_m: of the camera above the ground, metres.
        yaw_deg: heading, clockwise from true north.
        pitch_deg: nose up positive.
        roll_deg: right side down positive.
    """

    frame: str
    latitude_deg: float
    longitude_deg: float
    height_m: float
    yaw_deg: float
    pitch_deg: float
    roll_deg: float


def ground_points(camera: SampleCamera, pose: SamplePose) -> NDArray[np.float64]:
    """Where the rays of all pixels meet the ground.

    Returns:
        float64 ``[height, width, 2]``: metres north and east of the point below the camera.

    Raises:
        InputError: a pixel looks at the horizon or above it.
    """
    rays = camera.rays()
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    down = rays @ _attitude(camera, pose).T
    if down[..., 2].min() < LOWEST_SINE:
        raise InputError(
            "the camera sees the horizon",
            value=f"tilt {camera.tilt_deg:g}, pitch {pose.pitch_deg:.1f}, roll {pose.roll_deg:.1f} degrees",
            hint="use less tilt, calmer air, or a longer focal length",
        )
    return np.asarray(down[..., :2] * (pose.height_m / down[..., 2:]))


def _attitude(camera: SampleCamera, pose: SamplePose) -> NDArray[np.float64]:
    """From the camera's axes to north, east and down, float64 ``[3, 3]``."""
    yaw, pitch, roll, tilt = np.radians([pose.yaw_deg, pose.pitch_deg, pose.roll_deg, camera.tilt_deg])
    mount = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    return np.asarray(_about(2, yaw) @ _about(1, pitch) @ _about(0, roll) @ _about(1, tilt) @ mount)


def _about(axis: int, angle: float) -> NDArray[np.float64]:
    """Turns vectors about one axis by the right-hand rule, float64 ``[3, 3]``."""
    turn = np.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    turn[[first, second], [first, second]] = np.cos(angle)
    turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
    return turn


def look_up(
    picture: NDArray[np.uint8], rows: NDArray[np.float64], columns: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Bilinear interpolation.

    Args:
        picture: uint8 ``[height, width, 3]``.
        rows: places ``S``, 0 at the first pixel's centre; past the border its pixels are repeated.
        columns: the same for columns.

    Returns:
        float64 ``S + (3,)``. Exact, unlike OpenCV's remap, which rounds places to 1/32 pixel.
    """
    channels = (
        map_coordinates(picture[..., channel], [rows, columns], np.float64, order=1, mode="nearest")
        for channel in range(3)
    )
    return np.stack(list(channels), axis=-1)
