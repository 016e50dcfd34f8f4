# amaranth: UnusedElaboratable=no
"""Properties of video cores and of registers: they hold, and each is broken by a core that is wrong."""

from typing import get_args

import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out

from hdl_templates.axi_lite import AxiLiteRegisters
from hdl_templates.hierarchy import Part
from hdl_templates.video import VideoCore
from sim.properties import BusProperty, Property, bus_broken, first_broken
from wnn2hdl.emit import verilog
from wnn2hdl.ir import CENTRE, VideoFormat
from wnn2hdl.ir.registers import video_registers


class Pixel(Part):
    """The top bit of red is the class."""

    module_name = "pixel"

    def __init__(self) -> None:
        super().__init__({"rgb": In(24), "class_bits": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.class_bits.eq(self.rgb[-1])
        return m


class Window(Part):
    """The centre is the edge bit."""

    module_name = "window"

    def __init__(self) -> None:
        super().__init__({"bits": In(9), "edge_bit": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.edge_bit.eq(self.bits[CENTRE])
        return m


@pytest.fixture(scope="module")
def core() -> str:
    part = VideoCore(video=VideoFormat(max_width=4), pixels=[Pixel()], windows=[Window()])
    return verilog(part, prefix="formal_", header=[])


@pytest.mark.parametrize("name", get_args(Property))
def test_a_core_keeps_its_properties(core: str, name: Property) -> None:
    assert first_broken(core, name) is None


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        # A beat that waits is replaced by the next.
        ("stays", "~m_axis_video_tvalid | m_axis_video_tready", "1'b1"),
        # The second place of a line is read before it is written.
        ("in_order", "line_starts | line_goes_on | flush", "line_starts | flush"),
        # A beat that finds the register of pixels full is taken and lost.
        ("all_come", "~pixels_head_valid | taken", "1'b1"),
        # The repeated line has no end.
        ("goes_on", "(flush & ~done)", "flush"),
    ],
)
def test_each_property_is_broken_by_a_wrong_core(core: str, name: Property, right: str, wrong: str) -> None:
    assert core.count(right) == 1
    assert first_broken(core.replace(right, wrong), name) is not None


@pytest.fixture(scope="module")
def control() -> str:
    return verilog(AxiLiteRegisters(registers=video_registers("0" * 64)), prefix="formal_", header=[])


@pytest.mark.parametrize("name", get_args(BusProperty))
def test_registers_keep_the_rules_of_their_bus(control: str, name: BusProperty) -> None:
    assert bus_broken(control, name) is None


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        # An answer is withdrawn.
        ("stays", "else if (s_axi_control_bready) s_axi_control_bvalid", "else s_axi_control_bvalid"),
        # A read is taken while the answer to the one before waits.
        ("answers", "(~s_axi_control_rvalid | s_axi_control_rready)", "1'b1"),
        # An address behind the last register is none.
        ("refuses", "10'h00a", "10'h00b"),
        # No write is ever taken.
        ("goes_on", "s_axi_control_awvalid & s_axi_control_wvalid", "1'b0"),
        # An event is not noted, and one byte is not written.
        ("keeps", "& writes_interrupt)) | interrupt_frame;", "& writes_interrupt)) & interrupt_frame;"),
        ("keeps", "height <= term_", "height[7:0] <= term_"),
    ],
)
def test_each_rule_is_broken_by_wrong_registers(
    control: str, name: BusProperty, right: str, wrong: str
) -> None:
    text = control.replace("\n        ", " ")
    assert text.count(right) == 1
    assert bus_broken(text.replace(right, wrong), name) is not None
