"""`compile` as a user meets it; what it builds is tested beside `wnn2hdl.build.compile`."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.ir import WisardModel

Run = Callable[..., Any]


@pytest.fixture
def file(model: WisardModel, tmp_path: Path) -> Path:
    model.save(tmp_path / "model.json")
    return tmp_path / "model.json"


@pytest.mark.slow
def test_what_it_costs_is_a_table_or_one_json_object(run: Run, file: Path, tmp_path: Path) -> None:
    folder = tmp_path / "build"
    done = run("compile", file, "--target", "pixel", "-o", folder, "--json")
    assert done.status == 0, done.stderr
    assert json.loads(done.stdout) == json.loads((folder / "report.json").read_text())
    lines = run("compile", file, "--target", "pixel", "-o", folder).stdout.splitlines()
    assert lines[0].strip() == "build: pixel, exact mode"
    assert [line.split("│")[1].strip() for line in lines if line.startswith("│")] == ["pixel"]
    assert any(line.startswith("proof: proved in ") for line in lines)
    assert lines[-1] == f"written to {folder}"


@pytest.mark.slow
def test_a_circuit_that_is_too_large_is_written_and_fails(run: Run, file: Path, tmp_path: Path) -> None:
    done = run("compile", file, "--target", "pixel", "-o", tmp_path / "build", "--max-luts", 0)
    assert done.status == 1
    assert "the pixel takes more LUTs than allowed: " in done.stderr.splitlines()[-1]
    assert (tmp_path / "build" / "build.v").is_file()


def test_bad_usage_is_one_line_and_leaves_nothing(run: Run, file: Path, tmp_path: Path) -> None:
    def refused(*words: object) -> str:
        return str(run("compile", file, "-o", tmp_path / "build", *words).complaint())

    assert "domain mode needs" in refused("--mode", "domain")
    assert "go together: --test-images and --test-masks" in refused("--test-images", tmp_path)
    assert "--palette and --ignore are for masks" in refused("--palette", file)
    assert "'circle' is not one of" in refused("--target", "circle")
    assert "4 is not in the range" in refused("--edge-luts", 4)
    assert "circle" in refused("--edges", "circle")
    assert not (tmp_path / "build").exists()
