"""`report.json` as one HTML page that needs no other file."""

import base64
import shlex
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from markupsafe import Markup

from wnn2hdl.ir import Lut, LutNetwork, Mux, Neighbourhood
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.ir.steps import Step
from wnn2hdl.lower.targets import TARGETS
from wnn2hdl.report.charts import cube_bars, for_all_widths, light_lines, lut_bars, published
from wnn2hdl.report.logic import Grid, contents, expression, grid
from wnn2hdl.report.pipeline import lay_out, memory, waiting, way
from wnn2hdl.report.placed import NOTE as PLACED_NOTE
from wnn2hdl.report.placed import PLACED_HEADS, placed_notes, placed_rows, vivado_rows
from wnn2hdl.report.schematic import draw
from wnn2hdl.report.shell import environment, figures_of, form

if TYPE_CHECKING:
    from jinja2 import Environment

MANY_TABLES = 40
"""More tables than these are summed up and not shown one by one."""

_MANY_CELLS, _MANY_RAMS, _MANY_CLASSES = 150, 400, 30
"""The same of LUTs and multiplexers in one drawing, of bars of saturation, and of classes in a confusion."""

RESOURCES = {
    "luts": "LUTs",
    "muxf7": "MUXF7",
    "muxf8": "MUXF8",
    "carry4": "CARRY4",
    "ffs": "flip-flops",
    "bram36": "BRAM36",
    "dsp": "DSP",
    "delay_ps": "delay, ps",
}

_KINDS = {"luts": "LUTs", "ffs": "flip-flops", "bram36": "block RAMs", "dsp": "DSP slices"}

_NOTES, _DEPTH, _SHOWN_BITS = 12, 4, 128
"""Notes of a training that are shown, how deep they may be nested, and input bits that are named."""


@dataclass(frozen=True)
class Picture:
    """A picture of the page.

    Attributes:
        title: its caption.
        description: what it shows, for those who do not see it.
        png: the file.
        width: in pixels.
        height: in pixels.
    """

    title: str
    description: str
    png: bytes
    width: int
    height: int

    @property
    def data(self) -> str:
        """The file in base64."""
        return base64.b64encode(self.png).decode()


@dataclass(frozen=True)
class _Cell:
    """What the page says of a LUT, or of a multiplexer, which has no grid."""

    id: str
    name: str
    kind: str
    expression: str
    init: str | None
    grid: Grid | None
    inputs: tuple[str, ...]


def build_page(
    report: Mapping[str, Any],
    networks: Mapping[str, LutNetwork],
    pictures: Sequence[Picture] = (),
    legend: Sequence[tuple[str, str]] = (),
    window: Neighbourhood | None = None,
    steps: Sequence[Step] = (),
) -> str:
    """The page of a build; the same arguments give the same bytes.

    Every figure of the report stands in an element whose ``data-key`` is its path in `report.json`, with dots
    between the steps, and whose ``value`` is the figure as JSON has it.

    Args:
        report: the object of `report.json`.
        networks: the LUT networks of the build, by the names of `wnn2hdl.ir.circuit.Circuit.tables`.
        pictures: sample pictures.
        legend: class names and their colours in the pictures, as CSS writes colours.
        window: what a classifier of neighbourhoods looks at.
        steps: of a core, from stream to stream.
    """
    templates = environment()
    templates.globals["figure"] = figures_of(report)
    target = TARGETS.get(report["target"])
    measured = [part for part, figures in report["parts"].items() if figures["luts"] is not None]
    model = report.get("model")
    confusion = report.get("confusion")
    curves = light_curves(report)
    drawn = {} if _are_many(networks) else networks
    return templates.get_template("build.html").render(
        report=report,
        what=target.description if target else f"A circuit of target {report['target']}",
        form=form,
        classifies=target is None or target.classifies or report["accuracy"] is not None,
        # Not of an edge filter or a matcher, which are the same for every model.
        model=model if target is None or target.classifies or "network" in report["parts"] else None,
        answers=target is None or target.classifies or target.has_edges or report["accuracy"] is not None,
        window=_window(window) if window else (),
        steps=[(step, memory(step), waiting(step)) for step in steps],
        delay={key: sum(getattr(step, key) for step in way(steps)) for key in ("lines", "beats", "cycles")}
        if steps
        else {},
        pipelines=[
            (lay_out(steps, report["parts"], narrow=narrow), narrow) for narrow in (False, True) if steps
        ],
        places={
            name: f"row {tap.row}, column {tap.column}"
            for name, tap in zip(window.names, window.taps, strict=True)
        }
        if window
        else {},
        quoted=shlex.quote(report["name"]),
        measured=measured,
        resource_heads={
            key: head
            for key, head in RESOURCES.items()
            if any(_tells(key, report["parts"][part].get(key)) for part in measured)
        },
        shared_out=any(report["utilisation"].get(part) for part in measured),
        kinds=_KINDS,
        sum=_sum(report["parts"]),
        circuits=[_circuit(templates, name, network) for name, network in drawn.items()],
        summed_up=_by_inputs(networks) if networks and not drawn else (),
        pictures=pictures,
        legend=legend,
        classes=model["classes"] if model else [f"class {i}" for i in range(len(confusion or ()))],
        input_bits=_input_bits(model["bits"]) if model else "",
        few_classes=len(confusion or ()) <= _MANY_CLASSES,
        few_rams=model is not None and sum(map(len, model["saturation"])) <= _MANY_RAMS,
        notes=_notes(model["training"]) if model else [],
        training=_training(report["name"], model["training"]) if model else "",
        options=plain_options(report["options"]),
        simulations=simulations(report["options"]),
        published=published(report),
        light_charts={
            quantity: for_all_widths(light_lines, quantity, points) for quantity, points in curves.items()
        },
        as_taken=as_taken(report),
        vivado_rows=vivado_rows(report),
        placed_heads=PLACED_HEADS,
        placed_rows=placed_rows(report),
        placed_notes=(*placed_notes(report), PLACED_NOTE),
        lut_chart=for_all_widths(lut_bars, report),
        few_covers=len(report["minimised"]) <= MANY_TABLES,
        cubes=_total(report["minimised"]),
        cube_chart=for_all_widths(cube_bars, report["minimised"])
        if 0 < len(report["minimised"]) <= MANY_TABLES
        else "",
    )


def light_curves(report: Mapping[str, Any]) -> Mapping[str, Sequence[Mapping[str, Any]]]:
    """The accuracies in changed light, see `wnn2hdl.report.LightFigures`; none if they were not measured."""
    curves: Mapping[str, Sequence[Mapping[str, Any]]] = report.get("light", {}).get("curves", {})
    return curves


def as_taken(report: Mapping[str, Any]) -> int | None:
    """Which exposure leaves images as they are; None if there is none, or no interval of its accuracy."""
    points = light_curves(report).get("exposure", ())
    return next((i for i, point in enumerate(points) if point["value"] == 1 and point["interval"]), None)


def plain_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options that have a value, without those that are mappings and those that other tables show."""
    return {
        key: value
        for key, value in options.items()
        if value is not None and not isinstance(value, Mapping) and key != "simulated_before"
    }


def simulations(options: Mapping[str, Any]) -> dict[str, str]:
    """When each part that counts as simulated was so: for this build, or before, on the same vectors."""
    before = (options.get("simulated_before") or "").split(", ")
    return {
        part: "passed before on the same vectors" if part in before else "simulated for this build"
        for part in options.get("simulated_vectors") or ()
    }


def _tells(key: str, value: Any) -> bool:
    """Whether a figure is worth a column: LUTs and delays wherever they were measured, others above 0."""
    return value is not None if key in ("luts", "delay_ps") else bool(value)


def _are_many(networks: Mapping[str, LutNetwork]) -> bool:
    return (
        len(networks) > MANY_TABLES or sum(len(network.cells) for network in networks.values()) > _MANY_CELLS
    )


def _by_inputs(networks: Mapping[str, LutNetwork]) -> list[dict[str, int]]:
    """How many tables there are of each number of inputs, and what they take together."""
    groups: dict[int, list[LutNetwork]] = defaultdict(list)
    for network in networks.values():
        groups[len(network.inputs)].append(network)
    return [
        {
            "inputs": inputs,
            "tables": len(group),
            "luts": sum(len(network.luts) for network in group),
            "muxes": sum(len(network.muxes) for network in group),
            "depth": max(network.depth for network in group),
        }
        for inputs, group in sorted(groups.items())
    ]


def _total(minimised: Mapping[str, Mapping[str, int]]) -> dict[str, int]:
    keys = ("cubes_before", "cubes_after", "literals_before", "literals_after")
    return {key: sum(sizes[key] for sizes in minimised.values()) for key in keys}


def _input_bits(names: Sequence[str]) -> str:
    return " ".join(names) if len(names) <= _SHOWN_BITS else f"{len(names):,}: {names[0]} … {names[-1]}"


def _circuit(templates: "Environment", name: str, network: LutNetwork) -> dict[str, Any]:
    drawing = draw(network)
    cells = {cell.name: _cell(name, i, cell, network) for i, cell in enumerate(network.cells)}
    svg = templates.get_template("schematic.svg").render(
        name=name,
        drawing=drawing,
        cells=cells,
        inputs=len(network.inputs) - len(drawing.unread),
        outputs=len(network.outputs),
    )
    return {
        "name": name,
        "luts": len(network.luts),
        "muxes": len(network.muxes),
        "depth": network.depth,
        "path": drawing.path,
        "unread": drawing.unread,
        "cells": list(cells.values()),
        "svg": Markup(svg),  # noqa: S704  # rendered by a template that escapes
    }


def _cell(part: str, position: int, cell: Lut | Mux, network: LutNetwork) -> _Cell:
    place = f"table-{part}-{position}"
    if isinstance(cell, Lut):
        kind = f"LUT{len(cell.inputs)}"
        return _Cell(place, cell.name, kind, expression(cell), contents(cell), grid(cell), cell.inputs)
    joins_luts = any(lut.name == cell.low for lut in network.luts)
    text = f"{cell.name} = {cell.select} ? {cell.high} : {cell.low}"
    kind = "MUXF7" if joins_luts else "MUXF8"
    return _Cell(place, cell.name, kind, text, None, None, cell.reads)


def _window(neighbourhood: Neighbourhood) -> list[list[str]]:
    """The names of the taps that read each pixel of a window, by row and column."""
    names: list[list[list[str]]] = [
        [[] for _ in range(neighbourhood.size)] for _ in range(neighbourhood.size)
    ]
    for name, tap in zip(neighbourhood.names, neighbourhood.taps, strict=True):
        names[tap.row][tap.column].append(name)
    return [[", ".join(cell) for cell in row] for row in names]


def _sum(parts: Mapping[str, Mapping[str, Any]]) -> str:
    """How a block comes to its LUTs, if it takes those of nine pixels and of an edge filter; with matcher."""
    names = ("block", "pixel", "edge", "match", "block_match")
    block, pixel, edge, match, whole = (parts.get(part, {}).get("luts") for part in names)
    if block is None or pixel is None or edge is None or block != 9 * pixel + edge:
        return ""
    text = f"The block is nine pixels of {pixel} and an edge filter of {edge}: {block}."
    if match is None or whole is None or whole != block + match:
        return text
    return f"{text} With match and count, of {match}, it is block_match: {whole}."


def _training(name: str, training: Mapping[str, Any]) -> str:
    """The command that trains the model again, beside the build; nothing if the model does not tell it."""
    command = training.get(COMMAND)
    return f"{command} -o {shlex.quote(f'{name}-again.json')}" if isinstance(command, str) else ""


def _notes(training: Mapping[str, Any]) -> list[tuple[str, str]]:
    texts = {key.replace("_", " "): _note(value) for key, value in training.items() if key != COMMAND}
    return [(key, text if len(text) < 160 else text[:159].rstrip() + "…") for key, text in texts.items()][
        :_NOTES
    ]


def _note(value: Any, depth: int = 0) -> str:
    if depth > _DEPTH:
        return "…"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_note(inner, depth + 1)}" for key, inner in value.items())
    if isinstance(value, Sequence) and not isinstance(value, str):
        texts = [_note(inner, depth + 1) for inner in value]
        return ", ".join(texts) if len(texts) < 9 else f"{len(texts)}: {texts[0]} … {texts[-1]}"
    return form(value, "text" if isinstance(value, str | bool) else "count")
