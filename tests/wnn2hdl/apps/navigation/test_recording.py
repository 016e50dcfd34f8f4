"""Flights to locate: their files, and the embedded one."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.poses import Pose, frame_files, read_poses
from wnn2hdl.apps.navigation.recording import Recording, split
from wnn2hdl.errors import InputError
from wnn2hdl.samples.flight import make_flight, write_flight

POSES = [Pose(f"{i}.jpg", 24, 120, 100, 0) for i in range(9)]


def test_calibration_frames_are_spread_over_the_flight() -> None:
    calibrating, scored = split(POSES, 3)
    assert [pose.frame for pose in calibrating] == ["0.jpg", "4.jpg", "8.jpg"]
    assert [pose.frame for pose in scored] == ["1.jpg", "2.jpg", "3.jpg", "5.jpg", "6.jpg", "7.jpg"]


def test_something_must_be_left_to_score() -> None:
    assert len(split(POSES, 7)[1]) == 2
    with pytest.raises(InputError, match="too few frames are left to score: 8 of 9 calibrate"):
        split(POSES, 8)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flight")
    flight = make_flight(1, (500, 500), frames=2, frame_size=(90, 160), height_m=50)
    assert len(list(write_flight(path, flight))) == 5
    return path


def poses_of(folder: Path) -> list[Pose]:
    return [*read_poses(folder / "poses.csv")]


def test_frames_are_read_when_they_are_wanted(folder: Path) -> None:
    poses = poses_of(folder)
    recording = Recording.of_files(folder / "map.tif", frame_files(poses, folder / "frames"), 120.0)
    assert recording.camera == Camera.of_focal(120, 160, 90)
    assert recording.read(poses[1]).shape == (90, 160, 3)
    assert recording.scoring(poses[:1]).poses == (poses[0],)


def test_a_camera_of_larger_frames_is_scaled(folder: Path) -> None:
    camera = Camera.of_focal(240, 320, 180, tilt_deg=10)
    files = frame_files(poses_of(folder), folder / "frames")
    recording = Recording.of_files(folder / "map.tif", files, camera)
    assert recording.camera == Camera.of_focal(120, 160, 90, tilt_deg=10)
    with pytest.raises(InputError, match="another shape"):
        Recording.of_files(folder / "map.tif", files, Camera.of_focal(240, 320, 320))


def test_a_frame_of_another_shape_is_named_at_once(folder: Path, tmp_path: Path) -> None:
    one, two = poses_of(folder)
    Image.new("RGB", (90, 90)).save(tmp_path / "square.jpg")
    files = {one: folder / "frames" / one.frame, two: tmp_path / "square.jpg"}
    with pytest.raises(InputError, match=r"square\.jpg: another shape than the camera's: 90x90, not 160x90"):
        Recording.of_files(folder / "map.tif", files, 120.0)


@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_missing_files_are_refused(folder: Path, tmp_path: Path) -> None:
    poses = poses_of(folder)
    with pytest.raises(InputError, match=r"cannot read the picture: .*map\.tif"):
        Recording.of_files(tmp_path / "map.tif", frame_files(poses, folder / "frames"), 120.0)
    with pytest.raises(InputError, match="cannot read the picture"):
        Recording.of_files(folder / "map.tif", {poses[0]: tmp_path / "none.jpg"}, 120.0)
    Image.fromarray(np.zeros((9, 9, 3), np.uint8)).save(tmp_path / "plain.tif")
    with pytest.raises(InputError, match="no georeference"):
        Recording.of_files(tmp_path / "plain.tif", frame_files(poses, folder / "frames"), 120.0)


def test_the_embedded_flight_is_the_same_each_time() -> None:
    one, two = Recording.embedded(5), Recording.embedded(5)
    assert one.poses == two.poses
    assert (one.read(one.poses[3]) == two.read(two.poses[3])).all()
    assert Recording.embedded(6).poses != one.poses
