"""Several builds on a page."""

import copy
from dataclasses import replace
from typing import Any

import pytest

from wnn2hdl.ir import LutNetwork
from wnn2hdl.report.gate import Limits, run_gate
from wnn2hdl.report.index_page import Entry, Exhibit, index_page, is_index


@pytest.fixture
def entries(report: dict[str, Any], networks: dict[str, LutNetwork]) -> tuple[Entry, Entry]:
    """A build, and the same with fewer LUTs and without an accuracy."""
    other = copy.deepcopy(report)
    other["parts"]["block"]["luts"] = 10
    return Entry("a", "a/report.html", report, networks), Entry("b", "b/report.html", other, networks)


def test_every_build_has_its_row_and_leads_to_its_page(entries: tuple[Entry, Entry]) -> None:
    page = index_page(entries)
    for entry in entries:
        assert f'<a href="{entry.link}">{entry.name}</a>' in page
    assert '<data data-key="parts.block.luts" value="19">19</data>' in page
    assert '<data data-key="parts.block.luts" value="10">10</data>' in page
    assert page.count('aria-sort="none"') == page.count('<button type="button" class="sort">') == 10


def test_columns_and_rows_that_are_for_none_of_the_builds_are_left_out(
    entries: tuple[Entry, Entry],
) -> None:
    reports = [dict(entry.report) | {"accuracy": None, "model_accuracy": None} for entry in entries]
    bare = [replace(entry, report=report) for entry, report in zip(entries, reports, strict=True)]
    page = index_page(bare, (bare[0], bare[1]))
    assert '<button type="button" class="sort">codes</button>' in page
    assert "accuracy" not in page
    assert "accuracy of the circuit" in index_page(bare, (bare[0], entries[1]))


def test_two_builds_are_compared_if_asked_for(entries: tuple[Entry, Entry]) -> None:
    assert "compared</h2>" not in index_page(entries)
    page = index_page(entries, entries)
    assert "a and b compared</h2>" in page
    assert "\N{MINUS SIGN}9, better" in page
    assert "function of pixel" in page


def test_the_gate_is_told(entries: tuple[Entry, Entry]) -> None:
    reports = {entry.name: entry.report for entry in entries}
    changes = {entry.name: entry.changes for entry in entries}
    assert "Gate:" not in index_page(entries)
    assert "All 4 checks passed." in index_page(entries, checks=run_gate(reports, changes, Limits(), None))
    page = index_page(entries, checks=run_gate(reports, changes, Limits(max_luts=10), None))
    assert "✗ failed" in page
    assert "the block takes 19 LUTs, allowed are 10" in page


def test_a_build_that_was_changed_after_its_proof_is_marked(entries: tuple[Entry, Entry]) -> None:
    assert "<td>✓ proved</td>" in index_page(entries[:1])
    page = index_page([replace(entries[0], changes=("block.v was changed",))])
    assert "<td>✗ proved, block.v was changed</td>" in page


def test_an_index_of_report_is_told_from_that_of_another_command(entries: tuple[Entry, Entry]) -> None:
    assert is_index(index_page(entries))
    assert not is_index(index_page(entries, maker="wnn2hdl demo"))
    assert not is_index("<p>wnn2hdl report</p>")


def test_accuracies_are_charted_where_two_builds_have_one(entries: tuple[Entry, Entry]) -> None:
    assert 'class="chart"' in index_page(entries)
    report = dict(entries[1].report) | {"accuracy": None}
    unmeasured = Entry("b", "b/report.html", report, entries[1].networks)
    page = index_page([entries[0], unmeasured])
    assert 'class="chart"' not in page
    assert '<data data-key="accuracy" value="null">n/a</data>' in page


def test_exhibits_show_their_picture_and_lead_to_the_whole(entries: tuple[Entry, Entry]) -> None:
    assert "At work" not in index_page(entries)
    page = index_page(entries, exhibits=[Exhibit("Map", "Half is <cleared>.", "map/all.md", "map/it.png")])
    assert "At work</h2>" in page
    assert 'href="map/all.md"' in page
    assert 'src="map/it.png"' in page
    assert "Half is &lt;cleared&gt;." in page


def test_names_are_escaped(entries: tuple[Entry, Entry]) -> None:
    hostile = Entry("<b>x", "x/report.html", entries[0].report, entries[0].networks)
    assert "<b>x" not in index_page([hostile, entries[1]], (hostile, entries[1]))


def test_the_reader_is_told_what_the_builds_are(entries: tuple[Entry, Entry]) -> None:
    assert "Figures as measured" in index_page(entries)
    page = index_page(entries, lead="Of <generated> landscapes.")
    assert '<p class="lead">Of &lt;generated&gt; landscapes.</p>' in page
