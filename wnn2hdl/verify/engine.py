"""Simulation of a match engine: what it answers, and after how many cycles."""

import random
import time
from collections.abc import Sequence
from typing import Any

from amaranth.sim import Simulator

from hdl_templates.engine import MatchEngine
from wnn2hdl.errors import CheckError
from wnn2hdl.ir.engine import EDGE_BIT, WORD_BITS, Round, picture_words
from wnn2hdl.verify.simulation import SimulationResult

_SEED = 0
_PAUSES = 0.25
"""Share of cycles in which nothing is offered, and of those in which nothing is taken."""

_PERIOD = 10e-9


def simulate_engine(core: MatchEngine, rounds: Sequence[Round]) -> SimulationResult:
    """Send segments and templates with pauses, and compare results and cycles.

    A segment, and a template up to its last pixel, are sent while the match before runs.

    Args:
        core: the engine, as yet unused.
        rounds: the matches.

    Raises:
        CheckError: a result differs, does not come, or comes in another cycle than it should.
    """
    started = time.perf_counter()
    simulator = Simulator(core)
    simulator.add_clock(_PERIOD)
    simulator.add_testbench(_bench(core, rounds))
    simulator.run()
    return SimulationResult(len(rounds), time.perf_counter() - started)


def _bench(core: MatchEngine, rounds: Sequence[Round]) -> Any:
    draw = random.Random(_SEED)  # noqa: S311  # pauses, no secrets
    engine = core.engine
    cycles = engine.cycles(core.lanes[0].latency)
    wanted = [answer.words for answer in engine.answers(rounds)]
    width = engine.template[1]

    async def bench(ctx: Any) -> None:
        ctx.set(core.aresetn, 0)
        await ctx.tick()
        ctx.set(core.aresetn, 1)
        now = taken_at = received = 0
        for number in range(len(rounds) + 1):
            match = rounds[number] if number < len(rounds) else None
            words = [] if match is None or match.segment is None else picture_words(match.segment).tolist()
            pixels = [] if match is None else match.template.ravel().tolist()
            left, sent, settled, offered = words, 0, 0, [False, False]
            while True:
                if not offered[0] and left and draw.random() >= _PAUSES:
                    ctx.set(core.s_axis_segment_tdata, left[0])
                    ctx.set(core.s_axis_segment_tlast, len(left) == 1)
                    offered[0] = True
                # The last pixel waits for the result before, and until the segment is complete.
                held_back = sent == len(pixels) - 1 and (received < number or bool(left) or settled <= 40)
                if not offered[1] and sent < len(pixels) and not held_back and draw.random() >= _PAUSES:
                    # The other bits of a pixel do not matter.
                    ctx.set(core.s_axis_template_tdata, pixels[sent] << EDGE_BIT | draw.getrandbits(EDGE_BIT))
                    ctx.set(core.s_axis_template_tuser, sent == 0)
                    ctx.set(core.s_axis_template_tlast, sent % width == width - 1)
                    offered[1] = True
                ctx.set(core.s_axis_segment_tvalid, offered[0])
                ctx.set(core.s_axis_template_tvalid, offered[1])
                takes = draw.random() >= _PAUSES
                ctx.set(core.m_axis_result_tready, takes)
                given = ctx.get(core.m_axis_result_tvalid)
                if given and taken_at:
                    if now - taken_at != cycles:
                        raise CheckError(
                            "a match takes another number of cycles", value=f"{now - taken_at}, not {cycles}"
                        )
                    taken_at = 0
                if given and takes:
                    data = ctx.get(core.m_axis_result_tdata)
                    found = tuple(
                        data >> WORD_BITS * word & (1 << WORD_BITS) - 1 for word in range(len(wanted[0]))
                    )
                    if found != wanted[received]:
                        raise CheckError(
                            f"the match engine differs at match {received}",
                            value=f"{found}, expected {wanted[received]}",
                        )
                    received += 1
                if offered[0] and ctx.get(core.s_axis_segment_tready):
                    left, offered[0] = left[1:], False
                if offered[1] and ctx.get(core.s_axis_template_tready):
                    sent, offered[1] = sent + 1, False
                    if sent == len(pixels):
                        taken_at = now
                settled = 0 if left else settled + 1
                if taken_at and now - taken_at > cycles:
                    raise CheckError("the match engine does not answer", value=f"match {received}")
                now += 1
                await ctx.tick()
                if sent == len(pixels) and not left and (match is not None or received == number):
                    break

    return bench
