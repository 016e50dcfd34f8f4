"""Names that people, tools and attackers give: they change no Verilog, no page and no table."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.folder import REPORT_HTML, REPORT_PAGE
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.reporting import open_entries
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.report import Entry, Limits, gate_junit, gate_markdown, index_page, read_baseline, run_gate
from wnn2hdl.report.baseline import write_baseline

HOSTILE = (
    "*/ endmodule // \" ' \r\n `define $x$ | a = [/] :car:",
    "</script><img src=x>\x1b[31m\u202e<!-- " + "x" * 5000,
)
"""Two class names."""

FOLDER = '=1+1|"it\'s"\n# <img src=x>\x1b[31m\u202e$x_{$ `*_'


class Tags(HTMLParser):
    """The tags of a page in order."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note an opening tag and the names of its attributes."""
        self.tags.append(f"{tag} {' '.join(name for name, _ in attrs)}")

    def handle_endtag(self, tag: str) -> None:
        """Note a closing tag."""
        self.tags.append(f"/{tag}")


@pytest.fixture(scope="module")
def builds(model: WisardModel, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The same model as a build with plain names, and with hostile ones of its classes and its folder."""
    folder = tmp_path_factory.mktemp("builds")
    options = CompileOptions(target="pixel")
    hostile = replace(model, classes=HOSTILE, training={"</pre>": "*/", COMMAND: "a\n</script>"})
    plain = replace(model, training={"note": "text", COMMAND: "train"})
    # The same circuit before: what the cache remembers of it takes no stage of either build.
    assert compile_model(plain, folder / "before", options, silent).failure is None
    assert compile_model(plain, folder / "plain", options, silent).failure is None
    assert compile_model(hostile, folder / FOLDER, options, silent).failure is None
    return folder / "plain", folder / FOLDER


@pytest.fixture(scope="module")
def entries(builds: tuple[Path, Path]) -> tuple[Entry, Entry]:
    """Both builds for an index, with an accuracy, so that they are in its chart."""
    first, second = open_entries(builds, builds[0].parent / "index.html")
    return replace(first, report={**first.report, "accuracy": 0.5}), replace(
        second, report={**second.report, "accuracy": 0.75}
    )


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def test_verilog_holds_no_name(model: WisardModel, builds: tuple[Path, Path], tmp_path: Path) -> None:
    options = CompileOptions(target="pixel", name="plain")
    compile_model(replace(model, classes=HOSTILE), tmp_path / FOLDER, options, silent)
    for name in ("plain.v", "plain_pixel_tb.v"):
        texts = [(folder / name).read_text() for folder in (builds[0], tmp_path / FOLDER)]
        plain, hostile = (re.sub(r"from the model [0-9a-f]{64}", "", text) for text in texts)
        assert plain == hostile


def test_the_page_of_a_build_has_the_same_structure(builds: tuple[Path, Path]) -> None:
    plain, hostile = ((folder / REPORT_HTML).read_text() for folder in builds)
    assert Tags(hostile).tags == Tags(plain).tags
    assert all(line.isprintable() for line in hostile.splitlines())


def test_the_index_has_the_same_structure(entries: tuple[Entry, Entry]) -> None:
    first, second = entries
    plain = (first, replace(second, name="other", report={**second.report, "model": first.report["model"]}))
    page = index_page(entries, entries)
    assert Tags(page).tags == Tags(index_page(plain, plain)).tags
    assert all(line.isprintable() for line in page.splitlines())


def test_tables_keep_their_columns_and_lines(entries: tuple[Entry, Entry], builds: tuple[Path, Path]) -> None:
    reports = {entry.name: entry.report for entry in entries}
    checks = run_gate(reports, dict.fromkeys(reports, ()), Limits(max_luts=0), None)
    for text in ((builds[1] / REPORT_PAGE).read_text(), gate_markdown(reports, checks, None)):
        for block in text.split("\n\n"):
            cells = {len(re.findall(r"(?<!\\)\|", line)) for line in block.splitlines()}
            assert len(cells) == 1 or (0 in cells and not block.startswith("|"))
        assert all(line.isprintable() for line in text.splitlines())
        assert not re.search(r"(?<!\\)<img", text)


def test_build_servers_read_the_name_as_one_text(entries: tuple[Entry, Entry]) -> None:
    reports = {entry.name: entry.report for entry in entries}
    checks = run_gate(reports, dict.fromkeys(reports, ()), Limits(max_luts=0), None)
    suites = ET.fromstring(gate_junit(checks)).findall("testsuite")
    assert len(suites) == 2
    assert suites[1].attrib["name"] == FOLDER.replace("\n", "\\n").replace("\x1b", "\\x1b").replace(
        "\u202e", "\\u202e"
    )


def test_a_baseline_gives_names_back(entries: tuple[Entry, Entry], tmp_path: Path) -> None:
    reports = {entry.name: entry.report for entry in entries}
    write_baseline(tmp_path / "baseline.json", reports, dict.fromkeys(reports, ()))
    assert read_baseline(tmp_path / "baseline.json").keys() == {"plain", FOLDER}
