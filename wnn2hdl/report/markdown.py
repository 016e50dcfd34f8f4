"""`report.json` as a page for a person."""

from collections.abc import Mapping
from itertools import compress
from typing import Any

from wnn2hdl.lower.targets import TARGETS
from wnn2hdl.markdown import MISSING, escaped, table
from wnn2hdl.report.charts import published
from wnn2hdl.report.page import MANY_TABLES, light_curves, plain_options, simulations
from wnn2hdl.report.placed import NOTE, PLACED_HEADS, placed_notes, placed_rows, vivado_rows
from wnn2hdl.report.shell import form

_COLUMNS = {
    "luts": "LUTs",
    "inv": "INV",
    "muxf7": "MUXF7",
    "muxf8": "MUXF8",
    "carry4": "CARRY4",
    "srl": "SRL",
    "ffs": "FFs",
    "bram36": "BRAM36",
    "dsp": "DSP",
    "delay_ps": "delay ps",
}

_COUNTING = """\
LUTs are LUT1 to LUT6 cells (a LUT6_2 counts one) and leftover inverters; no packing of two small LUTs
into one is assumed. The inverters left in the Sobel baseline are not among its LUTs. A block RAM of
18 Kb is half a BRAM36. Delay is logic only, without routing. n/a: not measured.

**Yosys is not Vivado:** Vivado packs, places and routes, and its counts for the same Verilog may differ.
Published figures come from other tools and are there for orientation."""


def report_markdown(report: Mapping[str, Any]) -> str:
    """Write a report for a person.

    Args:
        report: the object of `report.json`.
    """
    sections = [
        f"# {escaped(report['name'])}",
        f"Target {report['target']}, mode {report['mode']}, proof: {escaped(_proof(report['proof']))}.",
        _pipeline(report),
        "## Resources, measured",
        _resources(report["parts"]),
        f"Counted after `{report['count']}`." if report["count"] else "",
        _COUNTING,
        _utilisation(report),
        _vivado(report),
        _placed(report),
        _published(report),
        _answers(report),
        _light(report),
        _minimised(report["minimised"]),
        _simulated(report["options"]),
        _mapping("Seconds", "stage", report["seconds"]),
        _mapping("Options", "option", _options(report["options"])),
        _mapping("Tools", "tool", report["tools"]),
        _mapping("SHA-256", "file", report["hashes"]),
    ]
    return "\n\n".join(section for section in sections if section) + "\n"


def _resources(parts: Mapping[str, Mapping[str, Any]]) -> str:
    """The parts of which anything was measured, by what was measured of any of them."""
    rows = {part: [figures[key] for key in _COLUMNS] for part, figures in parts.items()}
    rows = {part: row for part, row in rows.items() if any(value is not None for value in row)}
    if not rows:
        return "Nothing was measured."
    shown = [any(row[i] is not None for row in rows.values()) for i in range(len(_COLUMNS))]
    return table(
        ["part", *compress(_COLUMNS.values(), shown)],
        ([part, *compress(row, shown)] for part, row in rows.items()),
    )


def _published(report: Mapping[str, Any]) -> str:
    heads = ["circuit", "LUTs", "registers", "source"]
    rows = [[row["what"], row["luts"], row["registers"], row["source"]] for row in published(report)]
    return "## Published, not measured here\n\n" + table(heads, rows) if rows else ""


def _pipeline(report: Mapping[str, Any]) -> str:
    latency = report.get("latency")
    if not latency:
        return ""
    cycles = "1 cycle" if latency == 1 else f"{latency} cycles"
    stage = f"a stage takes {form(report['stage_ps'], 'ps')} with wires, by the delay model"
    return f"Latency {cycles}, and a new input in each; {stage}."


def _proof(proof: Mapping[str, Any]) -> str:
    method = f" by {proof['method']}" if proof["method"] else ""
    seconds = f" in {proof['seconds']:.2f} s" if proof["seconds"] is not None else ""
    failure = f": {escaped(proof['failure'])}" if proof["failure"] else ""
    unproved = f": {escaped(', '.join(proof['unproved']))}" if proof.get("unproved") else ""
    before = proof.get("before")
    earlier = f"; before, with the same Verilog and netlist: {', '.join(before)}" if before else ""
    return f"{proof['status']}{method}{seconds}{failure}{unproved}{earlier}"


def _answers(report: Mapping[str, Any]) -> str:
    edges = report["edges"]
    answers: list[tuple[str, str | None]] = []
    target = TARGETS.get(report["target"])
    answers += [
        ("accuracy of the circuit", form(report["accuracy"], "percent")),
        ("accuracy of the model", form(report["model_accuracy"], "percent")),
    ]
    rows = report.get("rows") or {}
    if rows.get("interval") is not None:
        answers += [
            (f"{what}'s 95 % interval, Wilson's", " to ".join(form(x, "percent") for x in rows[key]))
            for what, key in (("the circuit", "interval"), ("the model", "model_interval"))
        ]
        changed = f"{form(rows['changed'])} of {form(rows['count'])}"
        answers.append(("rows on which circuit and model as given differ", changed))
    pruned = report["options"].get("pruned")
    if pruned:
        tables = f"{form(pruned['tables'])} of {form(pruned['of'])}"
        answers.append(("tables pruned; the proof is about the pruned model", tables))
        if pruned["rows"] is not None:
            changed = f"{form(pruned['changed'])} of {form(pruned['rows'])}"
            answers.append(("answers that pruning changes where it was decided", changed))
    if target is None or target.classifies:
        care = report["care"]
        answers += [
            ("pixel codes cared for", form(care["codes"])),
            ("share of other imagery that these codes cover", form(care["coverage"], "percent")),
        ]
    if edges["name"] is not None:
        answers += [
            ("edge patterns", f"{edges['name']}, {form(edges['patterns'])} of 512 windows"),
            *(
                (f"{figure} of its edges against Canny's, within one pixel", form(edges[figure], "percent"))
                for figure in ("precision", "recall", "f1")
            ),
            ("measured on", form(edges["imagery"], "text")),
        ]
    answers = [(figure, value) for figure, value in answers if value != MISSING]
    return f"## Answers\n\n{table(['figure', 'value'], answers)}" if answers else ""


def _light(report: Mapping[str, Any]) -> str:
    curves = light_curves(report)
    if not curves:
        return ""
    rows = (
        [
            f"{quantity} {point['value']:g}",
            form(point["accuracy"], "percent"),
            " to ".join(form(end, "percent") for end in point["interval"] or ()) or MISSING,
            point["worst_image"]["name"],
            form(point["worst_image"]["accuracy"], "percent"),
        ]
        for quantity, points in curves.items()
        for point in points
    )
    heads = ["light", "accuracy", "95 % interval over images", "worst image", "its accuracy"]
    warning = report["light"]["warning"]
    text = f"\n\n{escaped(warning)}" if warning else ""
    return f"## In changed light\n\n{table(heads, rows)}{text}"


def _utilisation(report: Mapping[str, Any]) -> str:
    parts: Mapping[str, Mapping[str, float]] = report["utilisation"]
    if not parts:
        return ""
    kinds = list(dict.fromkeys(kind for shares in parts.values() for kind in shares))
    rows = ([part, *(form(shares.get(kind), "points") for kind in kinds)] for part, shares in parts.items())
    heads = [_COLUMNS.get(kind, kind) for kind in kinds]
    return f"## Share of the {report['device']}\n\n" + table(["part", *heads], rows)


def _vivado(report: Mapping[str, Any]) -> str:
    rows = vivado_rows(report)
    return f"## Vivado, out of context\n\n{table(['figure', 'value'], rows)}" if rows else ""


def _placed(report: Mapping[str, Any]) -> str:
    rows = placed_rows(report)
    if not rows:
        return ""
    notes = "\n".join(f"- {escaped(note)}" for note in placed_notes(report))
    return f"## Placed and routed\n\n{table(PLACED_HEADS, rows)}\n\n{notes}\n\n{NOTE}"


def _minimised(tables: Mapping[str, Mapping[str, int]]) -> str:
    if not tables:
        return ""
    keys = ["cubes_before", "cubes_after", "literals_before", "literals_after"]
    rows = ([name, *(sizes[key] for key in keys)] for name, sizes in tables.items())
    return "## Minimised\n\n" + table(["table", *(key.replace("_", " ") for key in keys)], rows)


def _simulated(options: Mapping[str, Any]) -> str:
    rows = [(part, options["simulated_vectors"][part], when) for part, when in simulations(options).items()]
    return "## Simulated against the model\n\n" + table(["part", "vectors", "when"], rows) if rows else ""


def _options(options: Mapping[str, Any]) -> dict[str, Any]:
    """The plain ones, and those of mappings that are few."""
    inner = {
        f"{key}, {name}": value
        for key, values in options.items()
        if isinstance(values, Mapping) and key != "simulated_vectors" and len(values) <= MANY_TABLES
        for name, value in values.items()
        if value is not None
    }
    return plain_options(options) | inner


def _mapping(title: str, what: str, values: Mapping[str, Any]) -> str:
    return f"## {title}\n\n" + table([what, "value"], values.items()) if values else ""
