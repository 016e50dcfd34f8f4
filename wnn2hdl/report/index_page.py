"""Several builds on one page: sortable, charted, two of them compared, and what the gate found."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from wnn2hdl.ir import LutNetwork
from wnn2hdl.report.charts import scatter
from wnn2hdl.report.compare import compare, compare_tables
from wnn2hdl.report.gate import Check
from wnn2hdl.report.page import data_element, environment

_HEADS = (
    ("build", False),
    ("target", False),
    ("mode", False),
    ("LUTs", True),
    ("LUTs a pixel", True),
    ("accuracy", True),
    ("delay, ps", True),
    ("codes", True),
    ("coverage", True),
    ("proof", False),
)
"""Columns, and whether they hold numbers."""


REPORT = "wnn2hdl report"
"""Who makes an index, unless told otherwise; it stands in the page's head as its generator."""


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
    comparison = {}
    if pair:
        first, second = pair
        comparison = compare(first.report, second.report)
        comparison["Look-up tables"] = compare_tables(first.networks, second.networks)
    return (
        environment()
        .get_template("index.html")
        .render(
            entries=[{"name": entry.name, "link": entry.link, "cells": _cells(entry)} for entry in entries],
            heads=_HEADS,
            chart=scatter(points) if len(points) > 1 else "",
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


def _cells(entry: Entry) -> list[tuple[str | Markup, bool]]:
    report, target = entry.report, entry.report["target"]
    parts, care, proof = report["parts"], report["care"], report["proof"]["status"]
    figures = [
        (f"parts.{target}.luts", parts[target]["luts"], "count"),
        ("parts.pixel.luts", parts.get("pixel", {}).get("luts"), "count"),
        ("accuracy", report["accuracy"], "percent"),
        (f"parts.{target}.delay_ps", parts[target]["delay_ps"], "count"),
        ("care.codes", care["codes"], "count"),
        ("care.coverage", care["coverage"], "percent"),
    ]
    mark = "✓" if proof == "proved" and not entry.changes else "✗"
    return [
        (target, False),
        (report["mode"], False),
        *((data_element(key, value, kind), True) for key, value, kind in figures),
        (", ".join([f"{mark} {proof}", *entry.changes]), False),
    ]
