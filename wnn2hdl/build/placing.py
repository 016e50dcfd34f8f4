"""A build on an FPGA of another maker: mapped, proved, placed, routed, and a bitstream of it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from wnn2hdl.build.checking import Proofs, refutation, undecided
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import ports, render_unpaired, top_part
from wnn2hdl.build.extending import add_to_report, require_outside, require_unchanged
from wnn2hdl.build.minimising import minimise_once
from wnn2hdl.build.verification import open_build
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.files import make_folder, read_text, write_bytes, write_text
from wnn2hdl.ir.circuit import Circuit as CircuitOfTables
from wnn2hdl.lower.targets import Ingredients
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.progress import Progress
from wnn2hdl.synth import FABRICS, SEED, Fabric, Harnessed, Mapped, Placed, harness, map_to, place_and_route
from wnn2hdl.tools import find_yosys
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.holding import sides
from wnn2hdl.verify.proof import prove, prove_netlists
from wnn2hdl.verify.specify import care_sets

_STEPS = 4
"""Mapping, proof of the Verilog, proof of the netlist, placing and routing."""


@dataclass(frozen=True, eq=False)
class PlacedBuild:
    """A build that is placed and routed.

    Attributes:
        figures: what the build's report says of it.
        files: what was written, the bitstream last.
    """

    figures: dict[str, Any]
    files: tuple[Path, ...]


def place_build(
    folder: Path, device: str, output: Path, pins: Path | None, progress: Progress
) -> PlacedBuild:
    """Place and route a build, write a bitstream, and add the figures to the build's report.

    The netlist that is placed is proved equal to the Verilog, and that to the model, before it is placed.

    Args:
        folder: the build.
        device: the name of one of `wnn2hdl.synth.FABRICS`.
        output: the folder for the bitstream and what belongs to it.
        pins: constraints that assign the ports to pins, as nextpnr reads them; None has them assigned.
        progress: reports each step.

    Raises:
        InputError: the folder is not a build or is that of a match engine, the design does not fit, or the
            pins are wrong.
        CheckError: files of the build were changed, or a proof fails.
        ToolError: a program is missing or failed.
    """
    design, _, report = open_build(folder)
    if design.engine is not None:
        raise InputError(
            "match engines are not placed on other FPGAs: their multiplier is not mapped",
            value=str(folder),
            hint="take their Verilog into Vivado: `synth BUILD --tool vivado --scripts`",
        )
    require_unchanged(folder)
    require_outside(folder, output)
    fabric = FABRICS[device]
    for program in (fabric.family.placer.nextpnr, fabric.family.placer.packer):
        program.version()
    constraints = None if pins is None else read_text(pins, "pins")
    progress("placing and routing", 0, _STEPS)
    written = _fewest(design, fabric, int(report["options"].get("effort", 1)))
    design, verilog = written.design, written.verilog
    progress("placing and routing", 1, _STEPS)
    circuits = {
        part: Circuit((verilog,), design.module(part), circuit.latency)
        for part, circuit in design.parts.items()
    }
    unproved = _prove_verilog(design, circuits)
    progress("placing and routing", 2, _STEPS)
    top = design.circuit.name
    # A video core is not a function of its inputs: its circuits are proved, each by itself.
    proved = [top] if design.video is None else list(design.parts)
    mapped = {part: map_to(fabric, verilog, design.module(part)) for part in {*proved, top}}
    unproved += _prove_netlists(design, {part: (circuits[part], mapped[part]) for part in proved})
    progress("placing and routing", 3, _STEPS)
    name = f"{design.name}_pins"
    around = harness(
        name,
        design.module(top),
        ports(top_part(design)),
        pins=fabric.pins,
        registered=design.video is None,
    )
    placed = place_and_route(fabric, mapped[top], around, name, constraints)
    progress("placing and routing", 4, _STEPS)
    figures = {
        "part": fabric.part,
        "circuit": top,
        "cells": asdict(mapped[top].cells),
        "logic": written.how,
        "count": mapped[top].command,
        "proof": "UNPROVED" if unproved else "proved",
        "proved": proved,
        "unproved": unproved,
        "harness": around.kind,
        "fmax_mhz": placed.fmax_mhz,
        "from_pins_ns": placed.from_pins_ns,
        "to_pins_ns": placed.to_pins_ns,
        "utilisation": {
            kind: {"used": used, "available": available}
            for kind, (used, available) in placed.utilisation.items()
        },
        "seed": SEED,
        "pins": "assigned automatically" if pins is None else pins.name,
        "tools": {find_yosys().name: find_yosys().version, **placed.tools},
    }
    files = _write(output, design.name, fabric, mapped[top], around, placed)
    add_to_report(folder, {"placed": {device: figures}})
    return PlacedBuild(figures, files)


@dataclass(frozen=True)
class _Written:
    """A design as Verilog for a fabric; ``how`` it is written, in words."""

    how: str
    design: Design
    verilog: str


def _fewest(design: Design, fabric: Fabric, effort: int) -> _Written:
    """The design, written in the way that takes the fewest LUTs of the fabric.

    Either its LUTs of six inputs stand as equations, which Yosys maps again, or its tables are minimised to
    LUTs of four inputs, which stay. A pipeline, whose stages name its LUTs, has the former alone.
    """
    ways = {"equations": replace(design, style="equations")}
    if design.stages is None:
        ways["LUTs of four inputs"] = replace(design, circuit=_of_four(design, effort), style="cells")
    written = [_Written(how, way, render_unpaired(way)) for how, way in ways.items()]

    def cost(way: _Written) -> tuple[int, int]:
        cells = map_to(fabric, way.verilog, design.module(design.circuit.name)).cells
        return cells.luts, cells.muxes

    return min(written, key=cost)


def _of_four(design: Design, effort: int) -> CircuitOfTables:
    """The circuit with its tables minimised to LUTs of four inputs."""
    # In exact mode the only don't-cares are those that the lowering itself finds impossible.
    care = care_sets(design.circuit) if design.mode == "domain" else None
    tables = design.target.lower(Ingredients(design.model, design.edges, care, design.video))
    return minimise(tables, effort, lambda *_: None, by=partial(minimise_once, lut_inputs=4)).circuit


def _prove_verilog(design: Design, circuits: Mapping[str, Circuit]) -> list[str]:
    """What a limit left unproved of the Verilog; raises CheckError if it is not the model."""
    specification = design.specification
    claimed = {part: circuit for part, circuit in circuits.items() if part in specification.claims}
    proofs = Proofs(
        {part: sides(specification, specification.claims[part], claimed[part]) for part in claimed},
        afresh=False,
    )
    if proofs.due:
        pieces = specification.composition.pieces if specification.composition else {}
        proofs.note(prove(specification, {part: circuits[part] for part in (*pieces, *proofs.due)}))
    _require_equal(refutation(proofs.found, "Verilog"))
    return undecided(specification, proofs.found)


def _prove_netlists(design: Design, pairs: Mapping[str, tuple[Circuit, Mapped]]) -> list[str]:
    """The same of mapped netlists."""
    compared = {
        part: (circuit, replace(circuit, sources=(mapped.logic,)))
        for part, (circuit, mapped) in pairs.items()
    }
    proofs = Proofs(compared, afresh=False)
    if proofs.due:
        widths = {part: circuit.widths for part, circuit in design.parts.items()}
        proofs.note(prove_netlists({part: compared[part] for part in proofs.due}, widths))
    _require_equal(refutation(proofs.found, "mapped netlist"))
    return [f"{part} netlist" for part, proof in proofs.found.items() if proof.status == "undecided"]


def _require_equal(failure: str | None) -> None:
    if failure is not None:
        raise CheckError("the circuit is not the model", value=failure)


def _write(
    folder: Path, name: str, fabric: Fabric, mapped: Mapped, around: Harnessed, placed: Placed
) -> tuple[Path, ...]:
    texts = {
        f"{name}_netlist.v": mapped.netlist,
        f"{name}_pins.v": around.verilog,
        "nextpnr.json": placed.timing,
        "nextpnr.log": placed.log,
    }
    if placed.constraints is not None:
        texts[f"{name}{fabric.family.constraints}"] = placed.constraints
    make_folder(folder)
    for file, text in texts.items():
        write_text(folder / file, text)
    bitstream = folder / f"{name}{fabric.family.bitstream}"
    write_bytes(bitstream, placed.bitstream)
    return (*(folder / file for file in texts), bitstream)
