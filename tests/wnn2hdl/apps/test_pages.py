"""The pages of flights and scans as Chromium shows them, and what all pages have in common."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import Page

from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.scanning import Scanner
from wnn2hdl.apps.navigation.flight import FlightRun, run_flight
from wnn2hdl.apps.navigation.recording import Recording, split
from wnn2hdl.apps.navigation.summary import write_run
from wnn2hdl.build.reporting import open_entries
from wnn2hdl.images import write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.report import index_page
from wnn2hdl.samples import landscape

if TYPE_CHECKING:
    from wnn2hdl.apps.navigation.results import SearchKind

pytestmark = [pytest.mark.browser, pytest.mark.slow]

METHODS = ["perspective-weightless", "grey"]


@pytest.fixture(scope="module")
def flight() -> FlightRun:
    recording = Recording.embedded(0)
    calibrating, scored = split(recording.poses, 4)
    searches: dict[SearchKind, float | None] = {"window": 95.0, "map": None}
    return run_flight(recording.scoring(scored), calibrating, searches, lambda *_: None, keys=METHODS, jobs=1)


@pytest.fixture(scope="module")
def flown(flight: FlightRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a flight."""
    folder = tmp_path_factory.mktemp("flight")
    write_run(flight, folder)
    return folder / "flight.html"


@pytest.fixture(scope="module")
def mapped(model: WisardModel, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a scan of two pictures."""
    folder = tmp_path_factory.mktemp("scan")
    (folder / "pictures").mkdir()
    model.save(folder / "model.json")
    for seed in range(2):
        write_png(folder / "pictures" / f"no {seed}.png", landscape(60, 80, seed).image)
    scanner = Scanner.open(
        folder / "model.json", ScanOptions(), lambda *a: run_locally(1, *a), lambda *_: None
    )
    scanner.scan(folder / "pictures", folder / "out")
    return folder / "out" / "summary.html"


@pytest.mark.parametrize("width", [360, 768, 1180])
@pytest.mark.parametrize("which", ["flown", "mapped"])
def test_pages_fit_the_window_and_paper(
    open_page: Callable[..., Page], which: str, width: int, request: pytest.FixtureRequest
) -> None:
    path = request.getfixturevalue(which)
    page = open_page(path)
    page.set_viewport_size({"width": width, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    # What was found stands above the fold.
    bottom = page.locator("dl.figures").bounding_box()
    assert bottom is not None
    assert bottom["y"] + bottom["height"] < 844
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 688, "height": 1000})
    assert page.evaluate("document.documentElement.scrollWidth") <= 688


def test_marks_of_a_flight_tell_frames_and_errors(
    open_page: Callable[..., Page], flown: Path, flight: FlightRun
) -> None:
    page = open_page(flown)
    row = flight.rows(flight.result.searches[0])["perspective-weightless"]
    fixes = row.fixes
    drawing = page.locator("#window_95m svg.plot")
    drawing.focus()
    told = []
    for _ in range(3 * len(fixes)):
        page.keyboard.press("ArrowRight")
        told.append(page.locator(".tip").inner_text())
    assert told[: len(fixes)] == [f"{fix.frame}: truth" for fix in fixes]
    assert told[len(fixes) : 2 * len(fixes)] == [
        f"{fix.frame}, {row.name}, {fix.error_m:.1f} m off, {'a fix' if fix.fixed else 'no fix'}"
        for fix in fixes
    ]
    page.keyboard.press("Escape")
    assert page.locator(".tip").count() == 0
    bar = page.locator("#errors .mark[data-tip*='weightless: ']").first
    bar.dispatch_event("pointerenter")
    assert page.locator(".tip").inner_text() == f"{row.name}: {row.mean_m:.1f} ± {row.std_m:.1f} m"
    box = page.locator(".tip").bounding_box()
    assert box is not None
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 1180


def test_marks_lie_where_the_fixes_are(
    open_page: Callable[..., Page], flown: Path, flight: FlightRun
) -> None:
    """Distances between marks are those of the positions, by the picture's scale."""
    circles = open_page(flown).locator("#map svg.plot circle.truth")
    marks = circles.evaluate_all("x => x.map(y => [y.cx.baseVal.value, y.cy.baseVal.value])")
    fixes = flight.result.searches[1].methods[0].fixes
    rows, columns = flight.grid.to_pixel(
        [fix.truth_latitude or 0.0 for fix in fixes], [fix.truth_longitude or 0.0 for fix in fixes]
    )
    drawn, meant = np.diff(np.array(marks), axis=0), np.diff(np.stack([columns, rows], axis=1), axis=0)
    scale = np.linalg.norm(drawn) / np.linalg.norm(meant)
    assert np.abs(drawn - scale * meant).max() < 0.2


def test_tables_sort(open_page: Callable[..., Page], flown: Path) -> None:
    page = open_page(flown)
    table = page.locator("table.sortable").first
    head = table.locator("th", has_text="mean, m").first
    for direction in ("ascending", "descending"):
        head.locator("button").click()
        values = table.locator("tbody tr td:nth-child(2) data").evaluate_all(
            "x => x.map(y => Number(y.value))"
        )
        assert values == sorted(values, reverse=direction == "descending")
        assert head.get_attribute("aria-sort") == direction


def test_pages_lead_back_to_what_led_to_them(open_page: Callable[..., Page], mapped: Path) -> None:
    page = open_page(mapped)
    assert not page.locator("a.up").is_visible()
    page.get_by_role("link", name="no 1.png").click()
    assert page.locator("h1").inner_text() == "no 1.png"
    assert page.locator("img.map").evaluate("x => x.naturalWidth") == 80
    page.locator("a.up").click()
    assert page.locator("h1").inner_text() == "pictures"


def test_an_index_is_found_again_whatever_its_folder_is_called(
    open_page: Callable[..., Page], write_build: Callable[..., Path], tmp_path: Path
) -> None:
    index = tmp_path / "all & everything" / "index.html"
    index.parent.mkdir()
    folders = [write_build(tmp_path / "some builds" / name) for name in "ab"]
    index.write_text(index_page(open_entries(folders, index)))
    page = open_page(index)
    page.get_by_role("link", name="b", exact=True).click()
    page.locator("a.up").click()
    assert page.locator("h1").inner_text() == "2 builds"


@pytest.mark.parametrize(
    "index", ["javascript:alert(1)//x.html", "//elsewhere/x.html", "/x.html", "https://x/y.html", "x.txt"]
)
def test_only_a_page_beside_is_led_back_to(open_page: Callable[..., Page], mapped: Path, index: str) -> None:
    page = open_page(mapped)
    page.goto(f"{mapped.as_uri()}?index={index}")
    assert not page.locator("a.up").is_visible()
    assert page.locator("a.up").get_attribute("href") is None
