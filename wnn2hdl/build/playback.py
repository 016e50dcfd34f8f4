"""Running a build's circuit over every window of a real picture."""

import math
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.build.verification import open_build
from wnn2hdl.elaborate import component
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.ir import CENTRE, CHANNELS, PIXEL_BITS, WINDOW_BITS
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.ir.wires import word_values
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Reading
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import Samples

SimulatorName = Literal["amaranth", "verilator", "icarus"]


@dataclass(frozen=True, eq=False)
class Playback:
    """A circuit's answers for a picture, all of them right.

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
    folder: Path,
    picture: Path,
    simulator: SimulatorName,
    progress: Progress,
    vcd: Path | None = None,
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> Playback:
    """Simulate a build's circuit on every window of a picture and compare every output bit.

    Where a code is cared for, the outputs must be the model's; elsewhere, in domain mode, those of the mapped
    LUTs. The reference window of the match count is that of the window before.

    Args:
        folder: a build whose circuit reads a window.
        picture: the picture, at least as large as a window, all of it data.
        simulator: Amaranth's, or a compiled simulation of the emitted Verilog.
        progress: called with the windows done; the compiled simulators report nothing before the end.
        vcd: where Amaranth's simulator records the waves of the first windows.
        reading: how the picture is read.

    Raises:
        InputError: another target, the picture cannot be used, or waves of another simulator are asked for.
        CheckError: an output is wrong.
        ToolError: the simulator is missing or failed.
    """
    design, files, _ = open_build(folder)
    top = design.top
    window = next((port for port in top.inputs if port.name == "window"), None)
    if window is None:
        raise InputError(
            "only a circuit that reads a window runs over a picture",
            value=f"{folder} is a {design.target.name}",
        )
    if vcd is not None and simulator != "amaranth":
        raise InputError(
            "waves are recorded by Amaranth's simulator only", value=simulator, hint="leave --vcd out"
        )
    rgb = read_rgb(picture, reading)
    side = math.isqrt(window.width // PIXEL_BITS)
    if min(rgb.shape[:2]) < side:
        raise InputError("the picture is smaller than a window", value=f"{picture} {rgb.shape[:2]}")
    shape = rgb.shape[0] - side + 1, rgb.shape[1] - side + 1
    windows = sliding_window_view(rgb, (side, side, len(CHANNELS))).reshape(-1, side * side, len(CHANNELS))
    inputs = {"window": pixel_bits(windows)}
    if any(port.name == "reference_bits" for port in top.inputs):
        bits = top.evaluate(inputs | {"reference_bits": np.zeros((len(windows), WINDOW_BITS), np.bool_)})[
            "bits"
        ]
        inputs["reference_bits"] = np.roll(bits, 1, axis=0)
    expected = top.evaluate(inputs)
    cared = _check_cared(design, inputs, expected)
    total = len(windows)
    progress("simulating windows", 0, total)
    started = time.perf_counter()
    if simulator == "amaranth":
        seconds = simulate(
            component(top, style=design.style),
            inputs,
            expected,
            progress=partial(progress, "simulating windows"),
            vcd=vcd,
        ).seconds
    else:
        claim = design.specification.claims[top.name]
        found, seconds = run_compiled(
            claim, design.module(top.name), files.simulated, inputs, simulator, latency=top.latency
        )
        _require_equal(found, expected, simulator)
        progress("simulating windows", total, total)
    compile_seconds = time.perf_counter() - started - seconds if simulator != "amaranth" else 0.0
    classes = expected["bits"][:, CENTRE] if "bits" in expected else expected["class_bits"].any(axis=1)
    edges = expected["edge_bit"].reshape(shape) if "edge_bit" in expected else None
    return Playback(total, cared, seconds, compile_seconds, classes.reshape(shape), edges)


def _check_cared(design: Design, inputs: Samples, answers: Samples) -> float:
    """Check the mapped LUTs' answers against the model's wherever these are cared for.

    Returns:
        The share of pixels, or of windows of a neighbourhood, that are cared for.

    Raises:
        CheckError: an answer is wrong.
    """
    claim = design.specification.claims[design.circuit.name]
    cared = claim.cared(inputs)
    inside = cared.all(axis=1)
    model = claim.answers(inputs)
    for port, bits in model.items():
        matters = claim.matters[port](model) if port in claim.matters else True
        if ((answers[port] != bits).any(axis=1) & inside & matters).any():
            raise CheckError(
                f"the mapped LUTs differ from the model in {port}", hint="compile the model again"
            )
    return float(cared.mean())


def _require_equal(found: Samples, expected: Samples, simulator: str) -> None:
    for port, values in expected.items():
        wrong = np.flatnonzero((found[port] != values).any(axis=1))
        if len(wrong):
            first = int(wrong[0])
            got, wanted = (word_values(bits[first : first + 1])[0] for bits in (found[port], values))
            raise CheckError(
                f"{simulator} disagrees at window {first}", value=f"{port} is {got:#b}, expected {wanted:#b}"
            )
