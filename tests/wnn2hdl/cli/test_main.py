"""The command as a user meets it: output, exit statuses, one line an error."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.shell_completion import BashComplete
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.cli import main  # noqa: F401  # importing it registers all commands
from wnn2hdl.cli.main import app

COMMAND = [sys.executable, "-c", "import sys; from wnn2hdl.cli import main; sys.exit(main())"]


def wnn2hdl(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *map(str, words)], capture_output=True, text=True, timeout=300, check=False
    )


def complaint(*words: object) -> str:
    """The one line on stderr of a command that must fail with status 2."""
    done = wnn2hdl(*words)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert "Traceback" not in done.stderr
    assert lines[-1].startswith("wnn2hdl: ")
    return lines[-1]


def save(path: Path, array: NDArray[np.generic]) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(array).save(path)


@pytest.fixture
def folders(tmp_path: Path) -> tuple[Path, Path]:
    """A picture and its mask, half and half."""
    rgb = np.zeros((8, 8, 3), dtype=np.uint8)
    rgb[:, 4:] = 200
    save(tmp_path / "images" / "a.png", rgb)
    save(tmp_path / "masks" / "a.png", rgb[..., 0])
    return tmp_path / "images", tmp_path / "masks"


def test_training_prints_one_json_object_and_nothing_else(folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    done = wnn2hdl(
        "train", "--images", images, "--masks", masks, "--bits", "R7,G7", "--address-bits", 2, "--rams", 1,
        "--json", "-o", tmp_path / "m.json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["bits"] == ["R7", "G7"]
    done = wnn2hdl("evaluate", tmp_path / "m.json", "--images", images, "--masks", masks, "--json")
    assert json.loads(done.stdout)["accuracy"] == 1.0
    assert json.loads(done.stdout)["images"] == 1


def test_more_classes_by_a_palette(folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    colours = np.zeros((8, 8, 3), dtype=np.uint8)
    colours[:, 2:4], colours[:, 4:] = (255, 0, 0), (0, 0, 255)
    save(masks / "a.png", colours)
    palette = tmp_path / "palette.json"
    palette.write_text(json.dumps({"forest": "#000000", "burnt": "#ff0000", "water": "#0000ff"}))
    model = tmp_path / "new" / "m.json"
    done = wnn2hdl(
        "train", "--images", images, "--masks", masks, "--palette", palette, "--bits", "R7,G7",
        "--address-bits", 2, "--rams", 1, "--json", "-o", model,
    )  # fmt: skip
    assert json.loads(done.stdout)["classes"] == ["forest", "burnt", "water"]
    assert "different classes" in complaint("evaluate", model, "--images", images, "--masks", masks)


def test_garbage_gets_one_line(folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    model = tmp_path / "m.json"

    def train(*words: object) -> str:
        return complaint("train", "-o", model, *words)

    empty = tmp_path / "empty"
    empty.mkdir()
    assert "empty" in train("--images", empty, "--masks", masks)
    assert "--images and --masks" in train("--images", images)
    assert "10 of 2" in train("--images", images, "--masks", masks, "--bits", "R7,G7", "--address-bits", 10)
    save(masks / "a.png", np.zeros((4, 4), dtype=np.uint8))
    assert "4x4" in train("--images", images, "--masks", masks)
    save(masks / "a.png", np.zeros((8, 8), dtype=np.uint8))
    assert "deforested" in train("--images", images, "--masks", masks)
    (images / "a.png").write_text("not a picture")
    assert "a.png" in train("--images", images, "--masks", masks)
    save(images / "a.png", np.zeros((8, 8), dtype=np.uint16))
    assert "16" in train("--images", images, "--masks", masks)
    assert "X9" in train("--images", images, "--masks", masks, "--bits", "X9")
    assert not model.exists()


def test_a_model_that_is_none_and_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    text = tmp_path / "m.json"
    text.write_text("hello")
    assert "not a model" in complaint("compile", text, "-o", tmp_path / "build")
    assert "No such file" in complaint("compile", tmp_path / "none.json", "-o", tmp_path / "build")
    assert "not a build folder" in complaint("verify", tmp_path)
    assert not (tmp_path / "build").exists()


def test_bad_usage_has_status_2() -> None:
    assert "No such option" in complaint("train", "--colour", "blue")
    assert "neither 'auto' nor a whole number" in complaint("train", "--bleach", "0", "-o", "m.json")
    assert "'4' is not one of" in complaint("train", "--neighbourhood", "4", "-o", "m.json")


def test_options_that_a_neighbourhood_has_no_use_for_are_refused(tmp_path: Path) -> None:
    train = ("train", "--neighbourhood", "3", "-o", tmp_path / "m.json")
    assert "--neighbourhood chooses the classifier itself: --rams" in complaint(*train, "--rams", "4")
    assert "leave --neighbourhood out" in complaint(*train, "--pareto")
    assert "takes 13 LUTs: 4 allowed" in complaint(*train, "--max-luts", "4")


@pytest.mark.slow
def test_ctrl_c_in_the_middle_leaves_nothing(tmp_path: Path) -> None:
    model = tmp_path / "m.json"
    assert wnn2hdl("train", "-o", model, "--bits", "R7,R6,G7,G6,B7,B6").returncode == 0
    running = subprocess.Popen(
        [*COMMAND, "compile", str(model), "-o", str(tmp_path / "build")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={"PATH": "/usr/bin:/bin", "WNN2HDL_CACHE": str(tmp_path / "cache"), "HOME": str(tmp_path)},
    )
    while not list(tmp_path.glob(".build.*/block.v")):
        assert running.poll() is None, running.stderr
        time.sleep(0.05)
    time.sleep(1)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=60)
    assert running.returncode == 130, errors
    assert "Traceback" not in errors
    assert errors.splitlines()[-1] == "wnn2hdl: interrupted; nothing half-written was left"
    assert {path.name for path in tmp_path.iterdir()} <= {"m.json", "cache", ".cache"}


def test_the_version_names_the_tools_that_decide_the_output() -> None:
    printed = wnn2hdl("--version").stdout
    assert printed.startswith("wnn2hdl ")
    assert all(tool in printed for tool in ("amaranth ", "pyosys ", "pyeda "))


def test_the_shell_completes_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_WNN2HDL_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", "wnn2hdl com")
    monkeypatch.setenv("COMP_CWORD", "1")
    done = subprocess.run(
        [sys.executable, "-c", COMMAND[2].replace("import sys;", "import sys; sys.argv[0] = 'wnn2hdl';")],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert "compile" in done.stdout


@pytest.mark.parametrize(
    ("before", "begun", "offered"),
    [([], "sc", ["scan"]), (["compile"], "--mod", ["--mode"]), (["compile", "--mode"], "d", ["domain"])],
)
def test_the_tab_key_completes(before: list[str], begun: str, offered: list[str]) -> None:
    completion = BashComplete(app, {}, "wnn2hdl", "_WNN2HDL_COMPLETE")
    assert [item.value for item in completion.get_completions(before, begun)] == offered
