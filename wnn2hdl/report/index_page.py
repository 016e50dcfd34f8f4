"""Several builds on one page: sortable, charted, two of them compared, and what the gate found."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from wnn2hdl.ir import LutNetwork
from wnn2hdl.report.charts import for_all_widths, scatter
from wnn2hdl.report.compare import compare, compare_tables
from wnn2hdl.report.gate import Check
from wnn2hdl.report.shell import data_element, environment

_FIGURES = {
    "LUTs": ("parts.{target}.luts", "count"),
    "LUTs per pixel": ("parts.pixel.luts", "count"),
    "accuracy": ("accuracy", "percent"),
    "delay, ps": ("parts.{target}.delay_ps", "count"),
    "codes": ("care.codes", "count"),
    "coverage": ("care.coverage", "percent"),
}
"""Columns of numbers: where they stand in a report, and what they are."""


REPORT = "wnn2hdl report"
"""What makes an index by default; it stands in the page's head as its generator."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A build for the index.

    Attributes:
        name: what it is called there; no two are equal.
        link: address of its page, relative to the index.
        report: the object of its `report.json`.
        networks: its LUT networks by part.
        changes: which of its files were changed after it was made, one line each.
    """

    name: str
    link: str
    report: Mapping[str, Any]
    networks: Mapping[str, LutNetwork]
    changes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Exhibit:
    """Something to look at beside the builds.

    Attributes:
        title: its heading.
        text: what is to be seen, one sentence.
        link: address of the whole, relative to the index.
        picture: address of a picture, relative to the index.
    """

    title: str
    text: str
    link: str
    picture: str


def index_page(
    entries: Sequence[Entry],
    pair: tuple[Entry, Entry] | None = None,
    checks: Sequence[Check] = (),
    exhibits: Sequence[Exhibit] = (),
    lead: str = "Figures as measured; a build's name leads to its report.",
    maker: str = REPORT,
) -> str:
    """The page of several builds; the same arguments give the same bytes.

    Args:
        entries: the builds.
        pair: two of them to compare.
        checks: what the gate found.
        exhibits: shown below the builds.
        lead: what these builds are, in words.
        maker: the command that makes the page.
    """
    points = [
        (entry.name, luts, accuracy)
        for entry in entries
        if (luts := entry.report["parts"][entry.report["target"]]["luts"]) is not None
        and (accuracy := entry.report["accuracy"]) is not None
    ]
    # A column that is for none of these builds would tell nothing.
    heads = [
        head for head in _FIGURES if any(_figure(entry.report, head)[1] is not None for entry in entries)
    ]
    comparison = {}
    if pair:
        first, second = pair
        comparison = compare(first.report, second.report)
        comparison["Look-up tables"] = compare_tables(first.networks, second.networks)
    return (
        environment()
        .get_template("index.html")
        .render(
            entries=[
                {"name": entry.name, "link": entry.link, "cells": _cells(entry, heads)} for entry in entries
            ],
            heads=heads,
            chart=for_all_widths(scatter, points) if len(points) > 1 else "",
            pair=[entry.name for entry in pair] if pair else (),
            comparison=comparison,
            checks=checks,
            exhibits=exhibits,
            lead=lead,
            maker=maker,
            failed=[check for check in checks if not check.passed],
        )
    )


def is_index(page: str) -> bool:
    """Whether a page is an index that `report` made, as against one of another command or of a person."""
    return f'<meta name="generator" content="{REPORT}">' in page


def _figure(report: Mapping[str, Any], head: str) -> tuple[str, Any, str]:
    """Where a figure of a column stands in a report, the figure, and what it is."""
    place, kind = _FIGURES[head]
    key = place.format(target=report["target"])
    value: Any = report
    for step in key.split("."):
        # A build of another target has no such part.
        value = value.get(step) if isinstance(value, Mapping) else None
    return key, value, kind


def _cells(entry: Entry, heads: Sequence[str]) -> list[tuple[str | Markup, bool]]:
    """The cells of a build's row after its name, and whether they hold numbers."""
    report, proof = entry.report, entry.report["proof"]["status"]
    mark = "✓" if proof == "proved" and not entry.changes else "✗"
    return [
        (report["target"], False),
        (report["mode"], False),
        *((data_element(*_figure(report, head)), True) for head in heads),
        (", ".join([f"{mark} {proof}", *entry.changes]), False),
    ]
