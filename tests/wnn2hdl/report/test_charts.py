"""Charts tell their figures as text and in words, in the colours of the page."""

import re
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from wnn2hdl.report.charts import cube_bars, lut_bars, scatter

HOSTILE = "<script>alert('x')</script> & $x^2$ -- \u6797 \"q\""


def texts(svg: str) -> list[str]:
    """What the drawing says; it must be XML."""
    return [
        "".join(node.itertext()).strip() for node in ET.fromstring(svg).iter() if node.tag.endswith("text")
    ]


def test_measured_and_published_luts_stand_beside_their_bars(report: dict[str, Any]) -> None:
    svg = lut_bars(report)
    found = texts(svg)
    for word in ("pixel", "sobel", "19", "74", "135", "measured here", "published"):
        assert word in found
    assert 'aria-label="LUTs by part. Measured: pixel 2, edge 1, block 19, match 10, sobel 74.' in svg


def test_published_bars_are_outlined_and_measured_ones_filled(report: dict[str, Any]) -> None:
    styles = re.findall(r'clip-path[^>]* style="([^"]*)"', lut_bars(report))
    outlined = [style for style in styles if "stroke-dasharray" in style]
    assert len(outlined) == len(report["published"])
    assert all("fill: none" in style for style in outlined)
    assert sum("fill: var(--accent)" in style for style in styles) == 4


def test_colours_fonts_and_sizes_are_those_of_the_page(report: dict[str, Any]) -> None:
    for svg in (lut_bars(report), cube_bars(report["minimised"]), scatter([("a", 1, 0.9), ("b", 2, 0.8)])):
        assert "#0000" not in svg
        assert "font-family" not in svg
        assert "<style" not in svg
        assert "var(--ink)" in svg
        assert not re.search(r"<svg[^>]* (width|height)=", svg)


def test_two_charts_share_no_id(report: dict[str, Any]) -> None:
    first, second = lut_bars(report), cube_bars(report["minimised"])
    ids = [set(re.findall(r' id="([^"]+)"', svg)) for svg in (first, second)]
    assert ids[0]
    assert not ids[0] & ids[1]
    for svg, own in zip((first, second), ids, strict=True):
        assert set(re.findall(r"(?:url\(#|href=\"#)([^)\"]+)", svg)) <= own


def test_names_cannot_break_out_of_a_chart(report: dict[str, Any]) -> None:
    svg = scatter([(HOSTILE, 1, 0.9), ("b", 2, 0.8)])
    assert "<script" not in svg
    assert any(text.startswith("<script>alert('x')</script> & $x^2$") for text in texts(svg))


@pytest.mark.parametrize("after", [0, 5])
def test_cubes_of_a_constant_table_can_be_drawn(after: int) -> None:
    svg = cube_bars({"pixel": {"cubes_before": after, "cubes_after": after}})
    assert str(after) in texts(svg)


def test_the_same_figures_give_the_same_bytes(report: dict[str, Any]) -> None:
    assert lut_bars(report) == lut_bars(report)
