"""The command as a user meets it: output, exit statuses, one line an error."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from wnn2hdl.cli import main
from wnn2hdl.cli.main import app

COMMAND = [sys.executable, "-m", "wnn2hdl"]


def wnn2hdl(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *map(str, words)], capture_output=True, text=True, timeout=300, check=False
    )


def complaint(*words: object) -> str:
    """The one line on stderr of a command that must fail with status 2."""
    done = wnn2hdl(*words)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("wnn2hdl: ")
    return line


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


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (
            PermissionError(13, "Permission denied", "a/b"),
            "wnn2hdl: the system refused: Permission denied: a/b",
        ),
        (OSError("out of something"), "wnn2hdl: the system refused: out of something"),
    ],
)
def test_what_the_system_refuses_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: Exception, line: str
) -> None:
    def refused(**_: object) -> None:
        raise error

    monkeypatch.setattr(sys.modules["wnn2hdl.cli.main"], "app", refused)
    assert main() == 2
    assert capsys.readouterr() == ("", f"{line}\n")


def test_windows_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("platform.system", lambda: "Windows")
    monkeypatch.setattr(sys, "argv", ["wnn2hdl", "doctor"])
    assert main() == 2
    line = "wnn2hdl: Windows is not supported; run wnn2hdl on Linux or macOS, or in WSL\n"
    assert capsys.readouterr() == ("", line)


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
    while not list(tmp_path.glob(".build.*/build.v")):
        assert running.poll() is None, running.stderr
        time.sleep(0.05)
    time.sleep(1)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=60)
    assert running.returncode == 130, errors
    assert "Traceback" not in errors
    assert errors.splitlines()[-1] == "wnn2hdl: interrupted; no half-written file is left"
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
        [sys.executable, "-c", "import sys; sys.argv[0] = 'wnn2hdl'; from wnn2hdl.cli import main; main()"],
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
