# amaranth: UnusedElaboratable=no
"""Match engines answer what is defined, in as many cycles as the formula says, with pauses on all sides."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from hdl_templates.engine import MatchEngine
from hdl_templates.hierarchy import Part
from hdl_templates.peaks import Peaks
from wnn2hdl.errors import CheckError
from wnn2hdl.ir.engine import EDGE_BIT, EngineFormat, Round, picture_words
from wnn2hdl.verify.engine import simulate_engine

SMALL = EngineFormat((4, 6), (9, 12), 4, 3)


class Lane(Part):
    """Counts pairs of equal bits some cycles later."""

    module_name = "lane"
    clocked = True

    def __init__(self, columns: int, latency: int, same: int = 1) -> None:
        self.columns, self.latency, self.same = columns, latency, same
        super().__init__({"pairs": In(2 * columns), "count": Out(columns.bit_length())})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        value = sum(self.pairs[2 * i : 2 * i + 2].xor() != self.same for i in range(self.columns))
        for _ in range(self.latency):
            later = Signal(len(self.count))
            m.d.sync += later.eq(value)
            value = later
        m.d.comb += self.count.eq(value)
        return m


def core(engine: EngineFormat, latency: int = 1) -> MatchEngine:
    return MatchEngine(engine=engine, lane=lambda: Lane(engine.columns, latency))


@pytest.mark.parametrize(
    ("engine", "latency"),
    [
        (replace(SMALL, lanes=1, columns=6), 1),
        (replace(SMALL, lanes=6, columns=2), 2),
        (SMALL, 3),
        (EngineFormat((2, 2), (3, 3), 2, 2), 1),
    ],
)
def test_an_engine_answers_with_the_definition_in_the_stated_cycles(
    engine: EngineFormat, latency: int
) -> None:
    assert simulate_engine(core(engine, latency), engine.sample_rounds()).vectors == 3


def test_a_lane_that_miscounts_is_noticed() -> None:
    dut = MatchEngine(engine=SMALL, lane=lambda: Lane(SMALL.columns, 1, same=0))
    with pytest.raises(CheckError, match="differs at match 0"):
        simulate_engine(dut, SMALL.sample_rounds())


def test_malformed_pictures_are_thrown_away() -> None:
    width = SMALL.template[1]
    good = SMALL.sample_rounds()[0]
    assert good.segment is not None
    words = picture_words(good.segment).tolist()
    pixels = good.template.ravel().tolist()
    # A segment that is too short, one that is too long, and a whole one.
    segments = [(words[0], 1), *((7, number == len(words)) for number in range(len(words) + 1))]
    segments += [(word, number == len(words) - 1) for number, word in enumerate(words)]
    # No start, a line that is too short, a frame that another one breaks off, and a whole one.
    templates = [(1, 0, 0), (1, 0, 1), (1, 1, 0), (1, 0, 1), (1, 0, 0), (1, 1, 0), (1, 0, 0)]
    templates += [(pixel, at == 0, at % width == width - 1) for at, pixel in enumerate(pixels)]
    found: list[int] = []
    dut = core(SMALL)

    async def bench(ctx: Any) -> None:
        ctx.set(dut.aresetn, 1)
        for _ in range(3000):
            ctx.set(dut.s_axis_segment_tvalid, bool(segments))
            ctx.set(dut.s_axis_template_tvalid, bool(templates))
            if segments:
                ctx.set(dut.s_axis_segment_tdata, segments[0][0])
                ctx.set(dut.s_axis_segment_tlast, segments[0][1])
            if templates:
                ctx.set(dut.s_axis_template_tdata, templates[0][0] << EDGE_BIT)
                ctx.set(dut.s_axis_template_tuser, templates[0][1])
                ctx.set(dut.s_axis_template_tlast, templates[0][2])
            ctx.set(dut.m_axis_result_tready, 1)
            if segments and ctx.get(dut.s_axis_segment_tready):
                segments.pop(0)
            if templates and ctx.get(dut.s_axis_template_tready):
                templates.pop(0)
            if ctx.get(dut.m_axis_result_tvalid):
                found.append(ctx.get(dut.m_axis_result_tdata))
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
    wanted = SMALL.answers([Round(good.segment, good.template)])[0].words
    assert found == [sum(word << 32 * place for place, word in enumerate(wanted))]


@pytest.mark.parametrize("levels", [2, 40])
def test_second_best_positions_are_those_of_cells_apart(levels: int) -> None:
    engine = EngineFormat((6, 8), (6 + 65, 8 + 69), 1, 8)
    draw = np.random.default_rng(levels)
    found: list[tuple[int, ...]] = []
    pictures = [draw.integers(0, levels, engine.positions) for _ in range(2)]
    dut = Peaks(engine=engine)

    async def bench(ctx: Any) -> None:
        for scores in pictures:
            for score in scores.ravel().tolist():
                ctx.set(dut.valid, 1)
                ctx.set(dut.score, score)
                await ctx.tick()
            ctx.set(dut.valid, 0)
            while not ctx.get(dut.done):
                await ctx.tick()
            found.append(tuple(ctx.get(port) for port in (dut.best, dut.second, dut.alone)))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(bench)
    simulator.run()
    for scores, (best, second, alone) in zip(pictures, found, strict=True):
        answer = engine.chosen(scores)
        rows, columns = dut.places
        assert (best & (1 << rows) - 1, best >> rows & (1 << columns) - 1) == answer.best
        assert best >> rows + columns == answer.score
        assert alone == (answer.second is None)
        if answer.second is not None:
            assert (second & (1 << rows) - 1, second >> rows & (1 << columns) - 1) == answer.second
            assert second >> rows + columns == answer.second_score
