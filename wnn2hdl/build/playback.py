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

from wnn2hdl.build.design import CLASSIFIERS, Design
from wnn2hdl.build.emission import Files, video_part
from wnn2hdl.build.streaming import beats, framed_answers
from wnn2hdl.build.verification import open_build
from wnn2hdl.elaborate import component
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.ir import CENTRE, CHANNELS, PIXEL_BITS, WINDOW_BITS
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.ir.video import MAX_HEIGHT
from wnn2hdl.ir.wires import word_values
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Reading
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import Samples
from wnn2hdl.verify.stream import run_stream, simulate_stream

SimulatorName = Literal["amaranth", "verilator", "icarus"]


@dataclass(frozen=True, eq=False)
class Playback:
    """A circuit's answers for a picture, all of them right.

    Attributes:
        windows: windows simulated, or pixels of a frame.
        cared: share of their pixels, or of the windows of a neighbourhood, whose code the circuit is proved
            on, 0 to 1.
        seconds: wall clock of the simulation.
        compile_seconds: wall clock of all else that the simulator needed first; 0 for Amaranth's.
        foreground: bool, one for each window's place, whether the circuit takes the middle for foreground.
        edges: bool, same shape, its edge bit; None of a circuit that has none.
        frame: of a video core what it sends, uint8 of the same shape; None of all others.
        squares: of one with squares their majorities, uint8 ``[rows, columns]``; None of all others.
    """

    windows: int
    cared: float
    seconds: float
    compile_seconds: float
    foreground: NDArray[np.bool_]
    edges: NDArray[np.bool_] | None
    frame: NDArray[np.uint8] | None = None
    squares: NDArray[np.uint8] | None = None


def play(
    folder: Path,
    picture: Path,
    simulator: SimulatorName,
    progress: Progress,
    vcd: Path | None = None,
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> Playback:
    """Simulate a build's circuit on every window of a picture, or as a frame, and compare every output bit.

    Where a code is cared for, the outputs must be the model's; elsewhere, in domain mode, those of the mapped
    LUTs. The reference window of the match count is that of the window before.

    Args:
        folder: a build whose circuit reads a window.
        picture: the picture, at least as large as a window and no wider than a video core is made for, all
            of it data.
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
    if vcd is not None and simulator != "amaranth":
        raise InputError(
            "waves are recorded by Amaranth's simulator only", value=simulator, hint="leave --vcd out"
        )
    if design.video is not None:
        return _play_frame(design, files, read_rgb(picture, reading), simulator, progress, vcd)
    window = next((port for port in top.inputs if port.name == "window"), None)
    if window is None:
        raise InputError(
            "only a circuit that reads a window runs over a picture",
            value=f"{folder} (target {design.target.name})",
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
    cared = _check_cared(design, top.name, inputs, expected)
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


def _play_frame(
    design: Design,
    files: Files,
    rgb: NDArray[np.uint8],
    simulator: SimulatorName,
    progress: Progress,
    vcd: Path | None,
) -> Playback:
    """`play` for a video core."""
    assert design.video is not None
    height, width = rgb.shape[:2]
    if height > MAX_HEIGHT or width > design.video.max_width:
        raise InputError(
            "the picture is larger than the frames of the core",
            value=f"{width}x{height}, allowed are {design.video.max_width}x{MAX_HEIGHT}",
            hint="compile with a larger --max-width, or give a smaller picture",
        )
    if design.video.is_mono and (rgb != rgb[..., :1]).any():
        raise InputError(
            "the core takes grey pixels", value="a picture in colours", hint="give a grey picture"
        )
    framed = framed_answers(design, rgb)
    shares = {part: _check_cared(design, part, *samples) for part, samples in framed.samples.items()}
    cared = next(shares[part] for part in CLASSIFIERS if part in shares)
    frame = beats(design, [rgb])
    progress("simulating pixels", 0, len(frame))
    started = time.perf_counter()
    if simulator == "amaranth":
        core = video_part(design)
        seconds = simulate_stream(
            core, frame, progress=partial(progress, "simulating pixels"), vcd=vcd
        ).seconds
    else:
        assert design.registers is not None
        seconds = run_stream(
            frame, design.video, design.registers, design.outermost, files.simulated, simulator
        )
        progress("simulating pixels", len(frame), len(frame))
    compile_seconds = time.perf_counter() - started - seconds if simulator != "amaranth" else 0.0
    sent = frame.answers.reshape(height, -1)[:, :width]
    return Playback(
        height * width,
        cared,
        seconds,
        compile_seconds,
        framed.classes != 0,
        framed.edges,
        sent,
        next(iter(frame.squares), None),
    )


def _check_cared(design: Design, part: str, inputs: Samples, answers: Samples) -> float:
    """Check the mapped LUTs' answers of a circuit against the model's wherever these are cared for.

    Returns:
        The share of what it reads that is cared for: of pixels, or of windows.

    Raises:
        CheckError: an answer is wrong.
    """
    claim = design.specification.claims[part]
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
