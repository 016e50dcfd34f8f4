"""What a flight brought home: a map, a camera, frames and their poses; from files, or the embedded one."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.conventions import require_over_map
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.world import AS_STATED, WorldMap
from wnn2hdl.errors import InputError
from wnn2hdl.images import picture_size, read_rgb
from wnn2hdl.raster import Reading
from wnn2hdl.samples.flight import Flight, make_flight

SAMPLE_MAP = (1000, 1000)
SAMPLE_FRAMES = 10
SAMPLE_FRAME_SIZE = (281, 500)
SAMPLE_SPACING_M = 30.0
"""The embedded flight: small, for demos and first steps."""


@dataclass(frozen=True)
class Recording:
    """A flight over a map.

    Attributes:
        map_name: for tables.
        world: the map.
        camera: as it is known before any calibration.
        poses: one per frame, in the order of the flight.
        read: the frame of a pose, uint8 ``[height, width, 3]``.
    """

    map_name: str
    world: WorldMap
    camera: Camera
    poses: tuple[Pose, ...]
    read: Callable[[Pose], NDArray[np.uint8]]

    @classmethod
    def of_files(
        cls,
        map_file: Path,
        files: Mapping[Pose, Path],
        camera: Camera | float,
        reading: Reading = AS_STATED,
    ) -> Self:
        """A recording whose frames are read when they are wanted.

        Args:
            map_file: a georeferenced picture.
            files: the file of each frame, at least one, in the order of the flight.
            camera: the camera, or its focal length in pixels of the first frame.
            reading: how the map is read.

        Raises:
            ExtraMissingError: rasterio or pyproj is not installed.
            InputError: the map or a frame is missing or cannot be used, or does not have the camera's
                shape; no position is on the map; the camera's numbers are probably not in pixels.
        """
        world = WorldMap.read(map_file, reading)
        require_over_map([*files], world)
        sizes = {file: picture_size(file) for file in files.values()}
        height, width = next(iter(sizes.values()))
        known = camera if isinstance(camera, Camera) else Camera.of_focal(camera, width, height)
        known.require_pixels()
        for file, (rows, columns) in sizes.items():
            known.require_shape(columns, rows, file.name)
        scaled = known.resized(width, height)
        return cls(map_file.name, world, scaled, tuple(files), lambda pose: read_rgb(files[pose]))

    @classmethod
    def embedded(cls, seed: int) -> Self:
        """The synthetic flight: generated country, another season's light, wind, and exact truth.

        Raises:
            ExtraMissingError: rasterio or pyproj is not installed.
        """
        flight = make_flight(
            seed, SAMPLE_MAP, frames=SAMPLE_FRAMES, frame_size=SAMPLE_FRAME_SIZE, spacing_m=SAMPLE_SPACING_M
        )
        world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
        seen = flight.camera
        camera = Camera.of_focal(seen.focal_px, seen.width, seen.height, seen.tilt_deg)
        numbers = {pose.frame: number for number, pose in enumerate(flight.poses)}
        return cls(
            "embedded map",
            world,
            replace(camera, distortion=seen.distortion),
            poses_of(flight),
            lambda pose: flight.frame(numbers[pose.frame]),
        )

    def scoring(self, poses: Sequence[Pose]) -> Self:
        """The same flight with these poses only."""
        return replace(self, poses=tuple(poses))


def poses_of(flight: Flight) -> tuple[Pose, ...]:
    """The poses of a generated flight."""
    return tuple(
        Pose(
            at.frame,
            at.latitude_deg,
            at.longitude_deg,
            at.height_m,
            at.yaw_deg,
            at.pitch_deg,
            at.roll_deg,
        )
        for at in flight.poses
    )


def split(poses: Sequence[Pose], calibrating: int) -> tuple[tuple[Pose, ...], tuple[Pose, ...]]:
    """Calibration frames, spread evenly over the flight from its first to its last frame, and the others.

    Raises:
        InputError: fewer than two frames are left to score.
    """
    if calibrating > len(poses) - 2:
        raise InputError(
            "too few frames are left to score",
            value=f"{calibrating} of {len(poses)} calibrate",
            hint="calibrate on fewer, or give the poses of other frames",
        )
    chosen = set(np.linspace(0, len(poses) - 1, calibrating).round().astype(int).tolist())
    return (
        tuple(pose for i, pose in enumerate(poses) if i in chosen),
        tuple(pose for i, pose in enumerate(poses) if i not in chosen),
    )


def unseen(poses: Sequence[Pose], calibrating: Sequence[Pose]) -> tuple[Pose, ...]:
    """Poses of frames that nothing was fitted on; raises InputError if there are none."""
    left = tuple(pose for pose in poses if pose not in calibrating)
    if not left:
        raise InputError(
            "all frames of the poses were used to calibrate", value=poses[0].frame, hint="locate other frames"
        )
    return left
