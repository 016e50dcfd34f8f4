"""What watches matches: gates, counts and events of templates and segments, and when a result is taken."""

from typing import Any

import pytest
from amaranth.sim import Simulator

from hdl_templates.matches import MatchControl
from wnn2hdl.ir.engine import EngineFormat

ENGINE = EngineFormat((2, 3), (5, 8), 2, 3)
WORDS = ENGINE.segment_words


def run(templates: list[tuple[int, int]], segments: list[int], *, enable: int = 1) -> dict[str, int]:
    """What is known after beats of templates (TUSER, TLAST), and of segments (TLAST)."""
    dut = MatchControl(engine=ENGINE)
    found: dict[str, int] = {}

    async def bench(ctx: Any) -> None:
        ctx.set(dut.aresetn, 1)
        ctx.set(dut.enable, enable)
        for port in (dut.template_tready, dut.segment_tready):
            ctx.set(port, 1)
        for number in range(max(len(templates), len(segments)) + 3):
            ctx.set(dut.template_tvalid, number < len(templates))
            ctx.set(dut.segment_tvalid, number < len(segments))
            if number < len(templates):
                ctx.set(dut.template_tuser, templates[number][0])
                ctx.set(dut.template_tlast, templates[number][1])
                found.setdefault("passes", ctx.get(dut.passes))
            if number < len(segments):
                ctx.set(dut.segment_tlast, segments[number])
            await ctx.tick()
        for name in ("running", "has_segment", "malformed"):
            found[name] = ctx.get(getattr(dut, name))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
    found.pop("passes", None)
    return found


TEMPLATE = [(1, 0), (0, 0), (0, 1), (0, 0), (0, 0), (0, 1)]
SEGMENT = [*[0] * (WORDS - 1), 1]


def test_a_template_and_a_segment_of_the_right_sizes_are_noted() -> None:
    assert run(TEMPLATE, []) == {"running": 1, "has_segment": 0, "malformed": 0}
    assert run([], SEGMENT) == {"running": 0, "has_segment": 1, "malformed": 0}


def test_a_template_waits_until_it_is_enabled() -> None:
    assert run(TEMPLATE[:1] * 6, [], enable=0) == {"running": 0, "has_segment": 0, "malformed": 0}


@pytest.mark.parametrize(
    ("templates", "segments"),
    [
        # Lines that are all too short or too long, and a template that another one breaks off.
        ([(1, 0), (0, 1), (0, 0), (0, 1)], []),
        ([(1, 0), (0, 0), (0, 0), (0, 1)], []),
        (TEMPLATE[:4] + TEMPLATE[:1], []),
        # Segments that are too short and too long.
        ([], SEGMENT[1:]),
        ([], [0, *SEGMENT]),
        ([], [0] * 2 * WORDS + [1]),
    ],
)
def test_other_sizes_are_malformed_once(templates: list[tuple[int, int]], segments: list[int]) -> None:
    assert run(templates, segments) == {"running": 0, "has_segment": 0, "malformed": 1}


def test_a_result_is_taken_once_its_event_was_cleared() -> None:
    dut = MatchControl(engine=ENGINE)

    async def bench(ctx: Any) -> None:
        ctx.set(dut.aresetn, 1)
        ctx.set(dut.result_tvalid, 1)
        assert ctx.get(dut.ended)
        assert not ctx.get(dut.result_tready)
        await ctx.tick()
        # The event is noted, and waits.
        ctx.set(dut.waits, 1)
        for _ in range(3):
            assert not ctx.get(dut.ended)
            assert not ctx.get(dut.result_tready)
            await ctx.tick()
        ctx.set(dut.waits, 0)
        assert ctx.get(dut.result_tready)
        assert ctx.get(dut.results) == 1

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
