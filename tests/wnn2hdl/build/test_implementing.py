"""Builds in Vivado: scripts that fit the Verilog, and the reading of what a Vivado reported."""

import os
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.wnn2hdl.conftest import silent
from tests.wnn2hdl.synth.test_vivado_reports import TIMING, UTILISATION_2023
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.implementing import implement, write_vivado
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.emit.vivado import BLOCK_DESIGN, CONSTRAINTS, IMPLEMENT, PACKAGE
from wnn2hdl.errors import ToolError
from wnn2hdl.ir import WisardModel
from wnn2hdl.report import load_report
from wnn2hdl.tools import run
from wnn2hdl.verify.equivalence import Circuit, structure

STUBS = Path(__file__).parents[1] / "emit" / "vivado_stubs.tcl"

pytestmark = pytest.mark.slow


@pytest.fixture
def changeable(pixel_build: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pixel_build, tmp_path / "pixel"))


@pytest.fixture
def fake_vivado(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program that leaves two reports where the script has them, as Vivado would."""
    program = tmp_path / "bin" / "vivado"
    program.parent.mkdir()
    program.write_text(
        f"#!{sys.executable}\n"
        "import pathlib, sys\n"
        "assert sys.argv[1:3] == ['-mode', 'batch'], sys.argv\n"
        "assert pathlib.Path(sys.argv[-1]).is_file()\n"
        f"pathlib.Path('utilization.rpt').write_text({UTILISATION_2023!r})\n"
        f"pathlib.Path('timing.rpt').write_text({TIMING!r})\n"
    )
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}{os.pathsep}{os.environ['PATH']}")
    return program


def ports(texts: tuple[str, ...], top: str) -> dict[str, Any]:
    found: dict[str, Any] = structure(Circuit(texts, top), [], timeout=60)
    return found


@pytest.mark.skipif(shutil.which("tclsh") is None, reason="needs tclsh")
def test_scripts_of_a_core_name_ports_and_streams_that_it_has(
    model: WisardModel, imagery: Path, tmp_path: Path
) -> None:
    options = CompileOptions(target="video", mode="domain", care=imagery, max_width=64)
    assert compile_model(model, tmp_path / "core", options, silent).failure is None
    files = {file.name for file in write_vivado(tmp_path / "core", tmp_path / "out")}
    assert files == {"core.v", CONSTRAINTS, IMPLEMENT, PACKAGE, BLOCK_DESIGN}
    module = ports(((tmp_path / "out" / "core.v").read_text(),), "core_ip")
    marked = {
        port: net["attributes"]["X_INTERFACE_INFO"].split()
        for port, net in module["netnames"].items()
        if port in module["ports"]
    }
    for port, (_, group, signal) in marked.items():
        assert port in (f"{group}_{signal.lower()}", group)
    kinds = {group: kind for kind, group, _ in marked.values()}
    axis = "xilinx.com:interface:axis:1.0"
    assert kinds == {
        "aclk": "xilinx.com:signal:clock:1.0",
        "aresetn": "xilinx.com:signal:reset:1.0",
        "irq": "xilinx.com:signal:interrupt:1.0",
        "s_axis_video": axis,
        "m_axis_video": axis,
        "s_axi_control": "xilinx.com:interface:aximm:1.0",
    }
    for stream in ("s_axis_video", "m_axis_video"):
        assert {signal for _, group, signal in marked.values() if group == stream} == {
            "TDATA",
            "TVALID",
            "TREADY",
            "TUSER",
            "TLAST",
        }
    parameters = module["netnames"]["aclk"]["attributes"]["X_INTERFACE_PARAMETER"]
    assert parameters == "ASSOCIATED_BUSIF s_axis_video:m_axis_video:s_axi_control, ASSOCIATED_RESET aresetn"
    # The scripts may name no other pins and interfaces than these.
    for script in (IMPLEMENT, PACKAGE, BLOCK_DESIGN):
        run(["tclsh", STUBS, tmp_path / "out" / script, *kinds], timeout=60)


def test_a_pixel_is_implemented_between_registers(changeable: Path, tmp_path: Path) -> None:
    write_vivado(changeable, tmp_path / "out")
    texts = tuple((tmp_path / "out" / name).read_text() for name in ("pixel_registers.v", "pixel.v"))
    assert set(ports(texts, "pixel_registers")["ports"]) == {"clk", "rgb", "class_bits"}
    assert "-top pixel_registers" in (tmp_path / "out" / IMPLEMENT).read_text()
    assert not (tmp_path / "out" / BLOCK_DESIGN).exists()


def test_what_vivado_reports_joins_the_report(changeable: Path, fake_vivado: Path, tmp_path: Path) -> None:
    figures = implement(changeable, tmp_path / "out", silent)
    assert (figures["luts"], figures["fmax_mhz"], figures["version"]) == (61, 400.0, "2023.1")
    assert load_report(changeable / "report.json")["vivado"] == figures
    assert check_manifest(changeable) == []
    assert "400.0 MHz" in (changeable / "report.md").read_text()
    assert "Vivado 2023.1" in (changeable / "report.html").read_text()


def test_a_vivado_that_fails_leaves_the_report_as_it_is(
    changeable: Path, fake_vivado: Path, tmp_path: Path
) -> None:
    fake_vivado.write_text(f"#!{sys.executable}\nprint('ERROR: [Common 17-345] no license')\n")
    with pytest.raises(ToolError, match=r"ERROR: .Common 17-345. no license"):
        implement(changeable, tmp_path / "out", silent)
    assert "vivado" not in load_report(changeable / "report.json")


def test_without_vivado_the_scripts_are_named(
    changeable: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wnn2hdl.tools.vivado.shutil.which", lambda _: None)
    with pytest.raises(ToolError, match=r"vivado is not on the PATH; .*--scripts"):
        implement(changeable, tmp_path / "out", silent)
    assert not (tmp_path / "out").exists()
