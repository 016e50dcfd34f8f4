"""Running a build's circuit over every 3x3 window of a real picture."""

import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.ir import CENTRE, CHANNELS, WINDOW_BITS, WINDOW_CODES, bits_to_codes, codes_to_bits
from wnn2hdl.pipeline.circuits import component, port_arrays
from wnn2hdl.pipeline.design import Design
from wnn2hdl.pipeline.evaluation import circuit_answers
from wnn2hdl.pipeline.training import Progress
from wnn2hdl.pipeline.verification import open_build
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import Samples

SimulatorName = Literal["amaranth", "verilator", "icarus"]


@dataclass(frozen=True, eq=False)
class Playback:
    """A block's answers for a picture, all as they should be.

    Attributes:
        windows: 3x3 windows simulated.
        cared: share of their pixels whose code the circuit is proved on, 0 to 1.
        seconds: wall clock of the simulation.
        compile_seconds: wall clock of all else that the simulator needed first; 0 for Amaranth's.
        foreground: bool ``[height - 2, width - 2]``, whether the circuit takes the centre for foreground.
        edges: bool, same shape, its edge bit.
    """

    windows: int
    cared: float
    seconds: float
    compile_seconds: float
    foreground: NDArray[np.bool_]
    edges: NDArray[np.bool_]


def play(
    folder: Path, picture: Path, simulator: SimulatorName, progress: Progress, vcd: Path | None = None
) -> Playback:
    """Simulate a build's block on every 3x3 window of a picture and compare every output bit.

    Where a code is cared for, the outputs must be the model's; elsewhere, in domain mode, those of the mapped
    LUTs. The reference window of the match count is that of the window before.

    Args:
        folder: a build of target ``block``.
        picture: the picture, at least 3x3.
        simulator: Amaranth's, or a compiled simulation of the emitted Verilog.
        progress: told of the windows done; the compiled simulators tell nothing before the end.
        vcd: where Amaranth's simulator records the waves of the first windows.

    Raises:
        InputError: no block, the picture cannot be used, or waves of another simulator are asked for.
        CheckError: an output is wrong.
        ToolError: the simulator is missing or failed.
    """
    design, circuits, _ = open_build(folder)
    if design.target != "block":
        raise InputError("only a block runs over a picture", value=f"{folder} is a {design.target}")
    if vcd is not None and simulator != "amaranth":
        raise InputError(
            "waves are recorded by Amaranth's simulator only", value=simulator, mend="leave --vcd out"
        )
    rgb = read_rgb(picture)
    if min(rgb.shape[:2]) < 3:
        raise InputError("the picture is smaller than a window", value=f"{picture} {rgb.shape[:2]}")
    inputs, expected, cared = _answers(design, rgb)
    total = len(inputs["window"])
    started = time.perf_counter()
    if simulator == "amaranth":
        seconds = simulate(
            component(design, "block_match"),
            port_arrays(inputs),
            port_arrays(expected),
            progress=partial(progress, "simulating windows"),
            vcd=vcd,
        ).seconds
    else:
        part = design.specification.part("block_match")
        found, seconds = run_compiled(part, [circuits.verilog], inputs, simulator)
        _require_equal(found, expected, simulator)
        progress("simulating windows", total, total)
    compile_seconds = time.perf_counter() - started - seconds if simulator != "amaranth" else 0.0
    shape = rgb.shape[0] - 2, rgb.shape[1] - 2
    foreground = (expected["bits"] >> CENTRE & 1).astype(np.bool_).reshape(shape)
    return Playback(
        total,
        cared,
        seconds,
        compile_seconds,
        foreground,
        expected["edge_bit"].astype(np.bool_).reshape(shape),
    )


def _answers(design: Design, rgb: NDArray[np.uint8]) -> tuple[Samples, Samples, float]:
    """Every window, the mapped LUTs' answers for it, and the share of cared-for pixels.

    The answers are checked against the model's wherever these are cared for.
    """
    specification = design.specification
    windows = sliding_window_view(rgb, (3, 3, len(CHANNELS))).reshape(-1, WINDOW_BITS, len(CHANNELS))
    codes = specification.encoder.codes(windows)
    bits = bits_to_codes(circuit_answers(design.pixel)[codes] != 0)
    edges = design.edge.evaluate(np.arange(WINDOW_CODES))[:, 0]
    reference = np.roll(bits, 1)
    answers: Samples = {
        "bits": bits,
        "edge_bit": edges[bits].astype(np.int64),
        "match_count": codes_to_bits(~(bits ^ reference), WINDOW_BITS).sum(axis=1),
    }
    inputs: Samples = {"window": windows, "reference": reference}
    cared = specification.pixel_care[codes]
    inside = cared.all(axis=1)
    model = specification.evaluate("block_match", {port: values[inside] for port, values in inputs.items()})
    inside_window = specification.window_care[model["bits"]]
    for port, values in model.items():
        matters = inside_window if port == "edge_bit" else np.ones(len(values), dtype=np.bool_)
        if (answers[port][inside] != values)[matters].any():
            raise CheckError(
                f"the mapped LUTs differ from the model in {port}", mend="compile the model again"
            )
    return inputs, answers, float(cared.mean())


def _require_equal(found: Samples, expected: Samples, simulator: str) -> None:
    for port, values in expected.items():
        wrong = np.flatnonzero(found[port] != values)
        if len(wrong):
            first = int(wrong[0])
            raise CheckError(
                f"{simulator} disagrees at window {first}",
                value=f"{port} is {found[port][first]:#b}, expected {values[first]:#b}",
            )
