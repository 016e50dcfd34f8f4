"""`samples` writes what `train` reads, for two classes and for all kinds of ground."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.poses import frame_files, read_poses
from wnn2hdl.apps.navigation.recording import Recording
from wnn2hdl.samples import CLASSES

Run = Callable[..., Any]


def test_a_model_of_all_kinds_of_ground_from_the_written_files(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "samples"
    done = run("samples", "--count", 6, "--side", 96, "--json", "-o", folder)
    assert json.loads(done.stdout)["images"] == 6
    given = ("--images", folder / "images", "--masks", folder / "kinds", "--palette", folder / "palette.json")
    done = run("train", *given, "--json", "-o", tmp_path / "kinds.json")
    assert json.loads(done.stdout)["classes"] == list(CLASSES)


def test_a_flight_is_written_as_it_is_read(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "country"
    done = run("samples", "--flight", "--side", 700, "--count", 2, "--json", "-o", folder)
    assert json.loads(done.stdout) == {
        "folder": str(folder),
        "images": 2,
        "height": 700,
        "width": 700,
        "seed": 0,
    }
    poses = read_poses(folder / "poses.csv")
    camera = Camera.read(folder / "camera.toml")
    recording = Recording.of_files(folder / "map.tif", frame_files(poses, folder / "frames"), camera)
    assert recording.world.gsd_m == pytest.approx(0.5, abs=0.001)
    assert [recording.read(pose).shape for pose in recording.poses] == [(camera.height, camera.width, 3)] * 2
