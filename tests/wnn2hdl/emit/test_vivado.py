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
    circuit_scripts,
    core_scripts,
)
from wnn2hdl.errors import ToolError
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.registers import engine_registers, video_registers
from wnn2hdl.synth import Ports
from wnn2hdl.tools import run

STUBS = Path(__file__).with_name("vivado_stubs.tcl")
DIGEST = "0123456789abcdef" * 4
CORE = Ports(
    {"aresetn": 1, "s_axis_video_tdata": 48, "s_axis_video_tvalid": 1, "m_axis_video_tready": 1},
    {"m_axis_video_tdata": 16, "irq": 1},
    clock="aclk",
)
PINS = ["aclk", "aresetn", "irq", "s_axis_video", "m_axis_video", "s_axi_control"]

needs_tcl = pytest.mark.skipif(shutil.which("tclsh") is None, reason="needs tclsh")


def write(folder: Path, texts: Mapping[str, str]) -> None:
    for name, text in {**texts, "mine.v": "", "mine_registers.v": ""}.items():
        (folder / name).write_text(text)


def block_scripts() -> Mapping[str, str]:
    return circuit_scripts("mine_block", source="mine.v", harness="mine_registers", megahertz=200)


def video_scripts() -> Mapping[str, str]:
    return core_scripts("mine_ip", CORE, video_registers(DIGEST), source="mine.v", megahertz=148.5)


def calls(script: Path, *pins: str) -> str:
    return run(["tclsh", STUBS, script, *pins], timeout=60).output


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
    write(tmp_path, video_scripts())
    shown = calls(tmp_path / IMPLEMENT, *PINS)
    assert "-top mine_ip" in shown
    assert "CALL create_clock {-name aclk -period 6.734} aclk" in shown
    shown = calls(tmp_path / BLOCK_DESIGN, *PINS)
    assert "-vlnv wnn2hdl:user:mine_ip:1.0" in shown
    assert "CONFIG.c_m_axis_mm2s_tdata_width 48" in shown
    assert "PCW_FPGA0_PERIPHERAL_FREQMHZ 148.5" in shown


@needs_tcl
def test_squares_go_to_memory_by_a_vdma_of_their_own(tmp_path: Path) -> None:
    ports = Ports(CORE.inputs, {**CORE.outputs, "m_axis_squares_tdata": 8}, clock="aclk")
    registers = video_registers(DIGEST)
    write(tmp_path, core_scripts("mine_ip", ports, registers, source="mine.v", megahertz=148.5))
    shown = calls(tmp_path / BLOCK_DESIGN, *PINS, "m_axis_squares")
    assert "CALL connect_bd_intf_net {} {core/m_axis_squares squares/S_AXIS_S2MM}" in shown
    assert "CALL connect_bd_net {} {squares/s2mm_introut interrupts/In3}" in shown
    assert "squares" not in video_scripts()[BLOCK_DESIGN]


@needs_tcl
def test_the_package_has_all_registers_with_their_fields(tmp_path: Path) -> None:
    write(tmp_path, video_scripts())
    shown = calls(tmp_path / PACKAGE, *PINS)
    registers = video_registers(DIGEST)
    for register in registers.registers:
        assert f"CALL ipx::add_register {{}} {{{register.name.upper()} ipx::add_address_block}}" in shown
        assert f"CALL set_property {{}} {{address_offset 0x{register.offset:03x} ipx::add_register}}" in shown
    assert shown.count("CALL ipx::add_field") == len(list(registers))
    assert "{modified_write_value oneToClear ipx::add_field}" in shown


def test_only_a_video_core_gets_a_block_design() -> None:
    engine = EngineFormat((4, 6), (9, 12), 4, 3)
    ports = Ports({"s_axis_segment_tdata": 32}, {}, clock="aclk")
    scripts = core_scripts(
        "mine_ip", ports, engine_registers(engine, DIGEST), source="mine.v", megahertz=100.0
    )
    assert set(scripts) == {CONSTRAINTS, IMPLEMENT, PACKAGE}


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


@needs_tcl
@pytest.mark.parametrize(
    ("script", "right", "wrong", "fault"),
    [
        (BLOCK_DESIGN, "core/irq", "core/interrupt", "core has no interrupt"),
        (BLOCK_DESIGN, "vdma/s2mm_introut", "vdma/s2mm_irq", "vdma has no s2mm_irq"),
        (BLOCK_DESIGN, "CONFIG.NUM_PORTS", "CONFIG.PORTS", "interrupts has no CONFIG.PORTS"),
        (BLOCK_DESIGN, "CONFIG.c_num_fstores", "CONFIG.c_frames", "vdma has no CONFIG.c_frames"),
        (BLOCK_DESIGN, "ip:xlconcat", "ip:concat", "there is no IP xilinx.com:ip:concat"),
        (BLOCK_DESIGN, "[get_bd_cells vdma]", "[get_bd_cells dma]", "there is no cell dma"),
        (PACKAGE, "address_offset", "offset_address", "no property offset_address"),
        (PACKAGE, "oneToClear", "clearOnOne", "modified_write_value cannot be clearOnOne"),
        (PACKAGE, "get_bus_interfaces s_axi_control", "get_bus_interfaces s_axi", "no interface s_axi"),
        (CONSTRAINTS, "get_ports aclk", "get_ports clk", "there is no port clk"),
    ],
)
def test_the_stubs_see_names_that_do_not_exist(
    script: str, right: str, wrong: str, fault: str, tmp_path: Path
) -> None:
    scripts = dict(video_scripts())
    assert right in scripts[script]
    scripts[script] = scripts[script].replace(right, wrong)
    write(tmp_path, scripts)
    with pytest.raises(ToolError) as error:
        calls(tmp_path / (IMPLEMENT if script == CONSTRAINTS else script), *PINS)
    assert fault in error.value.output
