"""README fits a screen or two, and what it shows exists."""

import re
from pathlib import Path

import numpy as np

from wnn2hdl.api.progress import silent
from wnn2hdl.build.emission import render
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.ir import BitSelect, WisardModel

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_its_links_lead_somewhere() -> None:
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
    assert links
    assert [link for link in links if not (ROOT / link).is_file()] == []


def test_its_picture_is_small() -> None:
    assert (ROOT / "docs" / "pictures" / "overview.jpg").stat().st_size <= 250_000


def test_it_stays_short() -> None:
    assert len(README.splitlines()) <= 90


def test_its_figures_come_with_commands() -> None:
    rows = [line for line in README.splitlines() if line.startswith("| ") and "here, measured" not in line]
    assert len(rows) == 5
    assert all(row.split(" | ")[-1].startswith("`") for row in rows)


def test_its_verilog_is_what_the_compiler_writes() -> None:
    (shown,) = re.findall(r"```verilog\n(.*?)```", README, re.DOTALL)
    (contents,) = re.findall(r"64'h([0-9a-f]{16})", shown)
    deforested = np.array([int(contents, 16) >> code & 1 for code in range(64)])
    model = WisardModel(
        encoder=BitSelect(("R6", "R5", "R4", "B6", "B5", "B4")),
        classes=("forest", "deforested"),
        mapping=np.arange(6)[None, None],
        counts=np.stack([1 - deforested, deforested])[:, None],
        bleaching=1,
    )
    design = plan(model, "smallest", CompileOptions(), silent).design
    assert shown in render(design, sobel_threshold=128)["smallest.v"]
