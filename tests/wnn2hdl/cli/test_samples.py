"""`samples` writes what `train` reads, for two classes and for all kinds of ground."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from wnn2hdl.cli.learn import train_command
from wnn2hdl.cli.samples import samples_command
from wnn2hdl.navigate.camera import Camera
from wnn2hdl.navigate.poses import read_poses
from wnn2hdl.navigate.recording import Recording
from wnn2hdl.samples import CLASSES


def test_a_model_of_all_kinds_of_ground_from_the_written_files(tmp_path: Path) -> None:
    folder = tmp_path / "samples"
    done = CliRunner().invoke(samples_command, ["--images", "6", "--side", "96", "--json", "-o", str(folder)])
    assert json.loads(done.stdout)["images"] == 6
    options = [
        "--images",
        folder / "images",
        "--masks",
        folder / "kinds",
        "--palette",
        folder / "palette.json",
    ]
    model = tmp_path / "kinds.json"
    done = CliRunner().invoke(train_command, [*map(str, options), "--json", "-o", str(model)])
    assert json.loads(done.stdout)["classes"] == list(CLASSES)


def test_a_flight_is_written_as_it_is_read(tmp_path: Path) -> None:
    folder = tmp_path / "country"
    arguments = ["--flight", "--side", "700", "--images", "2", "--json", "-o", str(folder)]
    done = CliRunner().invoke(samples_command, arguments)
    assert json.loads(done.stdout) == {
        "folder": str(folder),
        "images": 2,
        "height": 700,
        "width": 700,
        "seed": 0,
    }
    poses = read_poses(folder / "poses.csv")
    camera = Camera.read(folder / "camera.toml")
    recording = Recording.of_files(folder / "map.tif", folder / "frames", poses, camera)
    assert recording.world.gsd_m == pytest.approx(0.5, abs=0.001)
    assert [recording.read(pose).shape for pose in recording.poses] == [(camera.height, camera.width, 3)] * 2
