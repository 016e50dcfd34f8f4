"""The embedded flight: its truth is exact, its frames show what the pose says, its files are well formed."""

import csv
import math
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import ExtraMissingError, InputError
from wnn2hdl.samples import flight as flight_module
from wnn2hdl.samples.flight import POSE_COLUMNS, Flight, make_flight, write_flight
from wnn2hdl.samples.plane import Window
from wnn2hdl.samples.raycast import ground_points

pyproj = pytest.importorskip("pyproj")
rasterio = pytest.importorskip("rasterio")

MAP, FRAME = (700, 760), (60, 96)

HASH = """
import hashlib
from wnn2hdl.samples.flight import make_flight
flight = make_flight(5, (500, 500), frames=3, frame_size=(30, 40), height_m=60)
print(hashlib.sha256(flight.map_image).hexdigest(), flight.poses, hashlib.sha256(flight.frame(2)).hexdigest())
"""


def fly(seed: int = 3, **changes: float) -> Flight:
    return make_flight(seed, MAP, frames=8, frame_size=FRAME, height_m=80, spacing_m=20, **changes)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def flight() -> Flight:
    return fly()


def test_the_same_arguments_give_the_same_bytes_in_another_process() -> None:
    runs = {
        subprocess.run([sys.executable, "-c", HASH], capture_output=True, check=True).stdout for _ in range(2)
    }
    assert len(runs) == 1


def test_sizes_are_as_asked_for(flight: Flight) -> None:
    assert flight.map_image.shape == (*MAP, 3)
    assert flight.map_image.dtype == np.uint8
    assert len(flight.poses) == 8
    shown = list(flight.frames())
    assert [pose for pose, _ in shown] == list(flight.poses)
    assert {(picture.shape, picture.dtype) for _, picture in shown} == {((*FRAME, 3), np.dtype(np.uint8))}


def test_places_are_true_to_a_centimetre_and_the_speed_is_constant(flight: Flight) -> None:
    """From degrees as they are written, back to the grid, through another projection code path."""
    to_grid = pyproj.Transformer.from_crs(4326, flight.epsg, always_xy=True)
    to_degrees = pyproj.Transformer.from_crs(flight.epsg, 4326, always_xy=True)
    grid = [to_grid.transform(pose.longitude_deg, pose.latitude_deg) for pose in flight.poses]
    for (east, north), pose in zip(grid, flight.poses, strict=True):
        longitude, latitude = to_degrees.transform(east, north)
        assert abs(longitude - pose.longitude_deg) < 1e-11
        assert abs(latitude - pose.latitude_deg) < 1e-11
    # The way between frames is as long as asked for, less what the chord cuts off in turns.
    steps = np.linalg.norm(np.diff(grid, axis=0), axis=1)
    assert steps.max() <= 20.001
    assert np.median(steps) > 19


def test_all_places_lie_on_the_map(flight: Flight) -> None:
    to_grid = pyproj.Transformer.from_crs(4326, flight.epsg, always_xy=True)
    a, _, west, _, e, north = flight.transform
    for pose in flight.poses:
        x, y = to_grid.transform(pose.longitude_deg, pose.latitude_deg)
        assert 0 < (x - west) / a < MAP[1]
        assert 0 < (y - north) / e < MAP[0]


def test_the_nose_points_along_the_track_but_for_wind_and_gusts(flight: Flight) -> None:
    geod = pyproj.Geod(ellps="WGS84")
    calm = fly(gusts_deg=0.0)
    crabs = []
    for before, here, after in zip(calm.poses, calm.poses[1:], calm.poses[2:], strict=False):
        azimuth, _, _ = geod.inv(
            before.longitude_deg, before.latitude_deg, after.longitude_deg, after.latitude_deg
        )
        crabs.append((here.yaw_deg - azimuth + 180) % 360 - 180)
        assert (here.pitch_deg, here.roll_deg, here.height_m) == (0, 0, 80)
    assert abs(np.mean(crabs)) < 11
    assert np.std(crabs) < 4
    gusts = np.array([[pose.pitch_deg, pose.roll_deg] for pose in flight.poses])
    assert 0.3 < gusts.std() < 5


@pytest.mark.parametrize("lens", [(), (-0.1, 0.02, 0.001, -0.001, 0.0)])
def test_a_marker_on_the_ground_appears_where_geodesy_and_opencv_put_it(
    flight: Flight, lens: tuple[float, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The marker is given by its latitude and longitude; distance and azimuth on the ellipsoid are PROJ's."""
    taken = replace(flight.camera, distortion=lens)
    marked = replace(flight, camera=taken, noise=0.0)
    geod = pyproj.Geod(ellps="WGS84")
    to_grid = pyproj.Transformer.from_crs(4326, flight.epsg, always_xy=True)
    a, _, west, _, e, north = flight.transform
    for number, pose in enumerate(flight.poses):
        azimuth, metres = (pose.yaw_deg + 55 * number) % 360, 12.0 + number
        longitude, latitude, _ = geod.fwd(pose.longitude_deg, pose.latitude_deg, azimuth, metres)
        x, y = to_grid.transform(longitude, latitude)
        column, row = (x - west) / a - 0.5, (y - north) / e - 0.5

        def spot(
            _seed: int, window: Window, _season: str, row: float = row, column: float = column
        ) -> NDArray[np.uint8]:
            from_row, from_column = window.rows[:, np.newaxis] - row, window.columns - column
            light = 255 * np.exp(-(from_row**2 + from_column**2) / (2 * 1.5**2))
            return np.repeat(np.rint(light).astype(np.uint8)[..., np.newaxis], 3, axis=2)

        monkeypatch.setattr(flight_module, "paint", spot)
        light = marked.frame(number)[..., 1].astype(np.float64)
        y_seen, x_seen = (
            float((light * axis).sum() / light.sum()) for axis in np.mgrid[: FRAME[0], : FRAME[1]]
        )

        ground = np.array(
            [
                metres * math.cos(math.radians(azimuth)),
                metres * math.sin(math.radians(azimuth)),
                pose.height_m,
            ]
        )
        turns = [
            cv2.Rodrigues(np.radians(np.array(vector, dtype=np.float64)))[0]
            for vector in (
                (0, 0, pose.yaw_deg),
                (0, pose.pitch_deg, 0),
                (pose.roll_deg, 0, 0),
                (0, taken.tilt_deg, 0),
                (0, 0, 90),
            )
        ]
        backward, _ = cv2.Rodrigues(np.linalg.multi_dot(turns).T)
        matrix = np.array(
            [[taken.focal_px, 0, (FRAME[1] - 1) / 2], [0, taken.focal_px, (FRAME[0] - 1) / 2], [0, 0, 1]]
        )
        pixel, _ = cv2.projectPoints(
            ground.reshape(1, 1, 3), backward, np.zeros(3), matrix, np.array(lens or (0.0,) * 5)
        )
        assert math.dist(pixel.ravel(), (x_seen, y_seen)) < 0.1


def test_rays_meet_the_map_to_a_millimetre_of_the_ellipsoids_geodesics(flight: Flight) -> None:
    """True north and true metres are neither the grid's north nor its metres: 0.3 degrees, 6 mm in 100 m."""
    geod = pyproj.Geod(ellps="WGS84")
    to_grid = pyproj.Transformer.from_crs(4326, flight.epsg, always_xy=True)
    a, _, west, _, e, north = flight.transform
    for number, pose in enumerate(flight.poses):
        rows, columns = flight.ground_pixels(number)
        offsets = ground_points(flight.camera, pose)
        for corner in ((0, 0), (0, -1), (-1, 0), (-1, -1), (20, 30)):
            true_north, true_east = offsets[corner]
            longitude, latitude, _ = geod.fwd(
                pose.longitude_deg,
                pose.latitude_deg,
                math.degrees(math.atan2(true_east, true_north)),
                math.hypot(true_east, true_north),
            )
            x, y = to_grid.transform(longitude, latitude)
            there = (columns[corner] + 0.5) * a + west, (rows[corner] + 0.5) * e + north
            assert math.dist((x, y), there) < 0.001


def test_frames_show_the_other_season_and_noise(flight: Flight) -> None:
    rows, columns = (np.rint(places).astype(int) for places in flight.ground_pixels(0))
    on_map = flight.map_image[rows, columns].astype(float)
    clean, noisy = replace(flight, noise=0.0).frame(0).astype(float), flight.frame(0).astype(float)
    assert np.abs(clean - on_map).mean() > 8
    assert (noisy - clean).std() == pytest.approx(4, abs=0.5)


def test_seeds_give_other_countries_and_tracks(flight: Flight) -> None:
    other = fly(4)
    assert (other.map_image != flight.map_image).any(axis=2).mean() > 0.9
    assert other.poses != flight.poses


def test_written_files_read_back(flight: Flight, tmp_path: Path) -> None:
    written = list(write_flight(tmp_path / "f", flight))
    assert {path.relative_to(tmp_path / "f").as_posix() for path in written} == {
        "map.tif",
        "poses.csv",
        "camera.toml",
        *(f"frames/{pose.frame}" for pose in flight.poses),
    }
    with rasterio.open(tmp_path / "f" / "map.tif") as file:
        assert np.array_equal(file.read().transpose(1, 2, 0), flight.map_image)
        assert file.crs.to_epsg() == flight.epsg
        assert tuple(file.transform)[:6] == flight.transform
    with (tmp_path / "f" / "poses.csv").open(newline="") as stream:
        rows = list(csv.reader(stream))
    assert tuple(rows[0]) == POSE_COLUMNS
    for row, pose in zip(rows[1:], flight.poses, strict=True):
        assert row[0] == pose.frame
        assert [float(cell) for cell in row[1:]] == [
            pose.latitude_deg,
            pose.longitude_deg,
            pose.height_m,
            pose.yaw_deg,
            pose.pitch_deg,
            pose.roll_deg,
        ]
    camera = tomllib.loads((tmp_path / "f" / "camera.toml").read_text())["camera"]
    assert camera == {"focal": 72.0, "width": 96, "height": 60, "tilt_deg": 10.0, "distortion": []}
    with Image.open(tmp_path / "f" / "frames" / "frame_001.jpg") as picture:
        assert (picture.format, picture.size) == ("JPEG", (96, 60))
        difference = np.asarray(picture).astype(float) - flight.frame(0)
        assert np.abs(difference).mean() < 6


def test_writing_twice_gives_the_same_bytes(flight: Flight, tmp_path: Path) -> None:
    for name in ("one", "two"):
        for path in write_flight(tmp_path / name, flight):
            assert path.read_bytes() == (tmp_path / "one" / path.relative_to(tmp_path / name)).read_bytes()


@pytest.mark.parametrize(
    ("changes", "hint"),
    [
        ({"seed": -1}, "a seed of at least 0"),
        ({"frames": 0}, "at least 1 frame"),
        ({"map_shape": (0, 900)}, "a map of at least 1 pixel"),
        ({"height_m": 0.0}, "a height and a spacing above 0"),
        ({"spacing_m": -1.0}, "a height and a spacing above 0"),
        ({"noise": -1.0}, "noise of 0 to 255"),
        ({"gusts_deg": float("inf")}, "gusts of 0 to 20 degrees"),
        ({"map_shape": (300, 900)}, "or fly lower"),
        ({"focal_px": -5.0}, "a focal length above 0"),
        ({"distortion": (0.1,)}, "give k1, k2, p1, p2 and k3"),
    ],
)
def test_impossible_flights_are_refused(changes: dict[str, object], hint: str) -> None:
    arguments: dict[str, object] = {"seed": 0, "map_shape": MAP, "frames": 2, "frame_size": FRAME} | changes
    with pytest.raises(InputError, match=hint):
        make_flight(**arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize("package", ["pyproj", "rasterio"])
def test_the_extra_is_named_where_it_is_missing(
    package: str, flight: Flight, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == package]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ExtraMissingError, match=r"wnn2hdl\[geo\]"):
        list(write_flight(tmp_path, flight))
