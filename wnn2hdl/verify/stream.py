"""Simulation of a video core in Amaranth's simulator, compared beat by beat."""

import random
import re
import tempfile
import time
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from amaranth.sim import Simulator

from hdl_templates.video import VideoCore
from wnn2hdl.emit.stream_testbench import stream_testbench, stream_vectors
from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir.registers import RegisterMap
from wnn2hdl.ir.video import HEIGHT_BITS, Beats, VideoFormat
from wnn2hdl.verify.compiled import RUN, CompiledSimulator
from wnn2hdl.verify.simulation import Progress, SimulationResult, recorded

_SEED = 0
_PAUSES = 0.25
"""Share of cycles in which nothing is offered, and of those in which nothing is taken."""

_PATIENCE = 1 << 14
"""Cycles without a beat that show a core that is stuck: longer than two lines take."""

_REPORT_EVERY = 1024
_PERIOD = 10e-9


def simulate_stream(
    core: VideoCore, beats: Beats, *, progress: Progress | None = None, vcd: Path | None = None
) -> SimulationResult:
    """Send frames through a video core with pauses on both sides, and compare each beat that comes out.

    Args:
        core: the core, as yet unused.
        beats: the frames.
        progress: called now and then.
        vcd: where to record the waves, 10 ns a cycle.

    Raises:
        CheckError: an answer differs, comes with other marks, or does not come.
        InputError: the waves cannot be written.
    """
    started = time.perf_counter()
    simulator = Simulator(core)
    simulator.add_clock(_PERIOD)
    with recorded(simulator, vcd) if vcd else nullcontext():
        simulator.add_testbench(_bench(core, beats, progress))
        simulator.run()
    return SimulationResult(len(beats), time.perf_counter() - started)


def run_stream(
    beats: Beats,
    video: VideoFormat,
    registers: RegisterMap,
    module: str,
    sources: Sequence[Path],
    simulator: CompiledSimulator,
    *,
    timeout: float = 600.0,
) -> float:
    """Send frames through emitted Verilog, as `simulate_stream` does, in a compiled simulator.

    Args:
        beats: the frames.
        video: the core's streams.
        registers: the core's.
        module: of the core with its registers.
        sources: its Verilog files.
        simulator: who simulates.
        timeout: seconds for compiling and for running, each.

    Returns:
        Seconds of the run itself, without compiling.

    Raises:
        CheckError: an answer differs, comes with other marks, or does not come.
        ToolError: the simulator is missing, cannot read the sources, failed or ran out of time.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        (folder / "beats.hex").write_text(stream_vectors(beats, video), encoding="utf-8")
        bench = folder / f"{module}_tb.v"
        text = stream_testbench(
            name=module,
            video=video,
            beats=beats,
            registers=registers,
            vectors_file="beats.hex",
            sources=[source.name for source in sources],
        )
        bench.write_text(text, encoding="utf-8")
        try:
            return RUN[simulator]([*sources, bench], bench.stem, cwd=folder, timeout=timeout).seconds
        except ToolError as error:
            failure = re.search(r"^FAIL: .*", error.output, re.MULTILINE)
            if failure is None:
                raise
            raise CheckError(f"{simulator} disagrees", value=failure.group()) from error


def _bench(core: VideoCore, beats: Beats, progress: Progress | None) -> Any:
    draw = random.Random(_SEED)  # noqa: S311  # pauses, no secrets
    marks = beats.starts.tolist(), beats.ends.tolist()
    sent = list(zip(beats.sent(core.video.pixel_bits), *marks, strict=True))
    wanted = list(zip(beats.expected(), *marks, strict=True))
    votes = beats.voted()

    async def bench(ctx: Any) -> None:
        ctx.set(core.aresetn, 0)
        if core.has_lines:
            ctx.set(core.height, beats.height % (1 << HEIGHT_BITS))
        await ctx.tick()
        ctx.set(core.aresetn, 1)
        sending = received = voted = idle = 0
        offered = False
        while received < len(wanted) or voted < len(votes):
            if not offered and sending < len(sent) and draw.random() >= _PAUSES:
                pixel, start, end = sent[sending]
                ctx.set(core.s_axis_video_tdata, pixel)
                ctx.set(core.s_axis_video_tuser, start)
                ctx.set(core.s_axis_video_tlast, end)
                offered = True
            ctx.set(core.s_axis_video_tvalid, offered)
            takes = draw.random() >= _PAUSES
            ctx.set(core.m_axis_video_tready, takes)
            taken = offered and ctx.get(core.s_axis_video_tready)
            given = takes and ctx.get(core.m_axis_video_tvalid)
            if given:
                found = (
                    ctx.get(core.m_axis_video_tdata),
                    bool(ctx.get(core.m_axis_video_tuser)),
                    bool(ctx.get(core.m_axis_video_tlast)),
                )
                if found != wanted[received]:
                    raise CheckError(
                        f"the video core differs from its circuits at beat {received}",
                        value=f"TDATA, TUSER, TLAST are {found}, expected {wanted[received]}",
                    )
                received += 1
                if progress and (received % _REPORT_EVERY == 0 or received == len(wanted)):
                    progress(received, len(wanted))
            if core.squares:
                counts = draw.random() >= _PAUSES
                ctx.set(core.m_axis_squares_tready, counts)
                if counts and ctx.get(core.m_axis_squares_tvalid):
                    given = True
                    square = (
                        ctx.get(core.m_axis_squares_tdata),
                        bool(ctx.get(core.m_axis_squares_tuser)),
                        bool(ctx.get(core.m_axis_squares_tlast)),
                    )
                    if votes[voted : voted + 1] != [square]:
                        raise CheckError(
                            f"the video core differs from the vote at square {voted}",
                            value=f"TDATA, TUSER, TLAST are {square}, "
                            f"expected {votes[voted] if voted < len(votes) else 'none'}",
                        )
                    voted += 1
            if taken:
                sending += 1
                offered = False
            idle = 0 if taken or given else idle + 1
            if idle > _PATIENCE:
                raise CheckError(f"the video core stops after {received} of {len(wanted)} beats")
            await ctx.tick()

    return bench
