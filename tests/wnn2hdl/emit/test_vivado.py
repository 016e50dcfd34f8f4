"""Tcl for Vivado, run by a Tcl interpreter in which stubs stand for Vivado's commands."""

import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from wnn2hdl.emit.vivado import (
    BLOCK_DESIGN,
    CONSTRAINTS,
    IMPLEMENT,
    PACKAGE,
    vivado_scripts,
)
from wnn2hdl.errors import ToolError
from wnn2hdl.synth import Ports
from wnn2hdl.tools import run

STUBS = Path(__file__).with_name("vivado_stubs.tcl")
BLOCK = Ports({"window": 216}, {"edge": 1})
CORE = Ports(
    {
        "aresetn": 1,
        "height": 12,
        "s_axis_video_tdata": 48,
        "s_axis_video_tvalid": 1,
        "m_axis_video_tready": 1,
    },
    {"m_axis_video_tdata": 16},
    clock="aclk",
)

needs_tcl = pytest.mark.skipif(shutil.which("tclsh") is None, reason="needs tclsh")


def write(folder: Path, texts: Mapping[str, str]) -> None:
    for name, text in {**texts, "mine.v": "", "mine_registers.v": ""}.items():
        (folder / name).write_text(text)


def block_scripts() -> Mapping[str, str]:
    return vivado_scripts("mine_block", BLOCK, source="mine.v", harness="mine_registers", megahertz=200)


def core_scripts(ports: Ports = CORE) -> Mapping[str, str]:
    return vivado_scripts("mine_video", ports, source="mine.v", harness=None, megahertz=148.5)


def calls(script: Path) -> str:
    return run(["tclsh", STUBS, script], timeout=60).output


@needs_tcl
def test_a_circuit_is_implemented_with_registers_around_it(tmp_path: Path) -> None:
    scripts = block_scripts()
    assert set(scripts) == {CONSTRAINTS, IMPLEMENT, PACKAGE}
    write(tmp_path, scripts)
    shown = calls(tmp_path / IMPLEMENT)
    assert "CALL synth_design {-top mine_registers -part xc7z020clg484-1 -mode out_of_context} {}" in shown
    assert "CALL create_clock {-name clk -period 5.000} clk" in shown
    assert "mine_registers.v" in shown
    assert "set_property {} {top mine_block current_fileset}" in calls(tmp_path / PACKAGE)


@needs_tcl
def test_a_core_gets_a_block_design_with_its_widths(tmp_path: Path) -> None:
    write(tmp_path, core_scripts())
    assert "-top mine_video" in calls(tmp_path / IMPLEMENT)
    assert "CALL create_clock {-name aclk -period 6.734} aclk" in (calls(tmp_path / IMPLEMENT))
    shown = calls(tmp_path / BLOCK_DESIGN)
    assert "-vlnv wnn2hdl:user:mine_video:1.0" in shown
    assert "CONFIG.c_m_axis_mm2s_tdata_width 48" in shown
    assert "CONFIG.C_GPIO_WIDTH 12" in shown
    assert "PCW_FPGA0_PERIPHERAL_FREQMHZ 148.5" in shown


@needs_tcl
def test_a_core_without_a_height_gets_no_register_for_it(tmp_path: Path) -> None:
    inputs = {name: width for name, width in CORE.inputs.items() if name != "height"}
    write(tmp_path, core_scripts(Ports(inputs, CORE.outputs, clock="aclk")))
    assert "axi_gpio" not in calls(tmp_path / BLOCK_DESIGN)


@needs_tcl
@pytest.mark.parametrize(
    ("right", "wrong", "fault"),
    [
        ("opt_design", "optimise_design", "invalid command name"),
        ("-mode out_of_context\n", "-mood out_of_context\n", "no option -mood"),
        ("[file join $here mine.v]", "[file join $here theirs.v]", "theirs.v is missing"),
        ("-part xc7z020clg484-1 -mode out_of_context", "-mode out_of_context -part", "lacks its value"),
    ],
)
def test_the_stubs_see_what_is_wrong(right: str, wrong: str, fault: str, tmp_path: Path) -> None:
    scripts = dict(block_scripts())
    assert right in scripts[IMPLEMENT]
    scripts[IMPLEMENT] = scripts[IMPLEMENT].replace(right, wrong)
    write(tmp_path, scripts)
    with pytest.raises(ToolError) as error:
        calls(tmp_path / IMPLEMENT)
    assert re.search(fault, error.value.output)
