"""`report` as a user and a build server meet it."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from wnn2hdl.report import PartFigures, Proof

Run = Callable[..., Any]


@pytest.fixture
def report(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """The command in its own folder."""
    monkeypatch.chdir(tmp_path)
    return partial(run, "report")


@pytest.fixture
def builds(write_build: Callable[..., Path], tmp_path: Path) -> tuple[Path, Path]:
    """Two equal builds: build/a and build/b."""
    write_build(tmp_path / "build" / "a")
    write_build(tmp_path / "build" / "b", accuracy=0.91)
    return Path("build/a"), Path("build/b")


def test_one_build_gets_its_page(report: Run, builds: tuple[Path, Path]) -> None:
    status, out, _ = report(builds[0])
    assert (status, out) == (0, "build/a/report.html\n")
    assert Path("build/a/report.html").read_text().startswith("<!DOCTYPE html>")
    assert not Path("build/index.html").exists()


def test_several_get_an_index_and_two_are_compared(report: Run, builds: tuple[Path, Path]) -> None:
    status, out, _ = report(*builds)
    assert (status, out.split()) == (0, ["build/a/report.html", "build/b/report.html", "build/index.html"])
    page = Path("build/index.html").read_text()
    assert "a and b compared" in page
    assert '<a href="a/report.html?index=../index.html">' in page


def test_any_two_of_several_are_compared(
    report: Run, builds: tuple[Path, Path], write_build: Callable[..., Path], tmp_path: Path
) -> None:
    third = write_build(tmp_path / "c")
    assert report(*builds, third, "-o", "pages/i.html", "--compare", third, builds[0])[0] == 0
    page = Path("pages/i.html").read_text()
    assert "c and a compared" in page
    assert '<a href="../build/a/report.html?index=../../pages/i.html">' in page
    report(*builds, third, "-o", "pages/i.html")
    assert "compared</h2>" not in Path("pages/i.html").read_text()


def test_what_is_no_build_is_passed_over(report: Run, builds: tuple[Path, Path]) -> None:
    Path("build/model.json").write_text("{}")
    Path("build/pictures").mkdir()
    status, out, err = report(*sorted(Path("build").iterdir()))
    assert status == 0
    assert "build/index.html" in out
    assert err == "wnn2hdl: skipped, since it is not a build: build/model.json build/pictures\n"


def test_a_baseline_holds_until_a_build_gets_worse(
    report: Run, builds: tuple[Path, Path], write_build: Callable[..., Path], tmp_path: Path
) -> None:
    assert report(*builds, "--write-baseline", "ci/baseline.json")[0] == 0
    gate = ("--baseline", "ci/baseline.json")
    status, out, err = report(*builds, *gate)
    assert (status, err) == (0, "")
    assert "16 of 16 checks passed" in out
    worse = write_build(tmp_path / "new" / "a", accuracy=0.89)
    status, _, err = report(worse, builds[1], *gate)
    assert status == 1
    assert err == "wnn2hdl: 1 of 16 checks failed: a, accuracy: 0.89, in the baseline 0.9\n"
    status, _, err = report(builds[0], *gate)
    assert status == 1
    assert "b, build: in the baseline, but not among the builds" in err


def test_recording_leaves_an_index_alone(report: Run, builds: tuple[Path, Path]) -> None:
    Path("build/index.html").write_text("of the demo")
    assert report(*builds, "--write-baseline", "baseline.json")[0] == 0
    assert Path("build/index.html").read_text() == "of the demo"
    report(*builds, "--write-baseline", "baseline.json", "-o", "pages.html")
    assert Path("pages.html").is_file()


def test_an_index_of_another_command_stays(report: Run, builds: tuple[Path, Path]) -> None:
    index = Path("build/index.html")
    index.write_text("of the demo")
    assert (
        "a page that `wnn2hdl report` did not write is in the way: build/index.html"
        in report(*builds).complaint()
    )
    assert index.read_text() == "of the demo"
    assert not Path("build/a/report.html").exists()
    assert report(*builds, "-o", index)[0] == 0
    assert report(*builds)[0] == 0


@pytest.mark.parametrize("name", ["model.json", "report.json"])
def test_a_build_that_was_changed_after_its_proof_fails(
    report: Run, builds: tuple[Path, Path], name: str
) -> None:
    assert report(builds[0], "--max-luts", 10**6)[0] == 0
    with (builds[0] / name).open("a") as changed:
        changed.write("\n")
    status, out, err = report(builds[0], "--max-luts", 10**6)
    assert (status, err) == (1, f"wnn2hdl: 1 of 3 checks failed: a, files: {name} was changed\n")
    assert f"✗ a, files: {name} was changed" in out
    status, _, err = report(builds[0], "--write-baseline", "b.json")
    assert (status, Path("b.json").exists()) == (1, False)
    assert f"a build that was changed cannot be a baseline: a ({name} was changed)" in err


def test_luts_may_rise_as_far_as_allowed(
    report: Run, builds: tuple[Path, Path], write_build: Callable[..., Path], tmp_path: Path
) -> None:
    report(builds[0], "--write-baseline", "baseline.json")
    now = json.loads(Path("build/a/report.json").read_text())["parts"]
    now["block"]["luts"] += 2
    parts = {part: PartFigures(**figures) for part, figures in now.items()}
    more = write_build(tmp_path / "new" / "a", parts=parts)
    gate = (more, "--baseline", "baseline.json")
    assert report(*gate)[0] == 1
    assert report(*gate, "--max-regress", 1)[0] == 1
    assert report(*gate, "--max-regress", 2)[0] == 0


def test_limits_need_no_baseline(report: Run, builds: tuple[Path, Path]) -> None:
    assert report(*builds, "--min-accuracy", 0.9, "--max-luts", 10**6)[0] == 0
    assert report(*builds, "--min-accuracy", 0.905)[0] == 1
    assert report(*builds, "--max-luts", 1)[0] == 1
    assert "✗ failed" in Path("build/index.html").read_text()


def test_a_failed_build_fails_the_gate_and_is_not_recorded(
    report: Run, write_build: Callable[..., Path], tmp_path: Path
) -> None:
    folder = write_build(tmp_path / "a", proof=Proof("failed", "SAT", 0.5))
    assert report(folder)[0] == 0
    assert report(folder, "--max-luts", 10**6)[0] == 1
    status, _, err = report(folder, "--write-baseline", "baseline.json")
    assert status == 1
    assert "a build that is not proved cannot be a baseline: a" in err
    assert not Path("baseline.json").exists()


@pytest.mark.parametrize("form", ["markdown", "json", "junit"])
def test_formats_go_to_stdout_or_a_file(report: Run, builds: tuple[Path, Path], form: str) -> None:
    status, out, _ = report(*builds, "--format", form)
    assert status == 0
    readers: dict[str, Callable[[str], object]] = {
        "markdown": lambda text: text.index("| a | ✓ passed |"),
        "json": json.loads,
        "junit": lambda text: ET.fromstring(text.encode()),
    }
    readers[form](out)
    assert not Path("build/index.html").exists()
    status, printed, _ = report(*builds, "--format", form, "--max-luts", 1, "-o", "out/gate.txt")
    assert status == 1
    readers[form](Path("out/gate.txt").read_text().replace("✗ failed", "✓ passed"))
    assert "✗ a, max-luts" in printed


def test_json_is_one_object_on_stdout_in_every_case(report: Run, builds: tuple[Path, Path]) -> None:
    data = json.loads(report(*builds, "--json")[1])
    assert data["passed"] is True
    assert data["checks"] == []
    assert data["written"] == ["build/a/report.html", "build/b/report.html", "build/index.html"]
    status, out, _ = report(*builds, "--json", "--max-luts", 1)
    assert (status, json.loads(out)["passed"]) == (1, False)
    out = report(*builds, "--json", "--format", "markdown", "-o", "gate.md")[1]
    assert json.loads(out)["written"][-1] == "gate.md"


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("nowhere",), "Path 'nowhere' does not exist"),
        ((".",), "none of these is a build"),
        (("build/a", "--baseline", "none.json"), "cannot read a baseline: none.json"),
        (("build/a", "--baseline", "build/a/report.json"), "not a baseline, or one of another version"),
        (("build/a", "--max-regress", "1"), "--max-regress is measured from a baseline"),
        (("build/a", "--min-accuracy", "91"), "91.0 is not in the range 0<=x<=1"),
        (("build/a", "--min-accuracy", "nan"), "nan is not a finite number"),
        (("build/a", "--json", "--format", "junit"), "two outputs cannot both go to stdout"),
        (("build/a", "--write-baseline", "b.json", "--max-luts", "1"), "--write-baseline takes builds as"),
        (("build/a", "--compare", "build/a", "build/b"), "not among the BUILDs: build/b"),
        (("build/a", "build/../build/a"), "a build is given twice: "),
    ],
)
def test_bad_usage_gets_one_line(
    report: Run, builds: tuple[Path, Path], words: tuple[str, ...], complaint: str
) -> None:
    assert complaint in report(*words).complaint()
