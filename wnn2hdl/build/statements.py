"""What the files of a build say about it, held against the build itself."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from wnn2hdl.build.design import DESIGN_FILE, MODEL_FILE, Design
from wnn2hdl.build.emission import SOBEL_THRESHOLDS, Files, render
from wnn2hdl.build.folder import REPORT_FILE
from wnn2hdl.edges import RULES
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.network import LutNetwork
from wnn2hdl.lower.targets import Ingredients
from wnn2hdl.report import model_figures, published_figures
from wnn2hdl.synth import OPTIONS, Synthesis, shares
from wnn2hdl.verify.specify import care_sets

_SOURCES = frozenset(
    {".v", ".vh", ".vp", ".sv", ".svh", ".svi", ".svp", ".vhd", ".vhdl", ".vho", ".f"}
    | {".xdc", ".sdc", ".tcl", ".do", ".xci", ".dcp", ".edf", ".edif", ".mem", ".hex", ".coe"}
)
"""Suffixes of what a simulator, a synthesiser or a script that collects sources would take for its own."""


def foreign_files(design: Design, folder: Path) -> list[str]:
    """What is missing, and sources that the compiler did not write; one line each."""
    files = Files.of(design, Path())
    emitted = {path.name for path in vars(files).values() if path is not None}
    wanted = [*sorted(emitted), MODEL_FILE, DESIGN_FILE, REPORT_FILE, MANIFEST_NAME]
    problems = [f"{name} is missing" for name in wanted if not (folder / name).is_file()]
    problems += [
        f"{str(path.relative_to(folder))!r} is a source that the compiler does not write"
        for path in sorted(folder.rglob("*"))
        if path.suffix.lower() in _SOURCES and str(path.relative_to(folder)) not in emitted
    ]
    return problems


def foreign_circuit(design: Design) -> list[str]:
    """How the circuit differs, apart from its logic, from what its target makes of the model; one line each.

    The logic is a matter of proof. A node or a cell that nothing reads is not a matter of it, but vendors'
    tools that are asked to keep cells would keep and count it.
    """
    # In exact mode the only don't-cares are those that the lowering itself finds impossible.
    care = care_sets(design.circuit) if design.mode == "domain" else None
    wanted = design.target.lower(Ingredients(design.model, design.edges, care, design.video, design.engine))
    faces = {name: _face(circuit) for name, circuit in wanted.definitions().items()}
    problems, parts = [], design.circuit.definitions()
    if design.circuit.name != wanted.name or list(parts) != list(faces):
        made = f"the target {design.target.name} is made of {', '.join(faces)}"
        return [f"{DESIGN_FILE} holds the circuits {', '.join(parts)}; {made}"]
    for name, circuit in parts.items():
        for what, stated in _face(circuit).items():
            if stated != faces[name][what]:
                problems.append(f"{DESIGN_FILE} has other {what} of the {name} than its target")
        problems += [f"{DESIGN_FILE}: nothing reads {net} in the {name}" for net in _unread(circuit)]
    rule = None if design.edges is None else RULES.get(design.edges.name)
    if design.edges is not None and rule is not None and (rule().patterns != design.edges.patterns).any():
        problems.append(f"{DESIGN_FILE} has other edge patterns than {design.edges.name}")
    for name, network in design.networks.items():
        problems += [f"{DESIGN_FILE}: nothing reads {cell} in the {name}" for cell in _unread_cells(network)]
    return problems


def foreign_text(design: Design, report: Mapping[str, Any], folder: Path) -> list[str]:
    """Emitted files that are not what the compiler writes for this design, one line each.

    The proof reads a text as Yosys reads it; simulators and other synthesisers may read another circuit in
    the same text, by macros, pragmas, delays and so on. So the text has to be the compiler's own, byte for
    byte: tools also differ in the characters that end a line.
    """
    threshold = report["options"].get("sobel_threshold")
    if type(threshold) is not int or threshold not in SOBEL_THRESHOLDS:
        return [f"{REPORT_FILE} has no threshold of the Sobel operator: {threshold!r}"]
    problems = []
    header = design.made_by(report["options"].get("effort", 0), report["tools"])
    for stated, line in zip(design.header, header, strict=False):
        if stated != line:
            problems.append(f"{DESIGN_FILE} says {stated!r}; {line!r} is so")
    if len(design.header) != len(header):
        problems.append(f"{DESIGN_FILE} has {len(design.header)} lines of comment for {len(header)}")
    for name, text in render(design, sobel_threshold=threshold).items():
        found, wanted = (folder / name).read_bytes().split(b"\n"), text.encode().split(b"\n")
        if found != wanted:
            place = next(
                (i for i, (x, y) in enumerate(zip(found, wanted, strict=False)) if x != y),
                min(len(found), len(wanted)),
            )
            line = ascii(found[place].decode("latin-1")) if place < len(found) else "the end of the file"
            problems.append(f"{name} is not what the compiler writes, from line {place + 1}: {line[:80]}")
    return problems


def false_statements(
    design: Design, report: Mapping[str, Any], syntheses: Mapping[str, Synthesis], proof: Mapping[str, Any]
) -> list[str]:
    """What `report.json` says that is not so, one line each; what takes labelled pictures is left alone.

    Args:
        design: the design.
        report: the object of its `report.json`.
        syntheses: what was counted again.
        proof: what was proved again, as the report says it.
    """
    care = None if design.care is None else design.care.project(tuple(range(design.care.width)))
    edges = design.edges
    found = {
        "target": design.target.name,
        "mode": design.mode,
        "latency": design.latency,
        "stage_ps": None if design.stages is None else design.stages.period,
        "parts": {part: asdict(result.resources) for part, result in syntheses.items()},
        "count": OPTIONS,
        "utilisation": {part: shares(result.resources) for part, result in syntheses.items()},
        "care": {
            "codes": None if care is None else int(care.sum()),
            "of": None if care is None else len(care),
        },
        "edges": {
            "name": None if edges is None else edges.name,
            "patterns": None if edges is None else edges.size,
        },
        "proof": proof,
        "model": {
            name: value for name, value in asdict(model_figures(design.model)).items() if name != "training"
        },
        "options": {"style": design.style, "name": design.name, "mode": design.mode},
        "hashes": {"model": design.model.digest()},
        "published": published_figures(),
    }
    problems = list(_contradictions("", report, json.loads(json.dumps(found))))
    extra = [f"parts.{part}" for part in report["parts"] if part not in syntheses]
    return problems + [f"{REPORT_FILE} has {place}, which is not a part of the build" for place in extra]


def _contradictions(place: str, stated: Any, found: Any) -> Iterator[str]:
    """Where a report differs from what was found; what only the report knows is not a difference."""
    if isinstance(found, dict) and isinstance(stated, Mapping):
        for key, value in found.items():
            yield from _contradictions(f"{place}.{key}" if place else key, stated.get(key), value)
    elif stated != found:
        shown, known = (json.dumps(value)[:80] for value in (stated, found))
        yield f"{REPORT_FILE} says that {place} is {shown}; it is {known}"


def _face(circuit: Circuit) -> dict[str, Any]:
    """What a circuit shows of itself: all but its logic."""
    return {
        "comments": circuit.summary,
        "ports": ([*circuit.inputs], [*circuit.outputs]),
        "care sets": [(care.word, care.allowed.to_json()) for care in circuit.care],
    }


def _unread(circuit: Circuit) -> list[str]:
    """Nodes of which no output depends."""
    needed = {part.net for word in circuit.drivers.values() for part in word}
    unread = []
    for node in reversed(circuit.nodes):
        if needed.isdisjoint(node.drives):
            unread.append(node.name)
        else:
            needed |= {part.net for word in node.reads for part in word}
    return unread[::-1]


def _unread_cells(network: LutNetwork) -> list[str]:
    needed = {signal for _, signal in network.outputs}
    unread = []
    for cell in reversed(network.cells):
        if cell.name not in needed:
            unread.append(cell.name)
        else:
            needed.update(cell.reads)
    return unread[::-1]
