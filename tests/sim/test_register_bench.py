# amaranth: UnusedElaboratable=no
"""The registers of a video core by the bus and the driver of other projects, while frames run."""

import json
from pathlib import Path

import pytest

from hdl_templates.ip import VideoIp
from hdl_templates.video import VideoCore
from sim.register_bench import FRAMES
from sim.run import SimulatorName, run_test
from tests.sim.test_properties import Pixel, Window
from tests.sim.test_stream_bench import answered, frame, sent
from wnn2hdl.emit import driver_class, python_driver, verilog
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.registers import video_registers

pytestmark = pytest.mark.simulator

VIDEO = VideoFormat(max_width=16)


@pytest.fixture(scope="module")
def text() -> str:
    registers = video_registers("0123456789abcdef" * 4)
    core = VideoCore(video=VIDEO, pixels=[Pixel()], windows=[Window()])
    return verilog(VideoIp(core=core, registers=registers), prefix="bench_", header=[])


def run(text: str, simulator: SimulatorName, folder: Path) -> None:
    registers = video_registers("0123456789abcdef" * 4)
    (folder / "core.v").write_text(text, encoding="utf-8")
    (folder / "driver.py").write_text(python_driver(registers, "bench_ip"), encoding="utf-8")
    frames = [
        {"height": len(pixels), "sent": sent(VIDEO, pixels), "expected": answered(VIDEO, pixels)}
        for pixels in (frame(6, 16, 0), frame(8, 5, 1), frame(3, 9, 2))
    ]
    data = {"driver": str(folder / "driver.py"), "class": driver_class(registers), "frames": frames}
    (folder / "frames.json").write_text(json.dumps(data), encoding="utf-8")
    variables = {FRAMES: str(folder / "frames.json")}
    run_test("sim.register_bench", variables, "bench_ip", [folder / "core.v"], simulator, folder)


@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_registers_are_used_while_frames_run(text: str, simulator: SimulatorName, tmp_path: Path) -> None:
    run(text, simulator, tmp_path)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        # The height of a frame changes in its middle.
        ("if (takes_height) frame_height", "if (1'b1) frame_height"),
        # A frame begins without being enabled.
        ("may_begin <= enable &", "may_begin <="),
        # An address without a register is none.
        ("s_axi_control_rresp <= 2'h2", "s_axi_control_rresp <= 2'h0"),
        # Frames of a height are malformed.
        ("whole = runs & ~fault", "whole = runs & fault"),
    ],
)
def test_wrong_registers_are_found(text: str, right: str, wrong: str, tmp_path: Path) -> None:
    assert text.count(right) == 1
    with pytest.raises(AssertionError, match="differs from the model in icarus"):
        run(text.replace(right, wrong), "icarus", tmp_path)
