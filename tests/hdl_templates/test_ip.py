# amaranth: UnusedElaboratable=no
"""Cores with registers: their Verilog is clean, though their parts answer each other."""

from pathlib import Path

import pytest

from hdl_templates.engine import MatchEngine
from hdl_templates.hierarchy import Part
from hdl_templates.ip import EngineIp, VideoIp
from hdl_templates.video import VideoCore
from tests.hdl_templates.test_engine import SMALL, Lane
from tests.sim.test_properties import Pixel, Window
from wnn2hdl.emit import verilog
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.registers import engine_registers, video_registers
from wnn2hdl.tools import lint_icarus, lint_verilator

DIGEST = "0123456789abcdef" * 4


def video_ip(video: VideoFormat) -> VideoIp:
    core = VideoCore(
        video=video,
        pixels=[Pixel() for _ in range(video.pixels_per_clock)],
        windows=[Window() for _ in range(video.pixels_per_clock if video.has_edges else 0)],
    )
    return VideoIp(core=core, registers=video_registers(DIGEST))


def engine_ip() -> EngineIp:
    core = MatchEngine(engine=SMALL, lane=lambda: Lane(SMALL.columns, 1))
    return EngineIp(core=core, registers=engine_registers(SMALL, DIGEST))


@pytest.mark.simulator
@pytest.mark.parametrize(
    "part",
    [
        video_ip(VideoFormat(max_width=16)),
        video_ip(VideoFormat(max_width=16, pixels_per_clock=4, square=4)),
        video_ip(VideoFormat(answer="class", pixels_per_clock=2)),
        engine_ip(),
    ],
    ids=["video", "squares", "classes", "engine"],
)
def test_simulators_read_the_verilog_without_a_warning(part: Part, tmp_path: Path) -> None:
    path = tmp_path / "core.v"
    path.write_text(verilog(part, prefix="my_", header=[]))
    assert lint_icarus([path], "my_ip", timeout=60) == []
    found = lint_verilator([path], "my_ip", timeout=60)
    # Carries of sums, and outputs of parts that not every core reads.
    assert [line for line in found if "UNUSEDSIGNAL" not in line and line.startswith("%")] == []


def test_all_streams_of_a_core_are_those_of_its_ip() -> None:
    ip = video_ip(VideoFormat(max_width=16, square=4))
    ports = set(ip.signature.members)
    assert set(ip.core.signature.members) - ports == {"height"}
    assert set(ip.port_attributes) == ports | {ip.clock}
    engine = engine_ip()
    assert {port for port in engine.core.signature.members if port not in engine.signature.members} == {
        f"m_axis_result_{name}" for name in ("tdata", "tvalid", "tready")
    }
    assert set(engine.port_attributes) == {*engine.signature.members, engine.clock}
