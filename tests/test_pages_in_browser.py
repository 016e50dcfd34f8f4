"""The pages as Chromium shows them: figures, tables of LUTs on hover and focus, sorting, both themes."""

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Page

from wnn2hdl.apps.sweep import Recipe, draw, present, run_locally, run_sweep
from wnn2hdl.apps.sweep import grid as sweep_grid
from wnn2hdl.build.design import Design
from wnn2hdl.build.reporting import open_entries, write_page
from wnn2hdl.dataset import from_masks
from wnn2hdl.encode import high_bits
from wnn2hdl.ir import LutNetwork
from wnn2hdl.report import Care, ModelFigures, index_page
from wnn2hdl.report.logic import expression, grid
from wnn2hdl.report.shell import form
from wnn2hdl.samples.landscapes import IMAGES, MASKS, write_landscapes

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture(scope="module")
def folder(write_build: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A build with its page."""
    made = write_build(tmp_path_factory.mktemp("builds") / "a")
    write_page(made)
    return made


CUT_OFF = """[...document.querySelectorAll('main *')]
  .filter(x => x.scrollWidth > x.clientWidth + 1)
  .filter(x => ['auto', 'scroll'].includes(getComputedStyle(x).overflowX))
  .map(x => [x.className, x.tabIndex === 0 || x.querySelector('[tabindex="0"], a, button') !== null])"""
"""What holds more than it shows, and whether the keyboard gets there."""


@pytest.fixture
def network(folder: Path) -> LutNetwork:
    """The network of the pixel classifier."""
    return Design.load(folder).networks["pixel"]


def at(report: Any, key: str) -> Any:
    for step in key.split("."):
        report = report[int(step)] if isinstance(report, list) else report[step]
    return report


def test_every_figure_shown_is_that_of_the_report(open_page: Callable[..., Page], folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text())
    shown = open_page(folder / "report.html").evaluate(
        "[...document.querySelectorAll('data[data-key]')].map(x => [x.dataset.key, x.value, x.innerText])"
    )
    assert len(shown) > 30
    for key, value, _ in shown:
        assert json.loads(value) == at(report, key), key
    texts = {key: text for key, _, text in shown}
    assert texts["parts.block.luts"] == form(report["parts"]["block"]["luts"])
    assert texts["accuracy"] == "90.00 %"


def test_bars_of_saturation_are_as_high_as_their_figures(
    open_page: Callable[..., Page], folder: Path
) -> None:
    bars = open_page(folder / "report.html").evaluate(
        """[...document.querySelectorAll('.strip span')].map(x => [Number(x.dataset.value),
        parseFloat(getComputedStyle(x, '::after').height) / x.clientHeight])"""
    )
    report = json.loads((folder / "report.json").read_text())
    assert [value for value, _ in bars] == [
        share for shares in report["model"]["saturation"] for share in shares
    ]
    assert all(abs(value - height) < 0.02 for value, height in bars)


@pytest.mark.parametrize("way", ["hover", "focus", "press"])
def test_a_lut_shows_its_table(
    open_page: Callable[..., Page], folder: Path, network: LutNetwork, way: str
) -> None:
    page = open_page(folder / "report.html")
    bench = page.locator(".bench").first
    panel = bench.locator(".inspector")
    assert network.cells[0].name in panel.locator("h4").inner_text()
    for lut in network.luts[:3]:
        box = bench.locator(f".cell[data-name='{lut.name}']")
        if way == "hover":
            box.hover()
        elif way == "focus":
            box.focus()
        else:
            box.dispatch_event("click")
        assert f"{lut.name} = {expression(lut)}" in panel.inner_text()
        cells = panel.locator("tbody td").all_inner_texts()
        assert list(map(int, cells)) == [value for _, row in grid(lut).rows for value in row]
        assert box.get_attribute("aria-pressed") == "true"
        assert bench.locator(".cell[aria-pressed='true']").count() == 1
        lit = bench.locator(".wire.lit").count()
        readers = sum(lut.name in other.inputs for other in network.luts)
        readers += sum(lut.name in (mux.low, mux.high, mux.select) for mux in network.muxes)
        readers += sum(signal == lut.name for _, signal in network.outputs)
        assert lit == len(set(lut.inputs)) + readers


def test_keys_move_from_lut_to_lut(open_page: Callable[..., Page], folder: Path) -> None:
    page = open_page(folder / "report.html")
    names = page.locator(".bench").first.locator(".cell").evaluate_all("x => x.map(y => y.dataset.name)")
    focused = "document.activeElement.dataset.name"
    for _ in range(100):
        page.keyboard.press("Tab")
        if page.evaluate(focused) is not None:
            break
    assert page.evaluate(focused) == names[0]
    page.keyboard.press("Tab")
    assert page.evaluate(focused) == names[1]
    page.keyboard.press("ArrowLeft")
    assert page.evaluate(focused) == names[0]
    page.keyboard.press("ArrowLeft")
    assert page.evaluate(focused) == names[-1]
    assert names[-1] in page.locator(".inspector h4").first.inner_text()


def test_both_themes_and_the_button_between_them(open_page: Callable[..., Page], folder: Path) -> None:
    def lightness(page: Page, what: str, key: str) -> float:
        colour = page.evaluate(f"getComputedStyle(document.querySelector('{what}')).{key}")
        red, green, blue = (int(x) for x in colour.removeprefix("rgb(").rstrip(")").split(", "))
        return (red + green + blue) / 765

    places = [
        ("body", "backgroundColor"),
        ("body", "color"),
        (".chart text", "fill"),
        (".schematic text", "fill"),
    ]
    light = open_page(folder / "report.html", "light")
    dark = open_page(folder / "report.html", "dark")
    assert [lightness(light, *place) > 0.5 for place in places] == [True, False, False, False]
    assert [lightness(dark, *place) > 0.5 for place in places] == [False, True, True, True]
    assert light.locator("button.theme").inner_text() == "Dark theme"
    light.locator("button.theme").click()
    assert [lightness(light, *place) > 0.5 for place in places] == [False, True, True, True]
    assert light.locator("button.theme").inner_text() == "Light theme"
    light.emulate_media(media="print")
    assert [lightness(light, *place) > 0.5 for place in places[1:]] == [False, False, False]


@pytest.mark.parametrize("width", [360, 768, 1180])
def test_nothing_sticks_out_of_the_window(open_page: Callable[..., Page], folder: Path, width: int) -> None:
    page = open_page(folder / "report.html")
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("width", [360, 1180])
def test_many_classes_do_not_stick_out_either(
    open_page: Callable[..., Page], write_build: Callable[..., Path], tmp_path: Path, width: int
) -> None:
    folder = write_build(tmp_path / "kinds")
    report = json.loads((folder / "report.json").read_text())
    report["model"]["classes"] = [f"kind of ground {number}" for number in range(8)]
    report["confusion"] = [[123_456] * 8] * 8
    (folder / "report.json").write_text(json.dumps(report))
    write_page(folder)
    page = open_page(folder / "report.html")
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.locator("table.confusion td[style]").count() == 64


SHOWN_CHARTS = """[...document.querySelectorAll('svg.chart, svg.overview')]
  .filter(x => x.getBoundingClientRect().width > 0)
  .map(x => [x.getAttribute('aria-label'), Math.min(...[...x.querySelectorAll('text')].map(t =>
     parseFloat(getComputedStyle(t).fontSize) * x.getScreenCTM().a)),
     Math.max(...[...x.querySelectorAll('text')].map(t => t.getBoundingClientRect().right))])"""
"""Of each chart that is shown: what it is, its smallest letters in pixels, and where its last letter ends."""


@pytest.mark.parametrize("width", [360, 400, 760, 780, 1280])
def test_charts_fit_the_window_in_letters_that_can_be_read(
    open_page: Callable[..., Page], folder: Path, index: Path, width: int
) -> None:
    for path, charts in ((folder / "report.html", 2), (index, 1)):
        page = open_page(path)
        page.set_viewport_size({"width": width, "height": 800})
        found = page.evaluate(SHOWN_CHARTS)
        assert len(found) == charts
        for label, letters, end in found:
            assert 8 <= letters <= 17, label
            assert end <= width, label


@pytest.mark.parametrize("width", [360, 1280])
def test_ten_classes_fit_a_screen(
    open_page: Callable[..., Page], write_build: Callable[..., Path], tmp_path: Path, width: int
) -> None:
    digits = ModelFigures(tuple("0123456789"), None, None, ("R7",), None, ())
    path = write_page(write_build(tmp_path / "digits", model=digits, confusion=((9_800,) * 10,) * 10))
    page = open_page(path)
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    table = "(x => x.scrollWidth <= x.clientWidth)(document.querySelector('table.confusion').parentElement)"
    assert page.evaluate(table) == (width == 1280)


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a small sweep."""
    folder = tmp_path_factory.mktemp("sweep")
    write_landscapes(folder, 4, 64, seed=0, progress=lambda *_: None)
    dataset = from_masks(folder / IMAGES, folder / MASKS)
    plan = sweep_grid(Recipe(0, high_bits().bits, None, 1), (2, 3), (3, 4), 3)
    sets = draw(dataset, pixels=500, seed=0, progress=lambda *_: None)
    outcome = run_sweep(sets, plan, folder / "out", run_locally, lambda *_: None, finalist_trials=3)
    return present(outcome, sets, folder / "out")


@pytest.mark.parametrize("width", [360, 400, 1280])
def test_the_page_of_a_sweep_fits_the_window(open_page: Callable[..., Page], sweep: Path, width: int) -> None:
    page = open_page(sweep)
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert all(reached for _, reached in page.evaluate(CUT_OFF))
    over = "[...document.querySelectorAll('.figures .value')].filter(x => x.scrollWidth > x.clientWidth + 1)"
    assert page.evaluate(f"{over}.map(x => x.textContent)") == []
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 688, "height": 1000})
    assert page.evaluate("document.documentElement.scrollWidth") <= 688


def test_plots_have_the_theme_of_the_page(open_page: Callable[..., Page], sweep: Path) -> None:
    def corner(page: Page) -> list[int]:
        shot = page.locator(".plots figure").first.screenshot()
        colour = Image.open(io.BytesIO(shot)).convert("RGB").getpixel((2, 2))
        assert isinstance(colour, tuple)
        return list(colour)

    light, dark = open_page(sweep, "light"), open_page(sweep, "dark")
    assert min(corner(light)) > 240
    assert max(corner(dark)) < 40
    light.locator("button.theme").click()
    assert max(corner(light)) < 40
    dark.emulate_media(media="print")
    assert min(corner(dark)) > 240


def test_the_front_of_a_sweep_sorts(open_page: Callable[..., Page], sweep: Path) -> None:
    page = open_page(sweep)
    table = page.locator("table.sortable").first
    head = table.locator("th", has_text="accuracy of the circuit")
    column = "x => x.map(y => Number(y.value))"
    for direction in ("ascending", "descending"):
        head.locator("button").click()
        values = table.locator("td:nth-child(2) data").evaluate_all(column)
        assert values == sorted(values, reverse=direction == "descending")
        assert head.get_attribute("aria-sort") == direction


BROKEN = """[...document.querySelectorAll(
    'main data, main .number, main table.counted td, main .confusion small')]
  .filter(x => !x.closest('td.mono')).filter(x => {
    const range = document.createRange();
    range.selectNodeContents(x);
    const lines = [...range.getClientRects()].filter(r => r.width > 0).map(r => [r.top, r.bottom]);
    return lines.some(([top]) => lines.some(([, bottom]) => bottom <= top + 1));
  }).map(x => x.textContent)"""
"""Figures that stand on more than one line."""


@pytest.mark.parametrize("width", [360, 480, 1180])
def test_no_figure_is_broken_into_lines(
    open_page: Callable[..., Page], write_build: Callable[..., Path], tmp_path: Path, width: int
) -> None:
    kinds = ModelFigures(
        tuple(f"kind of ground {number}" for number in range(6)), 3, 6, ("R7",), 1, ((0.5,),) * 6
    )
    confusion = ((114_022,) * 6,) * 6
    folders = [
        write_build(tmp_path / name, model=kinds, confusion=confusion, accuracy=accuracy, **figures)
        for name, accuracy, figures in (
            ("before", 0.912, {"utilisation": {"block": {"luts": 0.0357, "ffs": 0.0}}}),
            ("after", 0.8654, {"care": Care(1_234_567, 0.5, 16_777_216)}),
        )
    ]
    index = tmp_path / "index.html"
    entries = open_entries(folders, index)
    index.write_text(index_page(entries, (entries[0], entries[1])))
    for path in (index, *(folder / "report.html" for folder in folders)):
        page = open_page(path)
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate(BROKEN) == [], path


def test_texts_stand_out_from_their_ground(open_page: Callable[..., Page], folder: Path) -> None:
    # WCAG 2.1, contrast of 4.5 to 1 for text; the variables are all the colours that the page has.
    script = """() => {
      const probe = document.body.appendChild(document.createElement('i'));
      const colour = name => {
        probe.style.color = `var(--${name})`;
        const parts = getComputedStyle(probe).color.match(/[\\d.]+/g).slice(0, 3).map(x => x / 255);
        const linear = parts.map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
      };
      const ratio = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      const pairs = [['ink', 'paper'], ['ink', 'sheet'], ['ink', 'tint'], ['muted', 'paper'],
        ['muted', 'sheet'], ['accent', 'paper'], ['accent', 'tint'], ['warn', 'warn-tint'],
        ['ink', 'warn-tint'], ['bad', 'paper'], ['bad', 'bad-tint'], ['ink', 'bad-tint']];
      return pairs.map(([a, b]) => [a, b, ratio(colour(a), colour(b))]);
    }"""
    for scheme in ("light", "dark"):
        for ink, ground, ratio in open_page(folder / "report.html", scheme).evaluate(script):
            assert ratio >= 4.5, (scheme, ink, ground)


def test_figures_stand_out_from_the_shades_of_the_confusion(
    open_page: Callable[..., Page], folder: Path
) -> None:
    # 4.5 to 1 again, where the ground is a mixture.
    script = """() => {
      const luminance = colour => {
        const whole = colour.startsWith('rgb') ? 255 : 1;
        const parts = colour.match(/[\\d.]+/g).slice(0, 3).map(x => x / whole);
        const linear = parts.map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
      };
      return [...document.querySelectorAll('.confusion td small')].map(small => {
        const ink = getComputedStyle(small).color;
        if (ink.includes('/')) throw new Error(`${ink} is not opaque`);
        const ground = getComputedStyle(small.parentElement).backgroundColor;
        const [a, b] = [luminance(ink), luminance(ground)];
        return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      });
    }"""
    for scheme in ("light", "dark"):
        ratios = open_page(folder / "report.html", scheme).evaluate(script)
        assert len(ratios) == 4
        assert min(ratios) >= 4.5, scheme


@pytest.fixture
def index(write_build: Callable[..., Path], tmp_path: Path) -> Path:
    """The index of two builds, compared."""
    folders = [write_build(tmp_path / name, command=f"wnn2hdl compile {'x' * 200}") for name in "ab"]
    entries = open_entries(folders, tmp_path / "index.html")
    (tmp_path / "index.html").write_text(index_page(entries, (entries[0], entries[1])))
    return tmp_path / "index.html"


def test_nothing_is_cut_off_on_paper(open_page: Callable[..., Page], index: Path) -> None:
    for path in (index, index.parent / "a" / "report.html"):
        page = open_page(path)
        page.emulate_media(media="print")
        # A4 between its margins, at 96 pixels an inch.
        page.set_viewport_size({"width": 688, "height": 1000})
        assert page.evaluate("document.documentElement.scrollWidth") <= 688, path
        assert page.evaluate(CUT_OFF) == [], path


def test_what_scrolls_is_reached_by_keys(open_page: Callable[..., Page], index: Path) -> None:
    for path in (index, index.parent / "a" / "report.html"):
        page = open_page(path)
        page.set_viewport_size({"width": 360, "height": 800})
        scrolling = page.evaluate(CUT_OFF)
        assert scrolling, path
        assert all(reached for _, reached in scrolling), (path, scrolling)


def test_columns_of_the_index_sort_by_mouse_and_keyboard(
    open_page: Callable[..., Page], write_build: Callable[..., Path], tmp_path: Path
) -> None:
    accuracies = {"a": 0.9, "b": None, "c": 0.95, "d": 0.1}
    folders = [write_build(tmp_path / name, accuracy=value) for name, value in accuracies.items()]
    index = tmp_path / "index.html"
    index.write_text(index_page(open_entries(folders, index)))
    page = open_page(index)
    heading = page.locator("th", has_text="accuracy")

    def order() -> str:
        return "".join(page.locator("tr[data-build]").evaluate_all("x => x.map(y => y.dataset.build)"))

    assert order() == "abcd"
    heading.locator("button").click()
    assert (order(), heading.get_attribute("aria-sort")) == ("dacb", "ascending")
    heading.locator("button").focus()
    page.keyboard.press("Enter")
    assert (order(), heading.get_attribute("aria-sort")) == ("cadb", "descending")
    first = page.locator("th", has_text="build")
    first.locator("button").click()
    assert (order(), heading.get_attribute("aria-sort")) == ("abcd", "none")
    page.get_by_role("link", name="c", exact=True).click()
    assert page.locator("h1").inner_text() == "c"


def test_marks_of_charts_and_plots_tell_their_values_when_pointed_at(
    open_page: Callable[..., Page], folder: Path, sweep: Path
) -> None:
    report = json.loads((folder / "report.json").read_text())
    page = open_page(folder / "report.html")
    page.locator("svg.chart:not(.narrow) .mark").first.hover()
    assert (
        page.locator(".tip").inner_text() == f"pixel: {report['parts']['pixel']['luts']} LUTs, measured here"
    )
    page = open_page(sweep)
    for mark in page.locator(".plots .mark").all():
        mark.hover(timeout=5000)
        assert page.locator(".tip").inner_text() == mark.get_attribute("data-tip")
    assert "2 address bits, 3 RAMs" in page.locator(".plots").first.inner_html()
