"""From a design to the files of its Verilog."""

from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from amaranth.lib.wiring import In, Out

from hdl_templates import sobel
from hdl_templates.hierarchy import Part
from hdl_templates.outline import steps_of
from hdl_templates.sobel_video import SobelCore
from hdl_templates.video import VideoCore
from wnn2hdl import elaborate
from wnn2hdl.build.design import Design
from wnn2hdl.build.streaming import sample_frames
from wnn2hdl.emit import (
    CELLS_FILE,
    c_header,
    cells_model,
    engine_testbench,
    engine_vectors,
    python_driver,
    stream_testbench,
    stream_vectors,
    testbench,
    vectors,
    verilog,
)
from wnn2hdl.errors import InputError
from wnn2hdl.files import write_text
from wnn2hdl.ir.steps import Step
from wnn2hdl.minimise.portfolio import generators as minimisers
from wnn2hdl.synth import Ports
from wnn2hdl.tools import find_yosys

SOBEL = "sobel"
"""Name of the baseline, as that of a part."""

SOBEL_THRESHOLDS = range(1, sobel.MAXIMUM + 1)
"""Thresholds that the baseline can have."""


@dataclass(frozen=True, eq=False)
class Files:
    """Where the emitted files of a design lie.

    Attributes:
        verilog: the circuit.
        cells: models of the vendor's cells for simulators.
        sobel: the baseline.
        testbench: checks the circuit against the model's answers.
        vectors: the inputs and answers that the testbench reads.
        header: of a core, its registers for C.
        driver: of a core, its registers for Python.
    """

    verilog: Path
    cells: Path
    sobel: Path
    testbench: Path
    vectors: Path
    header: Path | None = None
    driver: Path | None = None

    @classmethod
    def of(cls, design: Design, folder: Path) -> "Files":
        """The files of a design in a folder, written or yet to be.

        Raises:
            InputError: the design is called like a file that every build has.
        """
        if f"{design.name}.v".lower() in (f"{SOBEL}.v", CELLS_FILE):
            raise InputError(
                "every build has a file of this name", value=f"{design.name}.v", hint="choose another --name"
            )
        top = design.outermost
        drivers = [folder / f"{design.name}_registers.{kind}" for kind in ("h", "py") if design.has_memories]
        return cls(
            folder / f"{design.name}.v",
            folder / CELLS_FILE,
            folder / f"{SOBEL}.v",
            folder / f"{top}_tb.v",
            folder / f"{top}_vectors.hex",
            *drivers,
        )

    @property
    def simulated(self) -> list[Path]:
        """What a simulator needs besides a testbench."""
        return [self.cells, self.verilog]


def outermost_part(design: Design) -> Part:
    """The hardware of a design, of a core with its registers."""
    part, registers = top_part(design), design.registers
    return part if registers is None else elaborate.with_registers(part, registers)


def top_part(design: Design) -> Part:
    """The hardware of a design, of a core without its registers."""
    if design.engine is not None:
        return elaborate.match_engine(design.top, design.engine, style=design.style)
    if design.video is None:
        return elaborate.component(design.top, style=design.style)
    return video_part(design)


def video_part(design: Design) -> VideoCore:
    """The hardware of a video core."""
    assert design.video is not None
    classes = len(design.picture_model.classes)
    return elaborate.video_core(
        design.top, design.video, design.surroundings, classes=classes, style=design.style
    )


def steps(design: Design) -> tuple[Step, ...]:
    """What a core is made of between its streams; nothing of designs without streams."""
    return steps_of(top_part(design)) if design.has_memories else ()


def baseline_module(design: Design) -> str:
    """The module of the baseline: the operator's, or its video core's beside a core that sends edges."""
    is_core = design.video is not None and design.video.has_edges
    return design.module((SobelCore if is_core else sobel.Sobel).module_name)


def _baseline(design: Design, threshold: int) -> tuple[Part, str]:
    """The baseline, and what it is in words."""
    parameters = sobel.Parameters(threshold)
    operator = f"3x3 Sobel operator, |gx| + |gy| >= {threshold}"
    if design.video is None or not design.video.has_edges:
        return parameters.create(), f"Baseline: {operator}."
    core = SobelCore(video=design.video, parameters=parameters)
    return core, f"Baseline: video core of the {operator}, of grey pixels."


def ports(part: Part) -> Ports:
    """The ports of hardware."""
    widths: dict[Any, dict[str, int]] = {In: {}, Out: {}}
    for name, member in part.signature.members.items():
        widths[member.flow][name] = int(member.shape)
    return Ports(widths[In], widths[Out], part.clock if part.clocked else None)


def generators() -> dict[str, str]:
    """The versions of all that decides the bytes of the Verilog."""
    yosys = find_yosys()
    packages = {name: version(name) for name in ("wnn2hdl", "amaranth")}
    return {**packages, **minimisers(), yosys.name: yosys.version}


def render(design: Design, *, sobel_threshold: int) -> dict[str, str]:
    """The emitted files of a design: text by name of the file. The same design gives the same bytes.

    Args:
        design: the design.
        sobel_threshold: the baseline's.

    Raises:
        InputError: the design is called like a file that every build has.
        ToolError: Yosys is missing or failed.
    """
    files = Files.of(design, Path())
    part = outermost_part(design)
    prefix = f"{design.name}_"
    rival, title = _baseline(design, sobel_threshold)
    sources = [path.name for path in files.simulated]
    top, registers = design.outermost, design.registers
    if design.engine is not None:
        assert registers is not None
        rounds = design.engine.sample_rounds()
        data = engine_vectors(design.engine, rounds)
        bench = engine_testbench(
            name=top,
            engine=design.engine,
            cycles=design.latency,
            rounds=rounds,
            registers=registers,
            vectors_file=files.vectors.name,
            sources=sources,
        )
    elif design.video is None:
        claim = design.specification.claims[design.circuit.name]
        assert claim.stimulus is not None
        inputs = claim.stimulus()
        expected = claim.answers(inputs)
        count = len(next(iter(expected.values())))
        data = vectors(part, inputs, expected)
        bench = testbench(part, name=top, count=count, vectors_file=files.vectors.name, sources=sources)
    else:
        assert registers is not None
        frames = sample_frames(design)
        data = stream_vectors(frames, design.video)
        bench = stream_testbench(
            name=top,
            video=design.video,
            beats=frames,
            registers=registers,
            vectors_file=files.vectors.name,
            sources=sources,
        )
    texts = {
        files.verilog.name: verilog(part, prefix=prefix, header=design.header),
        files.cells.name: cells_model(),
        files.sobel.name: verilog(rival, prefix=prefix, header=[title]),
        files.vectors.name: data,
        files.testbench.name: bench,
    }
    if registers is not None and files.header is not None and files.driver is not None:
        texts[files.header.name] = c_header(registers, design.name, top)
        texts[files.driver.name] = python_driver(registers, top)
    return texts


def render_unpaired(design: Design) -> str:
    """The Verilog of a design for FPGAs of other families, in which no two LUTs share a cell."""
    return verilog(top_part(design), prefix=f"{design.name}_", header=(), pairs=False)


def emit(design: Design, folder: Path, *, sobel_threshold: int) -> Files:
    """Write a design and its emitted files into an existing folder; raises as `render`."""
    design.save(folder)
    for name, text in render(design, sobel_threshold=sobel_threshold).items():
        write_text(folder / name, text)
    return Files.of(design, folder)
