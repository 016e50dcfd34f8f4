"""The steps of cores between their streams, as they are built: what a drawing of them shows."""

import math
from collections.abc import Sequence
from dataclasses import replace

from hdl_templates.across import waits
from hdl_templates.buffered import READ_CYCLES
from hdl_templates.counting import Counting
from hdl_templates.engine import MatchEngine
from hdl_templates.hierarchy import Part
from hdl_templates.squares import LATENCY
from hdl_templates.video import VideoCore, input_of, output_of
from wnn2hdl.ir.engine import EDGE_BIT, RESULT_WORDS, WORD_BITS
from wnn2hdl.ir.steps import Step
from wnn2hdl.ir.window import SIDE

_QUEUE, _SCAN, _ACROSS, _COUNTING = 1, 2, 1, 3
"""Registers of `hdl_templates.stream`, `scan`, `across` and `counting`, without the beats they wait for."""


def steps_of(core: Part) -> tuple[Step, ...]:
    """The steps of a video core or of a match engine, in the order in which they are passed; else none."""
    if isinstance(core, VideoCore):
        return tuple(_video(core))
    return tuple(_engine(core)) if isinstance(core, MatchEngine) else ()


def _video(core: VideoCore) -> list[Step]:
    pixels = len(core.pixels)
    steps = [Step("s_axis_video", "stream", (), core.video.pixel_bits * pixels)]

    def circuit(name: str, parts: Sequence[Part]) -> None:
        (bits,) = {len(output_of(part)) for part in parts}
        cycles = parts[0].latency + _QUEUE
        part, before = parts[0].module_name, steps[-1].name
        steps.append(Step(name, "circuit", (before,), bits * len(parts), cycles, part, len(parts)))

    def window(
        name: str, size: int, kept: Sequence[int], bits: int, cycles: int = _ACROSS, beats: int | None = None
    ) -> None:
        reach = size // 2
        steps.append(
            Step(
                f"{size}x{size} {name}",
                "memory",
                (steps[-1].name,),
                bits * pixels,
                _SCAN + cycles,
                words=core.places,
                # A bit of each word says where lines end.
                word_bits=1 + pixels * sum(kept),
                lines=reach,
                beats=waits(reach, pixels) if beats is None else beats,
            )
        )

    circuit("pixel classifier", core.pixels)
    bits = len(output_of(core.pixels[0]))
    if core.neighbours is not None:
        size, kept = core.neighbours.size, core.neighbours.kept(bits)
        if isinstance(core.neighbours, Counting):
            counts = len(input_of(core.neighbours.parts[0]))
            window("counts", size, kept, counts, _COUNTING, size // 2)
        else:
            window("window", size, kept, len(core.neighbours.taps))
        circuit("decision", core.neighbours.parts)
        bits = len(output_of(core.neighbours.parts[0]))
    if core.marks_lines:
        lines = core.edge_lines(bits)
        window("edge window", SIDE, lines.kept, SIDE**2 * lines.depth or lines.sends)
    votes = steps[-1].name
    if core.windows:
        circuit("edge filter", core.windows)
    elif core.marks_lines:
        # Without windows the answers are queued all the same.
        steps[-1] = replace(steps[-1], name="last line", cycles=steps[-1].cycles + _QUEUE)
        votes = steps[-1].name
    answers = steps[-1].name
    if core.squares is not None:
        words, word_bits = core.squares.memory(core.places, pixels)
        counted = (core.squares.classes - 1).bit_length()
        cycles = LATENCY + _QUEUE
        steps.append(Step("squares", "memory", (votes,), counted, cycles, words=words, word_bits=word_bits))
        steps.append(Step("m_axis_squares", "stream", ("squares",), len(core.m_axis_squares_tdata)))
    steps.append(Step("m_axis_video", "stream", (answers,), len(core.m_axis_video_tdata)))
    return steps


def _engine(core: MatchEngine) -> list[Step]:
    engine = core.engine
    (height, width), (rows, columns) = engine.template, engine.segment

    def store(name: str, pixels: int) -> Step:
        # Both halves of a memory that is filled while it is read.
        return Step(name, "memory", (f"s_axis_{name}",), 1, READ_CYCLES, words=2 * pixels, word_bits=1)

    return [
        Step("s_axis_segment", "stream", (), WORD_BITS),
        Step("s_axis_template", "stream", (), EDGE_BIT + 1),
        store("segment", rows * columns),
        store("template", height * width),
        Step(
            "lanes",
            "circuit",
            ("segment", "template"),
            engine.score_bits,
            core.lanes[0].latency,
            core.lanes[0].module_name,
            engine.lanes,
            engine.positions[1],
            engine.lanes * engine.score_bits,
        ),
        # The best position of each cell, and its score.
        Step(
            "best and second",
            "circuit",
            ("lanes",),
            RESULT_WORDS * WORD_BITS,
            words=max(math.prod(engine.cells), 2),
            word_bits=sum((count - 1).bit_length() for count in engine.positions) + engine.score_bits,
        ),
        Step("m_axis_result", "stream", ("best and second",), RESULT_WORDS * WORD_BITS),
    ]
