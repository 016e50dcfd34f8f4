"""The camera: what its pixels look at, before anything is known of the UAV's attitude."""

import math
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError

MAX_TILT_DEG = 80.0
"""Beyond it a camera looks at the horizon rather than at the ground."""

_SHAPE_TOLERANCE = 0.01
"""Relative: whole pixels change the ratio of the sides a little, as from 5472x3078 to 1000x562."""

WIDEST_FOCAL_SHARE = 0.2
"""Of the frame's longer side: a lens of 136 degrees, beyond what the pinhole model can straighten."""

LEAST_PRINCIPAL_SHARE = 0.2
"""Of the frame's width and height: a principal point this near to the first pixel is an offset or a share."""

KEYS = frozenset(
    {
        "focal",
        "fx",
        "fy",
        "cx",
        "cy",
        "width",
        "height",
        "distortion",
        "tilt_deg",
        "lean_deg",
        "twist_deg",
        "stabilised",
    }
)
"""Of the table in a camera's file."""

_FORM = "write [camera] with focal (or fx, fy, cx, cy), width and height, in pixels"


@dataclass(frozen=True)
class Camera:
    """A pinhole camera under a UAV, with the distortion of its lens and how it is mounted.

    Pixel (0, 0) is the centre of the top left one; x counts columns, y counts rows.

    The mount, when all its angles are 0, points straight down with image-up forward and image-right to the
    body's right. The others are small turns on top of that, in the order twist, tilt, lean, each about the
    body's turned axes, as yaw, pitch and roll are.

    Attributes:
        fx: focal length in pixels, along columns.
        fy: the same along rows.
        cx: column of the principal point.
        cy: row of the principal point.
        width: of a frame, pixels.
        height: of a frame, pixels.
        distortion: ``k1, k2, p1, p2, k3`` of Brown and Conrady in OpenCV's order; empty for none.
        tilt_deg: the optical axis leans from straight down towards image-up, which is forward.
        lean_deg: the optical axis leans from straight down towards image-left.
        twist_deg: the camera is turned clockwise, as seen from above, against the body's heading.
        stabilised: a gimbal takes the body's pitch and roll away, so that only its yaw reaches the camera.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int
    distortion: tuple[float, ...] = ()
    tilt_deg: float = 0.0
    lean_deg: float = 0.0
    twist_deg: float = 0.0
    stabilised: bool = False

    def __post_init__(self) -> None:
        for name in ("fx", "fy"):
            focal = getattr(self, name)
            if not (math.isfinite(focal) and focal > 0):
                raise InputError("the camera's focal length is not positive", value=f"{name} = {focal}")
        for name in ("width", "height"):
            if getattr(self, name) < 1:
                raise InputError("the camera's frame is empty", value=f"{name} = {getattr(self, name)}")
        if not (0 <= self.cx < self.width and 0 <= self.cy < self.height):
            raise InputError(
                "the principal point is outside the frame",
                value=f"({self.cx:g}, {self.cy:g}) of {self.width}x{self.height}",
                hint="count cx and cy from the first pixel: an offset from the middle would be "
                f"({(self.width - 1) / 2 + self.cx:g}, {(self.height - 1) / 2 + self.cy:g})",
            )
        if len(self.distortion) not in (0, 4, 5) or not all(map(math.isfinite, self.distortion)):
            raise InputError(
                "not the coefficients of a lens",
                value=list(self.distortion),
                hint="give k1, k2, p1, p2 and k3, or none",
            )
        for name in ("tilt_deg", "lean_deg"):
            if not abs(getattr(self, name)) <= MAX_TILT_DEG:
                raise InputError(
                    f"the camera's {name} is beyond {MAX_TILT_DEG:g} degrees",
                    value=getattr(self, name),
                    hint="count it from straight down, where a gimbal's pitch is -90",
                )
        if not abs(self.twist_deg) <= 360:
            raise InputError("the camera's twist_deg is beyond 360 degrees", value=self.twist_deg)

    def require_pixels(self) -> None:
        """Raise InputError if a length is probably not in pixels, or counted from elsewhere."""
        longer = max(self.width, self.height)
        focal = min(self.fx, self.fy)
        if focal < WIDEST_FOCAL_SHARE * longer:
            share = focal <= 2
            raise InputError(
                "the focal length is probably a share of the frame's longer side"
                if share
                else "the focal length is probably in millimetres",
                value=f"{focal:g} of a frame of {self.width}x{self.height} pixels",
                hint=f"give pixels: {focal * longer:g}"
                if share
                else f"give pixels: {focal:g} times {longer} over the sensor's longer side in millimetres",
            )
        for name, at, length in (("cx", self.cx, self.width), ("cy", self.cy, self.height)):
            if at >= LEAST_PRINCIPAL_SHARE * length:
                continue
            middle = (length - 1) / 2
            share = 0.3 <= at <= 0.7
            raise InputError(
                f"{name} is probably a share of the frame"
                if share
                else f"{name} is probably an offset from the frame's middle",
                value=f"{at:g} of {length} pixels",
                hint=f"count it from the first pixel: {at * length - 0.5 if share else middle + at:g}",
            )

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The calibration matrix A: float64 ``[3, 3]``, from rays (right, down, forward) to (x, y, 1)."""
        return np.array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1]], dtype=np.float64)

    @classmethod
    def of_focal(cls, focal_px: float, width: int, height: int, tilt_deg: float = 0.0) -> Self:
        """A camera with square pixels and its principal point in the middle of the frame."""
        return cls(focal_px, focal_px, (width - 1) / 2, (height - 1) / 2, width, height, tilt_deg=tilt_deg)

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a TOML file with a table ``[camera]``.

        Its keys are ``focal``, or ``fx``, ``fy``, ``cx`` and ``cy``; ``width`` and ``height``; and, if
        wanted, ``distortion``, ``tilt_deg``, ``lean_deg``, ``twist_deg`` and ``stabilised``.

        Raises:
            InputError: the file cannot be read, is not TOML, lacks a key or has one too many, or a value is
                of the wrong kind, out of range, or probably in another unit.
        """
        try:
            table = tomllib.loads(path.read_text(encoding="utf-8")).get("camera")
        except OSError as error:
            raise InputError("cannot read the camera", value=f"{path} ({error.strerror})") from error
        except (ValueError, RecursionError) as error:
            raise InputError("the camera is not TOML", value=f"{path} ({error})", hint=_FORM) from error
        if not isinstance(table, dict):
            raise InputError("no camera in the file", value=path, hint=_FORM)
        camera = cls.of_table(table, path)
        try:
            camera.require_pixels()
        except InputError as error:
            raise InputError(
                f"the camera {path}: {error.fault}", value=error.value, hint=error.hint
            ) from None
        return camera

    @classmethod
    def of_table(cls, table: dict[str, Any], path: Path) -> Self:
        """A camera of the keys of `read`; its errors, too, are those of `read`, and name the file."""
        unknown = sorted(table.keys() - KEYS)
        if unknown:
            raise InputError(f"the camera {path} has an unknown key", value=", ".join(unknown), hint=_FORM)
        needed = {"focal"} if "focal" in table else {"fx", "fy", "cx", "cy"}
        missing = sorted((needed | {"width", "height"}) - table.keys())
        if missing:
            raise InputError(f"the camera {path} lacks a key", value=", ".join(missing), hint=_FORM)
        stabilised = table.get("stabilised", False)
        if not isinstance(stabilised, bool):
            raise InputError(
                f"the camera {path}: stabilised is neither true nor false", value=repr(stabilised)
            )
        numbers = {key: value for key, value in table.items() if key not in ("distortion", "stabilised")}
        for key, value in numbers.items():
            whole = key in ("width", "height")
            if isinstance(value, bool) or not isinstance(value, int if whole else (int, float)):
                raise InputError(
                    f"the camera {path}: {key} is not a {'whole ' if whole else ''}number", value=repr(value)
                )
        distortion = table.get("distortion", [])
        if not isinstance(distortion, list) or not all(
            isinstance(value, (int, float)) and not isinstance(value, bool) for value in distortion
        ):
            raise InputError(
                f"the camera {path}: distortion is not a list of numbers", value=repr(distortion)
            )
        try:
            if "focal" in numbers:
                middle = cls.of_focal(numbers.pop("focal"), numbers["width"], numbers["height"])
                pinhole = {key: getattr(middle, key) for key in ("fx", "fy", "cx", "cy")}
                numbers = {**pinhole, **numbers}
            lens = tuple(float(value) for value in distortion)
            return cls(**numbers, distortion=lens, stabilised=stabilised)
        except InputError as error:
            raise InputError(
                f"the camera {path}: {error.fault}", value=error.value, hint=error.hint
            ) from None

    def scaled(self, width: int, height: int) -> Self:
        """The camera of frames that were resized from its own to another size of the same shape.

        Raises:
            InputError: the new size has another shape, so that the frames were cropped, not resized.
        """
        self.require_shape(width, height, "frames")
        return self.resized(width, height)

    def require_shape(self, width: int, height: int, what: str) -> None:
        """Raise InputError, which names ``what``, unless the sides have the camera's ratio."""
        if abs(width * self.height / (height * self.width) - 1) > _SHAPE_TOLERANCE:
            raise InputError(
                f"{what}: another shape than the camera's",
                value=f"{width}x{height}, not {self.width}x{self.height}",
                hint="give the camera as it is for these frames",
            )

    def resized(self, width: int, height: int) -> Self:
        """The camera whose frames are this one's, stretched to another size."""
        across, down = width / self.width, height / self.height
        return replace(
            self,
            fx=self.fx * across,
            fy=self.fy * down,
            cx=(self.cx + 0.5) * across - 0.5,
            cy=(self.cy + 0.5) * down - 0.5,
            width=width,
            height=height,
        )

    def rays(self, columns: NDArray[np.float64], rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Directions that pixels look in, distortion undone.

        Args:
            columns: float64 ``S``, x of points in the frame.
            rows: float64 ``S``, y of them.

        Returns:
            float64 ``S + (3,)``: right, down and forward in the camera's axes, forward 1.
        """
        points = np.stack([columns, rows], axis=-1).astype(np.float64)
        if self.distortion:
            import cv2

            flat = cv2.undistortPoints(points.reshape(-1, 1, 2), self.matrix, np.array(self.distortion))
            points = np.asarray(flat, dtype=np.float64).reshape(points.shape)
        else:
            points = (points - (self.cx, self.cy)) / (self.fx, self.fy)
        return np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1)
