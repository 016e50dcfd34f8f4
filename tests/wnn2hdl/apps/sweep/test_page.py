from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

from wnn2hdl.apps.sweep.grid import Plan, grid
from wnn2hdl.apps.sweep.page import present, write_page
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.study import run_sweep
from wnn2hdl.apps.sweep.trial import run_trials


class Outline(HTMLParser):
    """Collects tags and text, and checks that what is opened is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.drawings: list[str] = []
        self.marks = 0
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "svg" and given["class"] == "plot":
            self.drawings.append(given["aria-label"] or "")
        self.marks += given.get("class") == "mark"
        if tag not in ("meta", "link"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += " ".join(data.split()) + " "


def page(sets: PixelSets, plan: Plan, folder: Path, pictures: tuple[str, ...]) -> Outline:
    outcome = run_sweep(
        sets,
        plan,
        folder,
        lambda sets, trials: iter([run_trials(sets, trials)]),
        lambda *_: None,
        finalist_trials=2,
    )
    outline = Outline()
    outline.feed(write_page(outcome, sets, pictures, folder).read_text(encoding="utf-8"))
    assert outline.open == []
    return outline


def test_the_page_tells_the_outcome_and_carries_its_pictures(
    sets: PixelSets, plan: Plan, tmp_path: Path
) -> None:
    (tmp_path / "contour.svg").write_text('<svg viewBox="0 0 9 9"></svg>')
    outline = page(sets, plan, tmp_path, ("contour",))
    assert outline.drawings == ["The same as a contour, finalists marked."]
    assert "18 trials over 6 architectures, trained on 2,000 pixels of 2 images" in outline.text
    assert "Chosen: 3 address bits, " in outline.text
    assert "Beyond the grid" not in outline.text


def test_a_sweep_of_failures_still_has_a_page(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    failing = grid(replace(plan.recipe, bits=("R7",)), [2], [2], trials=2)
    outline = page(sets, failing, tmp_path, ())
    assert "0 are valid" in outline.text
    assert "2 failed" in outline.text


def test_presenting_a_sweep_draws_what_its_page_shows(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    outcome = run_sweep(
        sets,
        plan,
        tmp_path,
        lambda sets, trials: iter([run_trials(sets, trials)]),
        lambda *_: None,
        finalist_trials=2,
    )
    outline = Outline()
    outline.feed(present(outcome, sets, tmp_path).read_text(encoding="utf-8"))
    assert len(outline.drawings) == len(list(tmp_path.glob("*.svg")))
    # Of both contours each architecture, of the histograms their bars, of the fronts their circuits.
    assert outline.marks > 2 * len(outcome.plan.cells)


def test_no_name_of_an_image_changes_the_page(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    hostile = "=1|</script>\n#`\"'*/" + "x" * 5000
    renamed = replace(sets, training_images=(hostile, "b"), held_out_images=(hostile + "c", "d"))
    pages = []
    for number, some in enumerate((sets, renamed)):
        page(some, plan, tmp_path / str(number), ())
        pages.append((tmp_path / str(number) / "index.html").read_bytes())
    assert pages[0] == pages[1]
