"""The embedded flight: a map of town and country, and the frames of a UAV over it in another season.

The map is a picture in the grid of `wnn2hdl.samples.georeference`, 0.5 m per pixel. Where the UAV is, is
decided in that grid, and its latitude and longitude follow from it by the projection, so they are exact.
The ground is the plane of the grid, without any height.
"""

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError, extra_needed
from wnn2hdl.files import make_folder, output_folder, write_bytes, write_text
from wnn2hdl.samples.country import GROUND_SAMPLE_DISTANCE_M, paint
from wnn2hdl.samples.georeference import EPSG, NORTH, WEST, Grid
from wnn2hdl.samples.plane import Window
from wnn2hdl.samples.raycast import SampleCamera, SamplePose, ground_points, look_up
from wnn2hdl.samples.render import Season
from wnn2hdl.samples.track import fly_track, gusts

FULL_MAP = (9872, 10386)
"""Height and width of the reference's map, pixels of half a metre."""

POSE_COLUMNS = (
    "frame",
    "latitude_deg",
    "longitude_deg",
    "height_above_ground_m",
    "yaw_deg",
    "pitch_deg",
    "roll_deg",
)

_MAP_SEASON: Season = "dry"
_FRAME_SEASON: Season = "wet"


@dataclass(frozen=True, eq=False)
class Flight:
    """A map and a flight over it.

    Attributes:
        seed: of the country, the track, and the frames' noise.
        map_image: uint8 ``[height, width, 3]``: red, green, blue, north up.
        transform: six numbers a … f of an affine transform as rasterio's ``Affine``: a pixel's corner at
            (column, row) lies at easting ``a * column + b * row + c``, northing ``d * column + e * row + f``.
        epsg: code of the map's coordinate system.
        camera: that takes the frames.
        poses: true ones, one per frame.
        noise: standard deviation of the frames' noise in grey levels.
    """

    seed: int
    map_image: NDArray[np.uint8]
    transform: tuple[float, float, float, float, float, float]
    epsg: int
    camera: SampleCamera
    poses: tuple[SamplePose, ...]
    noise: float

    def frame(self, number: int) -> NDArray[np.uint8]:
        """Render one frame.

        Args:
            number: of its pose, from 0.

        Returns:
            uint8 ``[height, width, 3]`` in the other season's light. The ground continues past the map.

        Raises:
            ExtraMissingError: pyproj is not installed.
            InputError: the camera sees the horizon.
        """
        rows, columns = self.ground_pixels(number)
        top, left = int(np.floor(rows.min())), int(np.floor(columns.min()))
        window = Window(top, left, int(np.ceil(rows.max())) - top + 1, int(np.ceil(columns.max())) - left + 1)
        ground = paint(self.seed, window, _FRAME_SEASON)
        light = look_up(ground, rows - top, columns - left)
        rng = np.random.default_rng([self.seed, 0xF4A3E, number])
        light *= rng.uniform(0.8, 1.15) * rng.uniform(0.95, 1.05, 3)
        light += rng.normal(0, self.noise, light.shape)
        return np.clip(np.rint(light), 0, 255).astype(np.uint8)

    def frames(self) -> Iterator[tuple[SamplePose, NDArray[np.uint8]]]:
        """All frames with their poses, rendered one at a time."""
        for number, pose in enumerate(self.poses):
            yield pose, self.frame(number)

    def ground_pixels(self, number: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rows and columns of the map that a frame's pixels look at, each float64 ``[height, width]``.

        A row or column of 0 is the first pixel's centre; past the map they are negative or too large.

        Raises:
            ExtraMissingError: pyproj is not installed.
            InputError: the camera sees the horizon.
        """
        pose = self.poses[number]
        grid = Grid()
        east, north = grid.position(pose.latitude_deg, pose.longitude_deg)
        offsets = grid.to_grid(ground_points(self.camera, pose), pose.latitude_deg, pose.longitude_deg)
        a, _, west, _, e, top = self.transform
        return (north + offsets[..., 0] - top) / e - 0.5, (east + offsets[..., 1] - west) / a - 0.5


def make_flight(
    seed: int,
    map_shape: tuple[int, int] = FULL_MAP,
    *,
    frames: int = 35,
    frame_size: tuple[int, int] = (562, 1000),
    focal_px: float | None = None,
    height_m: float = 120.0,
    tilt_deg: float = 10.0,
    distortion: tuple[float, ...] = (),
    spacing_m: float = 35.0,
    gusts_deg: float = 2.5,
    noise: float = 4.0,
) -> Flight:
    """Generate a map and a flight over it; the same arguments give the same bytes.

    Args:
        seed: at least 0.
        map_shape: height and width of the map, pixels of half a metre.
        frames: how many.
        frame_size: height and width of a frame, pixels.
        focal_px: focal length; by default three quarters of the frame's width.
        height_m: mean height above ground.
        tilt_deg: of the camera, forward.
        distortion: of the lens, ``k1, k2, p1, p2[, k3]`` of OpenCV's model.
        spacing_m: metres on the ground from frame to frame, along the track.
        gusts_deg: standard deviation of yaw, pitch and roll about their means.
        noise: standard deviation of the frames' noise in grey levels.

    Returns:
        the flight; its frames are rendered when they are asked for. The full map takes 34 s of one core and
        345 MB, of which the picture is 308 MB (measured).

    Raises:
        ExtraMissingError: pyproj is not installed.
        InputError: a size, count or length out of range, or a map too small for the frames.
    """
    checks = {
        "a seed of at least 0": seed >= 0,
        "at least 1 frame": frames >= 1,
        "a map of at least 1 pixel": min(map_shape) >= 1,
        "a height and a spacing above 0": height_m > 0 and spacing_m > 0,
        "gusts of 0 to 20 degrees": 0 <= gusts_deg <= 20,
        "noise of 0 to 255 grey levels": 0 <= noise <= 255,
    }
    for need, met in checks.items():
        if not met:
            raise InputError("no such flight", value=f"seed {seed}, map {map_shape}", hint=f"use {need}")
    focal = 0.75 * frame_size[1] if focal_px is None else focal_px
    camera = SampleCamera(focal, frame_size[1], frame_size[0], tilt_deg, distortion)
    poses = _fly(seed, map_shape, camera, frames, height_m, spacing_m, gusts_deg)
    step = GROUND_SAMPLE_DISTANCE_M
    return Flight(
        seed,
        paint(seed, Window(0, 0, *map_shape), _MAP_SEASON),
        (step, 0.0, WEST, 0.0, -step, NORTH),
        EPSG,
        camera,
        poses,
        noise,
    )


def write_flight(folder: Path, flight: Flight) -> Iterator[Path]:
    """Write ``map.tif``, ``poses.csv``, ``camera.toml`` and ``frames/*.jpg``; what exists is replaced.

    Yields:
        each file once it is written, so that progress can be shown; nothing happens until it is asked for.

    Raises:
        ExtraMissingError: rasterio or pyproj is not installed.
        InputError: the folder cannot be written.
    """
    with output_folder(folder, "generated flight"):
        make_folder(folder / "frames")
        write_bytes(folder / "map.tif", _geotiff(flight))
        yield folder / "map.tif"
        write_text(folder / "poses.csv", _pose_table(flight.poses))
        yield folder / "poses.csv"
        write_text(folder / "camera.toml", _camera_table(flight.camera))
        yield folder / "camera.toml"
        for pose, picture in flight.frames():
            stream = io.BytesIO()
            Image.fromarray(picture).save(stream, "JPEG", quality=92)
            path = folder / "frames" / pose.frame
            write_bytes(path, stream.getvalue())
            yield path


def _fly(
    seed: int,
    map_shape: tuple[int, int],
    camera: SampleCamera,
    frames: int,
    height_m: float,
    spacing_m: float,
    gusts_deg: float,
) -> tuple[SamplePose, ...]:
    """True poses along a track between random waypoints, at constant speed, in wind."""
    grid = Grid()
    rng = np.random.default_rng([seed, 0xF11])
    half_diagonal = np.hypot(camera.width, camera.height) / 2 / camera.focal_px
    margin = height_m * (half_diagonal + np.tan(np.radians(abs(camera.tilt_deg))))
    sides = np.array(map_shape) * GROUND_SAMPLE_DISTANCE_M
    room = sides - 2 * margin
    if room.min() < 2 * spacing_m:
        raise InputError(
            "the map is too small for such a flight",
            value=f"{sides[1]:g} m x {sides[0]:g} m",
            hint=f"use sides of at least {2 * (margin + spacing_m):.0f} m, or fly lower",
        )
    track = fly_track(rng, room, frames, spacing_m)
    # The wind blows from one side all the time, so the nose does not point along the track. The angle takes
    # in the third of a degree between the grid's north, which the track has, and true north.
    crab = rng.uniform(-10, 10)
    yaw, pitch, roll, sway = (gusts_deg * gusts(rng, frames) for _ in range(4))
    poses = []
    for number in range(frames):
        east = WEST + margin + float(track.east[number])
        north = NORTH - margin - float(track.south[number])
        latitude, longitude = grid.degrees(east, north)
        poses.append(
            SamplePose(
                frame=f"frame_{number + 1:03d}.jpg",
                # Nine decimals are a tenth of a millimetre; the frame is rendered from what is written.
                latitude_deg=round(latitude, 9),
                longitude_deg=round(longitude, 9),
                height_m=round(height_m * (1 + 0.004 * float(sway[number])), 3),
                yaw_deg=round((float(track.heading_deg[number]) + crab + float(yaw[number])) % 360, 4),
                pitch_deg=round(float(pitch[number]), 4),
                roll_deg=round(float(roll[number]), 4),
            )
        )
    return tuple(poses)


def _geotiff(flight: Flight) -> bytes:
    with extra_needed("geo", "a map needs rasterio"):
        from rasterio.io import MemoryFile
        from rasterio.transform import Affine
    height, width, bands = flight.map_image.shape
    profile = {
        "driver": "GTiff",
        "dtype": "uint8",
        "height": height,
        "width": width,
        "count": bands,
        "crs": f"EPSG:{flight.epsg}",
        "transform": Affine(*flight.transform),
        "tiled": True,
        "blockxsize": 512,
        "blockysize": 512,
        "photometric": "RGB",
        "interleave": "pixel",
        "compress": "deflate",
        "predictor": 2,
    }
    with MemoryFile() as memory:
        with memory.open(**profile) as file:
            for band in range(bands):
                file.write(flight.map_image[..., band], band + 1)
        return bytes(memory.read())


def _pose_table(poses: tuple[SamplePose, ...]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(POSE_COLUMNS)
    writer.writerows(
        (
            pose.frame,
            f"{pose.latitude_deg:.9f}",
            f"{pose.longitude_deg:.9f}",
            f"{pose.height_m:.3f}",
            f"{pose.yaw_deg:.4f}",
            f"{pose.pitch_deg:.4f}",
            f"{pose.roll_deg:.4f}",
        )
        for pose in poses
    )
    return stream.getvalue()


def _camera_table(camera: SampleCamera) -> str:
    distortion = ", ".join(f"{value!r}" for value in camera.distortion)
    return (
        "[camera]\n"
        f"focal = {camera.focal_px!r}\n"
        f"width = {camera.width}\n"
        f"height = {camera.height}\n"
        f"tilt_deg = {camera.tilt_deg!r}\n"
        f"distortion = [{distortion}]\n"
    )
