"""The cocotb test of a video core: lines through AXI4-Streams of `cocotbext.axi`, with pauses on both sides.

It knows nothing of the compiler: the file named by `LINES` holds the most lines of a frame, and the lines to
be sent and those that have to come, each as hexadecimal bytes and whether it is the first of a frame. None in
place of a line that is sent stands for a reset, before which all answers are awaited that come.
"""

import itertools
import json
import os
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, with_timeout
from cocotbext.axi import AxiStreamBus, AxiStreamFrame, AxiStreamSink, AxiStreamSource

LINES = "WNN2HDL_LINES"
"""The environment variable that names the file of lines."""

_PERIOD_NS = 10


def _pauses(seed: int) -> Iterator[bool]:
    """Bubbles one by one and long halts, half of the time."""
    draw = random.Random(seed)
    while True:
        yield from itertools.repeat(draw.random() < 0.5, draw.choice((1, 1, 1, 2, 20)))


@cocotb.test()
async def lines_equal_the_model(dut: Any) -> None:
    """What comes out are the lines of the model, each beat marked as in its frame, and no more."""
    data = json.loads(Path(os.environ[LINES]).read_text(encoding="utf-8"))
    Clock(dut.aclk, _PERIOD_NS, "ns").start()
    ports = dut.aclk, dut.aresetn
    source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis_video"), *ports, reset_active_level=False)
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis_video"), *ports, reset_active_level=False)
    lanes = len(dut.s_axis_video_tdata) // 8
    source.set_pause_generator(_pauses(1))
    sink.set_pause_generator(_pauses(2))
    dut.height.value = data["height"]

    async def reset() -> None:
        dut.aresetn.value = 0
        await ClockCycles(dut.aclk, 4)
        dut.aresetn.value = 1

    await reset()
    for line in data["sent"]:
        if line is None:
            await source.wait()
            await ClockCycles(dut.aclk, 200)
            await reset()
            continue
        text, start = line
        pixels = bytes.fromhex(text)
        marks = [int(start and place < lanes) for place in range(len(pixels))]
        await source.send(AxiStreamFrame(pixels, tuser=marks))
    for number, (text, start) in enumerate(data["expected"]):
        found = await with_timeout(sink.recv(compact=False), 1, "ms")
        width = len(dut.m_axis_video_tdata) // 8
        assert bytes(found.tdata).hex() == text, f"line {number}: {bytes(found.tdata).hex()} is not {text}"
        users = [int(mark) for mark in found.tuser][::width] if isinstance(found.tuser, list) else found.tuser
        assert users == [int(start), *[0] * (len(users) - 1)], f"line {number}: TUSER {users}"
    await ClockCycles(dut.aclk, 200)
    assert sink.empty(), "a line came that no frame has"
