"""What `demo` prints; that every stage runs is tested beside `wnn2hdl.apps.demo`."""

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner, Result

from wnn2hdl.build.reporting import read_report
from wnn2hdl.cli.demo import demo_command
from wnn2hdl.errors import CheckError

Run = Callable[..., Result]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, write_build: Callable[..., Path], tmp_path: Path) -> Run:
    """``run(*words, failure=None)``: the command, as after a demo on a machine without the extra ``geo``."""

    def call(*words: str, failure: str | None = None) -> Result:
        builds = {}
        for name in ("reference", "smallest"):
            folder = write_build(tmp_path / name)
            builds[name] = SimpleNamespace(folder=folder, report=read_report(folder), failure=None)
        builds["smallest"].failure = failure
        made = SimpleNamespace(
            **builds,
            page=tmp_path / "index.html",
            outcome=SimpleNamespace(plan=range(80), to_json=lambda: {"trials": 80}),
            windows=64_516,
            scan=None,
            flight=None,
            missing="pyproj is missing; install it with: pip install 'wnn2hdl[geo]'",
        )
        monkeypatch.setattr("wnn2hdl.apps.demo.run_demo", lambda *_: made)
        return CliRunner().invoke(demo_command, list(words))

    return call


def test_it_says_what_the_circuits_are_and_ends_with_the_page(run: Run, tmp_path: Path) -> None:
    lines = run().stdout.splitlines()
    assert lines[1].startswith("reference: the reference design's discriminators (n = 4, k = 16)")
    assert lines[2].startswith("smallest: the most accurate classifier of one LUT per pixel")
    assert lines[-1] == f"Open {(tmp_path / 'index.html').as_uri()}"
    assert any(line.startswith("map and flight were left out: ") and "[geo]" in line for line in lines)


def test_json_is_one_object(run: Run, tmp_path: Path) -> None:
    data: dict[str, Any] = json.loads(run("--json").stdout)
    assert data["page"] == str(tmp_path / "index.html")
    assert data["smallest"]["name"] == "smallest"
    assert (data["scan"], data["flight"], data["sweep"]) == (None, None, {"trials": 80})


def test_a_circuit_that_is_not_its_model_fails_the_demo(run: Run) -> None:
    done = run(failure="the Verilog of the pixel differs from the model at code 3")
    assert isinstance(done.exception, CheckError)
    assert "at code 3" in done.exception.line()
    assert "Open file://" in done.stdout
