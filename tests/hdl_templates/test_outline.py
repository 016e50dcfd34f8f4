# amaranth: UnusedElaboratable=no
"""What the outline of a core says is what the core is: its memories, widths and cycles."""

import re
from collections.abc import Callable

import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out

from hdl_templates.counting import Counting
from hdl_templates.hierarchy import Part
from hdl_templates.outline import steps_of
from hdl_templates.video import VideoCore
from tests.hdl_templates import test_counting, test_neighbours, test_squares, test_video
from tests.hdl_templates.test_engine import core as engine_core
from tests.hdl_templates.test_video import Beat, frame, run, sent
from wnn2hdl.emit import verilog
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.steps import Step
from wnn2hdl.report.pipeline import way

MEMORY = re.compile(r"reg (?:\[(\d+):0\] )?\w+ \[0:(\d+)\];")

CORES: dict[str, tuple[int, Callable[[], VideoCore]]] = {
    "edge": (1, lambda: test_video.core("edge")),
    "both": (2, lambda: test_video.core("both", classes=2, pixels=2)),
    "class": (4, lambda: test_video.core("class", pixels=4)),
    "stages": (1, lambda: test_video.core("both", latency=2)),
    "3x3": (1, lambda: test_neighbours.core(3, "both", latency=1)),
    "5x5": (1, lambda: test_neighbours.core(5, "edge")),
    "5x5, one pixel more": (2, lambda: test_neighbours.core(5, "both", pixels=2)),
    "squares": (1, lambda: test_squares.core("both", 4)),
    "squares, classes alone": (1, lambda: test_squares.core("class", 4)),
    "counts": (1, lambda: test_counting.core(test_counting.SHAPES["3 in 7"], "both")),
    "7x7": (4, lambda: test_neighbours.core(7, "class", pixels=4)),
}
"""By name: pixels of a beat, and what makes the core."""


@pytest.mark.parametrize("name", CORES)
def test_the_first_answer_of_a_frame_comes_when_the_steps_say(name: str) -> None:
    pixels, make = CORES[name]
    core = make()
    every = steps_of(core)
    assert len({step.name for step in every}) == len(every)
    steps = way(every)
    width = core.places * pixels
    lines, beats, cycles = (sum(getattr(step, key) for step in steps) for key in ("lines", "beats", "cycles"))
    later = lines * core.places + beats + cycles
    if isinstance(core.neighbours, Counting):
        # What counts holds up the end of the line that the edges wait for.
        later += core.neighbours.size // 2
    given = sent(frame(16, width, 0), pixels)
    # After a cycle of reset, the first beat is taken; what is given in the last cycle counts.
    squares: list[Beat] | None = [] if "squares" in name else None
    found, _ = run(make(), given, height=16, offers=1, takes=1, cycles=1 + later, squares=squares)
    assert found == []
    found, _ = run(make(), given, height=16, offers=1, takes=1, cycles=2 + later, squares=squares)
    assert len(found) == 1


class Parity(Part):
    """Stands for circuits whose Verilog is written by other means."""

    def __init__(self, latency: int, width: int = 1) -> None:
        self.module_name = f"parity_{width}"
        super().__init__({"bits": In(9 if width == 1 else 5), "parity": Out(width)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.parity.eq(self.bits.xor())
        return m


@pytest.mark.parametrize("name", [name for name in CORES if name not in ("stages", "3x3")])
def test_memories_are_those_of_the_verilog(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for tests in (test_video, test_neighbours, test_squares, test_counting):
        monkeypatch.setattr(tests, "Window", Parity)
    monkeypatch.setattr(test_neighbours, "Decision", Parity)
    core = CORES[name][1]()
    assert _written(verilog(core, prefix="x_", header=[])) == _stated(steps_of(core))
    first, *_, last = steps_of(core)
    assert first.bits == len(core.s_axis_video_tdata)
    assert last.bits == len(core.m_axis_video_tdata)


@pytest.mark.parametrize(
    "engine", [EngineFormat((4, 6), (9, 12), 4, 3), EngineFormat((9, 8), (80, 90), 1, 8)]
)
def test_memories_of_an_engine_are_those_of_the_verilog(engine: EngineFormat) -> None:
    core = engine_core(engine)
    for lane in core.lanes:
        lane.clock = "aclk"
    steps = steps_of(core)
    assert _written(verilog(core, prefix="x_", header=[])) == _stated(steps)
    lanes = next(step for step in steps if step.name == "lanes")
    assert (lanes.count, lanes.cycles, lanes.part) == (engine.lanes, 1, "lane")


def test_other_parts_have_no_steps() -> None:
    assert steps_of(test_video.Window(0)) == ()


def _written(text: str) -> list[tuple[int, int]]:
    """Words and bits of each memory in a Verilog text."""
    return sorted((1 + int(last), 1 + int(high or 0)) for high, last in MEMORY.findall(text))


def _stated(steps: tuple[Step, ...]) -> list[tuple[int, int]]:
    return sorted((step.words, step.word_bits) for step in steps if step.words)
