"""Running a build's circuit over every window of a real picture."""

import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from wnn2hdl.build.circuits import component, port_arrays
from wnn2hdl.build.classifier import circuit_answers
from wnn2hdl.build.design import Design
from wnn2hdl.build.verification import open_build
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.ir import CENTRE, CHANNELS, WINDOW_BITS, WINDOW_CODES, bits_to_codes, codes_to_bits
from wnn2hdl.ir.window import SIDE
from wnn2hdl.progress import Progress
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import NeighbourhoodSpecification, PartName, Samples, Specification

SimulatorName = Literal["amaranth", "verilator", "icarus"]


@dataclass(frozen=True, eq=False)
class Playback:
    """A circuit's answers for a picture, all as they should be.

    Attributes:
        windows: windows simulated.
        cared: share of their pixels, or of the windows of a neighbourhood, whose code the circuit is proved
            on, 0 to 1.
        seconds: wall clock of the simulation.
        compile_seconds: wall clock of all else that the simulator needed first; 0 for Amaranth's.
        foreground: bool, one for each window's place, whether the circuit takes the middle for foreground.
        edges: bool, same shape, its edge bit; None of a neighbourhood, which has none.
    """

    windows: int
    cared: float
    seconds: float
    compile_seconds: float
    foreground: NDArray[np.bool_]
    edges: NDArray[np.bool_] | None


def play(
    folder: Path, picture: Path, simulator: SimulatorName, progress: Progress, vcd: Path | None = None
) -> Playback:
    """Simulate a build's block or neighbourhood on every window of a picture and compare every output bit.

    Where a code is cared for, the outputs must be the model's; elsewhere, in domain mode, those of the mapped
    LUTs. The reference window of the match count is that of the window before.

    Args:
        folder: a build of target ``block`` or ``neighbourhood``.
        picture: the picture, at least as large as a window.
        simulator: Amaranth's, or a compiled simulation of the emitted Verilog.
        progress: told of the windows done; the compiled simulators tell nothing before the end.
        vcd: where Amaranth's simulator records the waves of the first windows.

    Raises:
        InputError: another target, the picture cannot be used, or waves of another simulator are asked for.
        CheckError: an output is wrong.
        ToolError: the simulator is missing or failed.
    """
    design, circuits, _ = open_build(folder)
    if design.target not in ("block", "neighbourhood"):
        raise InputError(
            "only a block or a neighbourhood runs over a picture", value=f"{folder} is a {design.target}"
        )
    if vcd is not None and simulator != "amaranth":
        raise InputError(
            "waves are recorded by Amaranth's simulator only", value=simulator, hint="leave --vcd out"
        )
    rgb = read_rgb(picture)
    specification = design.specification
    part: PartName = "block_match" if design.target == "block" else "neighbourhood"
    side = SIDE if isinstance(specification, Specification) else specification.encoder.size
    if min(rgb.shape[:2]) < side:
        raise InputError("the picture is smaller than a window", value=f"{picture} {rgb.shape[:2]}")
    windows = sliding_window_view(rgb, (side, side, len(CHANNELS))).reshape(-1, side * side, len(CHANNELS))
    if isinstance(specification, Specification):
        inputs, expected, cared = _block_answers(design, specification, windows)
    else:
        inputs, expected, cared = _neighbourhood_answers(design, specification, windows)
    total = len(inputs["window"])
    progress("simulating windows", 0, total)
    started = time.perf_counter()
    if simulator == "amaranth":
        seconds = simulate(
            component(design, part),
            port_arrays(inputs),
            port_arrays(expected),
            progress=partial(progress, "simulating windows"),
            vcd=vcd,
        ).seconds
    else:
        found, seconds = run_compiled(specification.part(part), [circuits.verilog], inputs, simulator)
        _require_equal(found, expected, simulator)
        progress("simulating windows", total, total)
    compile_seconds = time.perf_counter() - started - seconds if simulator != "amaranth" else 0.0
    shape = rgb.shape[0] - side + 1, rgb.shape[1] - side + 1
    if part == "neighbourhood":
        foreground, edges = expected["class_bits"] != 0, None
    else:
        foreground = expected["bits"] >> CENTRE & 1 != 0
        edges = expected["edge_bit"].astype(np.bool_).reshape(shape)
    return Playback(total, cared, seconds, compile_seconds, foreground.reshape(shape), edges)


def _neighbourhood_answers(
    design: Design, specification: NeighbourhoodSpecification, windows: NDArray[np.uint8]
) -> tuple[Samples, Samples, float]:
    """As `_block_answers`, for the windows of a neighbourhood."""
    codes = specification.codes(windows)
    inputs: Samples = {"window": windows}
    answers: Samples = {"class_bits": circuit_answers(design.decision)[codes]}
    cared = specification.care[codes]
    model = specification.evaluate("neighbourhood", inputs)
    if (answers["class_bits"] != model["class_bits"])[cared].any():
        raise CheckError("the mapped LUTs differ from the model", hint="compile the model again")
    return inputs, answers, float(cared.mean())


def _block_answers(
    design: Design, specification: Specification, windows: NDArray[np.uint8]
) -> tuple[Samples, Samples, float]:
    """Every window, the mapped LUTs' answers for it, and the share of cared-for pixels.

    The answers are checked against the model's wherever these are cared for.
    """
    codes = specification.encoder.codes(windows)
    bits = bits_to_codes(circuit_answers(design.decision)[codes] != 0)
    edges = design.networks["edge"].evaluate(np.arange(WINDOW_CODES))[:, 0]
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
                f"the mapped LUTs differ from the model in {port}", hint="compile the model again"
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
