"""The cocotb test of a video core's registers: `cocotbext.axi` on the bus, and the build's Python driver.

It knows nothing of the compiler: the file named by `FRAMES` holds the path of the driver, the name of its
class, and three frames: heights, the lines to be sent, and those that have to come, as `sim.stream_bench` has
them.
"""

import importlib.util
import json
import os
from pathlib import Path
from typing import Any

import cocotb
from cocotb.clock import Clock
from cocotb.task import bridge, resume
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from cocotbext.axi import (
    AxiLiteBus,
    AxiLiteMaster,
    AxiResp,
    AxiStreamBus,
    AxiStreamFrame,
    AxiStreamSink,
    AxiStreamSource,
)

from sim.stream_bench import _pauses

FRAMES = "WNN2HDL_FRAMES"
"""The environment variable that names the file of frames."""

_PERIOD_NS = 10
_LANES = 3
"""Bytes of a beat."""

_UNMAPPED, _VERSION, _HEIGHT = 0x100, 0x00, 0x18


class Bus:
    """What the driver reads and writes by: the bus, from the driver's own thread."""

    def __init__(self, master: AxiLiteMaster) -> None:
        self.master = master

    def read(self, offset: int) -> int:
        """A register."""
        return int(resume(self.master.read_dword)(offset))

    def write(self, offset: int, value: int) -> None:
        """Write a register."""
        resume(self.master.write_dword)(offset, value)


async def _set_up(dut: Any) -> tuple[AxiLiteMaster, AxiStreamSource, AxiStreamSink]:
    Clock(dut.aclk, _PERIOD_NS, "ns").start()
    ports = dut.aclk, dut.aresetn
    master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axi_control"), *ports, reset_active_level=False)
    source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis_video"), *ports, reset_active_level=False)
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis_video"), *ports, reset_active_level=False)
    channels = (
        source,
        sink,
        master.write_if.aw_channel,
        master.write_if.w_channel,
        master.write_if.b_channel,
        master.read_if.ar_channel,
        master.read_if.r_channel,
    )
    # Each pauses by itself, so address and data of a write come in any order.
    for number, channel in enumerate(channels):
        channel.set_pause_generator(_pauses(number))
    dut.aresetn.value = 0
    await ClockCycles(dut.aclk, 4)
    dut.aresetn.value = 1
    return master, source, sink


async def _send(source: AxiStreamSource, lines: list[Any]) -> None:
    for text, start in lines:
        pixels = bytes.fromhex(text)
        marks = [int(start and place < _LANES) for place in range(len(pixels))]
        await source.send(AxiStreamFrame(pixels, tuser=marks))


async def _receive(sink: AxiStreamSink, lines: list[Any]) -> None:
    for text, _ in lines:
        found = await with_timeout(sink.recv(), 1, "ms")
        assert bytes(found.tdata).hex() == text, f"{bytes(found.tdata).hex()} is not {text}"


@cocotb.test()
async def registers_control_frames(dut: Any) -> None:
    """Settings hold from the next frame on, events interrupt, frames are counted, and errors are answered."""
    data = json.loads(Path(os.environ[FRAMES]).read_text(encoding="utf-8"))
    specification = importlib.util.spec_from_file_location("driver", data["driver"])
    assert specification is not None
    assert specification.loader is not None
    driver = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(driver)
    master, source, sink = await _set_up(dut)

    # What is not there, and what can only be read.
    assert (await master.read(_UNMAPPED, 4)).resp == AxiResp.SLVERR
    assert (await master.write(_UNMAPPED, bytes(4))).resp == AxiResp.SLVERR
    assert (await master.write(_VERSION, bytes(4))).resp == AxiResp.SLVERR
    assert (await master.read(_VERSION, 4)).resp == AxiResp.OKAY
    # Bytes of a register are written one by one.
    assert (await master.write(_HEIGHT + 1, b"\x03")).resp == AxiResp.OKAY
    assert (await master.write(_HEIGHT, b"\x21")).resp == AxiResp.OKAY
    assert await master.read_dword(_HEIGHT) == 0x321

    first, second, third = data["frames"]
    core = await bridge(getattr(driver, data["class"]))(Bus(master))

    def configure() -> None:
        core.height = first["height"]
        core.interrupt_enable_frame = 1

    await bridge(configure)()
    await _send(source, first["sent"])
    await ClockCycles(dut.aclk, 100)
    assert sink.empty(), "a frame began before it was enabled"

    def change() -> int:
        core.control_enable = 1
        # The frame is so long that it is seen to run, and it keeps its height.
        assert any(core.status_running for _ in range(20))
        core.height = second["height"]
        return int(core.height)

    assert await bridge(change)() == second["height"]
    await _send(source, second["sent"])
    if not dut.irq.value:
        await with_timeout(RisingEdge(dut.irq), 1, "ms")
    await _receive(sink, first["expected"])
    await _receive(sink, second["expected"])
    await ClockCycles(dut.aclk, 20)

    def look() -> dict[str, int]:
        found = {name: getattr(core, name) for name in ("frames", "malformed", "width", "status_running")}
        assert core.interrupt_frame
        core.clear_interrupt_frame()
        return {**found, "left": core.interrupt_frame}

    width = len(bytes.fromhex(second["sent"][0][0])) // 3
    expected = {"frames": 2, "malformed": 0, "width": width, "status_running": 0, "left": 0}
    assert await bridge(look)() == expected
    assert not dut.irq.value

    # One that is not enabled waits.
    def enable(enabled: bool) -> None:
        core.control_enable = enabled

    await bridge(enable)(False)
    await _send(source, second["sent"])
    await ClockCycles(dut.aclk, 200)
    assert sink.empty(), "a frame began that was not enabled"
    await bridge(enable)(True)
    await _receive(sink, second["expected"])

    # A frame that another one breaks off, after a reset in the middle of one.
    def count_malformed() -> None:
        core.control_reset()
        core.interrupt_enable_malformed = 1
        core.height = third["height"]

    await _send(source, third["sent"][:1])
    await source.wait()
    await bridge(count_malformed)()
    await _send(source, [*third["sent"][:1], *third["sent"]])
    while True:
        found = await with_timeout(sink.recv(), 1, "ms")
        if bytes(found.tdata).hex() == third["expected"][-1][0]:
            break
    await ClockCycles(dut.aclk, 20)

    def faults() -> tuple[int, int, int]:
        core.clear_interrupt_frame()
        return core.frames, core.malformed, core.interrupt_malformed

    assert await bridge(faults)() == (1, 1, 1)
    assert dut.irq.value, "what is not cleared goes on interrupting"
