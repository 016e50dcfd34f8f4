"""What the gate found, for people in a merge request and for the readers of build servers."""

from collections.abc import Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

from wnn2hdl.errors import printable
from wnn2hdl.markdown import MISSING, Align, escaped, table
from wnn2hdl.report.baseline import Recorded, recorded
from wnn2hdl.report.gate import Check
from wnn2hdl.report.shell import form

VERSION = 1
"""Of the form of `gate_json`; it rises when a key changes its meaning or goes away."""


def gate_json(reports: Mapping[str, Mapping[str, Any]], checks: Sequence[Check]) -> dict[str, Any]:
    """A JSON object: ``passed``, the figures of each of the ``builds``, and all ``checks``."""
    return {
        "format": "wnn2hdl-gate",
        "version": VERSION,
        "passed": all(check.passed for check in checks),
        "builds": [
            {
                "name": name,
                "target": report["target"],
                "mode": report["mode"],
                "luts": dict(recorded(report).luts),
                "accuracy": report["accuracy"],
                "proof": report["proof"]["status"],
            }
            for name, report in reports.items()
        ],
        "checks": [
            {"build": check.build, "name": check.name, "passed": check.passed, "text": check.text}
            for check in checks
        ],
    }


def gate_markdown(
    reports: Mapping[str, Mapping[str, Any]],
    checks: Sequence[Check],
    baseline: Mapping[str, Recorded] | None,
) -> str:
    """A short page: a table of the builds, then every reason to fail and everything that got better."""
    failed = [check for check in checks if not check.passed]
    title = f"✗ failed, {len(failed)} of" if failed else "✓ passed,"
    title += f" {len(checks)} checks"
    bad = {check.build for check in failed}
    befores = [baseline.get(name) if baseline else None for name in reports]
    luts = [form(report["parts"][report["target"]]["luts"]) for report in reports.values()]
    luts_before = [form(before.luts.get(before.target) if before else None) for before in befores]
    accuracies = [form(report["accuracy"], "percent") for report in reports.values()]
    accuracies_before = [form(before.accuracy if before else None, "percent") for before in befores]
    figures = [
        ("LUTs", luts),
        ("baseline", luts_before),
        ("accuracy", accuracies),
        ("baseline", accuracies_before),
    ]
    # A column in which nothing was measured would tell nothing.
    figures = [(head, cells) for head, cells in figures if set(cells) != {MISSING}]
    columns = [
        ("build", list(reports)),
        ("result", ["✗ failed" if name in bad else "✓ passed" for name in reports]),
        *figures,
        ("proof", [report["proof"]["status"] for report in reports.values()]),
    ]
    heads, cells = zip(*columns, strict=True)
    right: list[Align] = ["right"] * len(figures)
    lines = [
        f"### wnn2hdl: {title}",
        "",
        table(heads, zip(*cells, strict=True), ["left", "left", *right, "left"]),
    ]
    lines += _list("Why it failed", failed)
    lines += _list("Better than the baseline; `--write-baseline` records it", [c for c in checks if c.better])
    return "\n".join(lines) + "\n"


def gate_junit(checks: Sequence[Check]) -> str:
    """JUnit XML: a suite for each build, a case for each check, and for a failed one the reason, twice.

    Control characters, of which XML cannot hold all, are escaped as Python does it. All characters are ASCII,
    others being references, so that it is right in whatever encoding it is printed.
    GitLab names a case by its ``classname`` and ``name``, shows the text of ``failure`` and not its
    ``message`` (docs.gitlab.com/ci/testing/unit_test_reports); readers for GitHub show the ``message``.
    """
    root = ET.Element("testsuites", _counts(checks) | {"name": "wnn2hdl"})
    for build in dict.fromkeys(check.build for check in checks):
        own = [check for check in checks if check.build == build]
        suite = ET.SubElement(root, "testsuite", _counts(own) | {"name": printable(build)})
        for check in own:
            names = {"classname": f"wnn2hdl.{build}", "name": f"{build}: {check.name}"}
            attributes = {key: printable(value) for key, value in names.items()}
            case = ET.SubElement(suite, "testcase", attributes | {"time": "0"})
            if not check.passed:
                text = printable(f"{build}: {check.name}: {check.text}")
                ET.SubElement(case, "failure", message=text, type="gate").text = text
    ET.indent(root, " ")
    body = ET.tostring(root, encoding="us-ascii", xml_declaration=False).decode()
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _counts(checks: Sequence[Check]) -> dict[str, str]:
    failures = sum(not check.passed for check in checks)
    return {"tests": str(len(checks)), "failures": str(failures), "errors": "0", "time": "0"}


def _list(title: str, checks: Sequence[Check]) -> list[str]:
    if not checks:
        return []
    items = [f"- **{escaped(check.build)}**, {check.name}: {escaped(check.text)}" for check in checks]
    return ["", f"{title}:", "", *items]
