"""What watches frames: gates, counts and events, against a count in Python of what passed."""

import random
from typing import Any

import pytest
from amaranth.sim import Simulator

from hdl_templates.frames import FrameControl

LONGEST = 8
"""Beats of a line."""

Beat = tuple[int, int]
"""TUSER, TLAST."""


def lines(*widths: int) -> list[Beat]:
    """The beats of a frame of such lines."""
    return [
        (int(number == x == 0), int(x == width - 1))
        for number, width in enumerate(widths)
        for x in range(width)
    ]


def run(beats: list[Beat], *, height: int, answers: list[Beat] = []) -> dict[str, int]:  # noqa: B006
    """What is counted of beats that come, and of others that go, with pauses."""
    dut = FrameControl(pixels=2, longest=LONGEST)
    draw = random.Random(0)
    found: dict[str, int] = {"faults": 0, "ends": 0}

    async def bench(ctx: Any) -> None:
        ctx.set(dut.aresetn, 1)
        ctx.set(dut.height, height)
        ctx.set(dut.enable, 1)
        left, going = beats[::-1], answers[::-1]
        offered, idle = False, 0
        while idle < 10:
            offered = bool(left) and (offered or draw.random() < 0.6)
            if offered:
                ctx.set(dut.s_tuser, left[-1][0])
                ctx.set(dut.s_tlast, left[-1][1])
            ready = draw.random() < 0.6
            ctx.set(dut.s_tvalid, offered)
            ctx.set(dut.s_tready, ready)
            # Answers go once all has come.
            gives = not left and bool(going) and draw.random() < 0.6
            if gives:
                ctx.set(dut.m_tuser, going[-1][0])
                ctx.set(dut.m_tlast, going[-1][1])
            ctx.set(dut.m_tvalid, gives)
            ctx.set(dut.m_tready, 1)
            if offered and ready and ctx.get(dut.passes):
                left.pop()
                offered = False
            if gives:
                going.pop()
            found["faults"] += ctx.get(dut.gone_wrong)
            found["ends"] += ctx.get(dut.answered)
            idle = 0 if left or going else idle + 1
            await ctx.tick()
        found.update(
            {name: ctx.get(getattr(dut, name)) for name in ("frames", "malformed", "width", "running")}
        )

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
    assert found["frames"] == found.pop("ends")
    assert found["malformed"] == found.pop("faults")
    return found


def test_whole_frames_are_counted_when_their_answers_have_gone() -> None:
    beats = lines(5, 5, 5) + lines(1, 1, 1)
    assert run(beats, height=3) == {"frames": 0, "malformed": 0, "width": 2, "running": 1}
    assert run(beats, height=3, answers=beats) == {"frames": 2, "malformed": 0, "width": 2, "running": 0}


@pytest.mark.parametrize(
    ("beats", "malformed"),
    [
        # A line is shorter or longer, once for each frame.
        (lines(5, 4, 5), 1),
        (lines(5, 6, 7), 1),
        # A frame is broken off inside a line, or has too few of them.
        (lines(5, 5)[:-1], 1),
        (lines(5, 5), 1),
        # A first line is longer than any can be.
        ([(1, 0), *[(0, 0)] * LONGEST, (0, 1)], 1),
        # Lines beyond the height do not count, nor does what no frame begins.
        (lines(5, 5, 5, 2), 0),
        ([(0, 0), (0, 1), (0, 0)], 0),
        (lines(8, 8, 8), 0),
    ],
)
def test_malformed_frames_are_counted(beats: list[Beat], malformed: int) -> None:
    after = lines(3, 3, 3)
    found = run(beats + after, height=3, answers=after)
    assert found == {"frames": 1, "malformed": malformed, "width": 6, "running": 0}


def test_4096_lines_are_a_height_of_0() -> None:
    beats = lines(*[1] * 4096)
    assert run(beats, height=0, answers=beats)["frames"] == 1


def test_any_mix_of_frames_is_counted_as_in_python() -> None:
    draw = random.Random(1)
    beats: list[Beat] = []
    malformed = 0
    for _ in range(60):
        widths = [draw.randint(1, LONGEST)] * 3
        if draw.random() < 0.5:
            widths[draw.randint(1, 2)] = draw.randint(1, LONGEST)
        frame = lines(*widths)
        kept = draw.choice([len(frame), draw.randint(1, len(frame))])
        beats += frame[:kept]
        malformed += len(set(widths)) > 1 or kept < len(frame)
    found = run(beats + lines(2, 2, 2), height=3)
    assert found["malformed"] == malformed
