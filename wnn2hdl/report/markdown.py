"""`report.json` as a page for a person."""

from collections.abc import Mapping
from typing import Any

from wnn2hdl.lower.targets import TARGETS
from wnn2hdl.markdown import escaped, table
from wnn2hdl.report.page import form

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
The published figures below come from other tools and are there for orientation."""


def report_markdown(report: Mapping[str, Any]) -> str:
    """Write a report for a person.

    Args:
        report: the object of `report.json`.
    """
    sections = [
        f"# {escaped(report['name'])}",
        f"Target {report['target']}, mode {report['mode']}, proof: {escaped(_proof(report['proof']))}.",
        "## Resources, measured",
        table(
            ["part", *_COLUMNS.values()],
            ([part, *(figures[key] for key in _COLUMNS)] for part, figures in report["parts"].items()),
        ),
        f"Counted after `{report['count']}`." if report["count"] else "",
        _COUNTING,
        _utilisation(report),
        "## Published, not measured here",
        table(
            ["circuit", "LUTs", "registers", "source"],
            ([row["what"], row["luts"], row["registers"], row["source"]] for row in report["published"]),
        ),
        _answers(report),
        _minimised(report["minimised"]),
        _mapping("Seconds", "stage", report["seconds"]),
        _mapping("Options", "option", report["options"]),
        _mapping("Tools", "tool", report["tools"]),
        _mapping("SHA-256", "file", report["hashes"]),
    ]
    return "\n\n".join(section for section in sections if section) + "\n"


def _proof(proof: Mapping[str, Any]) -> str:
    method = f" by {proof['method']}" if proof["method"] else ""
    seconds = f" in {proof['seconds']:.2f} s" if proof["seconds"] is not None else ""
    failure = f": {proof['failure']}" if proof["failure"] else ""
    return f"{proof['status']}{method}{seconds}{failure}"


def _answers(report: Mapping[str, Any]) -> str:
    edges = report["edges"]
    answers: list[tuple[str, str | None]] = []
    target = TARGETS.get(report["target"])
    if target is None or target.classifies:
        answers += [
            ("accuracy of the circuit", form(report["accuracy"], "percent")),
            ("accuracy of the model", form(report["model_accuracy"], "percent")),
            ("pixel codes cared for", form(report["care"]["codes"])),
            ("share of other imagery that these codes cover", form(report["care"]["coverage"], "percent")),
        ]
    if edges["name"] is not None:
        answers += [
            ("edge patterns", f"{edges['name']}, {edges['patterns']} of 512 windows"),
            *(
                (f"{figure} of its edges against Canny's, within one pixel", form(edges[figure], "percent"))
                for figure in ("precision", "recall", "f1")
            ),
            ("measured on", edges["imagery"]),
        ]
    return f"## Answers\n\n{table(['figure', 'value'], answers)}" if answers else ""


def _utilisation(report: Mapping[str, Any]) -> str:
    parts: Mapping[str, Mapping[str, float]] = report["utilisation"]
    if not parts:
        return ""
    kinds = list(dict.fromkeys(kind for shares in parts.values() for kind in shares))
    rows = ([part, *(form(shares.get(kind), "points") for kind in kinds)] for part, shares in parts.items())
    heads = [_COLUMNS.get(kind, kind) for kind in kinds]
    return f"## Share of the {report['device']}\n\n" + table(["part", *heads], rows)


def _minimised(tables: Mapping[str, Mapping[str, int]]) -> str:
    if not tables:
        return ""
    keys = ["cubes_before", "cubes_after", "literals_before", "literals_after"]
    rows = ([name, *(sizes[key] for key in keys)] for name, sizes in tables.items())
    return "## Minimised\n\n" + table(["table", *(key.replace("_", " ") for key in keys)], rows)


def _mapping(title: str, what: str, values: Mapping[str, Any]) -> str:
    return f"## {title}\n\n" + table([what, "value"], values.items()) if values else ""
