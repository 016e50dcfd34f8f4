"""Commands that are stopped, or find no room: one line, a status, nothing half-written."""

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

WNN2HDL = (sys.executable, "-m", "wnn2hdl")


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A model of embedded landscapes."""
    path = tmp_path_factory.mktemp("model") / "model.json"
    assert end(start("train", "-o", path))[0] == 0
    return path


def start(*words: object, stdout: int = subprocess.DEVNULL, limit: int = 0) -> "subprocess.Popen[str]":
    """A command in its own process, in whose files are ``limit`` bytes at most."""
    limits = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (limit, limit)) if limit else None
    return subprocess.Popen(
        [*WNN2HDL, *map(str, words)],
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=limits,
    )


def end(process: "subprocess.Popen[str]") -> tuple[int, str]:
    """The status of a process when it has ended, and the last line of its standard error."""
    _, errors = process.communicate(timeout=240)
    assert "Traceback" not in errors
    return process.returncode, errors.splitlines()[-1] if errors else ""


def until(condition: Callable[[], bool]) -> None:
    """Wait for something that another process does."""
    while not condition():
        time.sleep(0.01)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_stopped_compile_leaves_nothing(model: Path, tmp_path: Path, number: signal.Signals) -> None:
    process = start("compile", model, "-o", tmp_path / "build")
    until((tmp_path / ".build.new" / "design.json").exists)
    process.send_signal(number)
    status, line = end(process)
    assert status == 128 + number
    assert line.endswith("no half-written file is left")
    assert not [*tmp_path.iterdir()]


@pytest.mark.slow
def test_the_second_of_two_processes_is_refused(model: Path, tmp_path: Path) -> None:
    first = start("compile", model, "--target", "pixel", "-o", tmp_path / "build")
    until((tmp_path / ".build.new").exists)
    # It might be done before the second one looks.
    first.send_signal(signal.SIGSTOP)
    status, line = end(start("compile", model, "--target", "pixel", "-o", tmp_path / "build"))
    first.send_signal(signal.SIGCONT)
    assert (status, line.split(":")[1]) == (2, " another process is writing this build")
    assert end(first)[0] == 0
    assert [path.name for path in tmp_path.iterdir()] == ["build"]
    assert end(start("verify", tmp_path / "build"))[0] == 0


@pytest.mark.slow
@pytest.mark.parametrize("limit", [1_000, 4_000, 20_000])
def test_a_compile_without_room_leaves_nothing(model: Path, tmp_path: Path, limit: int) -> None:
    status, line = end(start("compile", model, "-o", tmp_path / "build", limit=limit))
    assert status == 2
    assert line.startswith("wnn2hdl: ")
    assert not [*tmp_path.iterdir()]


@pytest.mark.slow
def test_a_training_without_room_keeps_the_earlier_model(model: Path, tmp_path: Path) -> None:
    earlier = tmp_path / "model.json"
    earlier.write_bytes(model.read_bytes())
    status, line = end(start("train", "--seed", 1, "-o", earlier, limit=1_000))
    assert (status, line.partition(":")[2].split(":")[0]) == (2, " cannot write")
    assert [path.name for path in tmp_path.iterdir()] == ["model.json"]
    assert earlier.read_bytes() == model.read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("words", [("--version",), ("--help",), ("doctor", "--json")])
def test_what_cannot_be_printed_has_a_line_and_a_status(words: tuple[str, ...]) -> None:
    with Path("/dev/full").open("w") as full:
        status, line = end(start(*words, stdout=full.fileno()))
    assert (status, line) == (2, f"wnn2hdl: the system refused: {os.strerror(28)}")
