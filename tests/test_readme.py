"""README fits a screen or two, and what it shows exists."""

import re
from pathlib import Path

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
