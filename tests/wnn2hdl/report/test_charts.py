"""Charts tell their figures as text and in words, in the colours of the page."""

import re
from collections.abc import Callable
from functools import partial
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from wnn2hdl.report.charts import cube_bars, for_all_widths, light_lines, lut_bars, scatter

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


@pytest.mark.parametrize("name", ["$\\frac$", "$x^2$", r"a\$b", "\u0627\u0644", "\u0915"])
def test_a_name_is_no_formula(report: dict[str, Any], name: str) -> None:
    report["parts"][name] = report["parts"]["pixel"]
    sizes = {"cubes_before": 5, "cubes_after": 3}
    for svg in (lut_bars(report), cube_bars({name: sizes}), scatter([(name, 1, 0.9), ("b", 2, 0.8)])):
        assert name in texts(svg)


def test_a_build_of_wires_alone_has_bars_of_no_length(report: dict[str, Any]) -> None:
    for figures in report["parts"].values():
        figures["luts"] = 0
    assert texts(lut_bars(report | {"published": []})).count("0") >= 5


def test_without_figures_there_are_no_bars(report: dict[str, Any]) -> None:
    for figures in report["parts"].values():
        figures["luts"] = None
    assert lut_bars(report | {"published": []}) == ""
    assert "135" in texts(lut_bars(report))


def test_builds_at_one_place_share_a_label() -> None:
    found = texts(scatter([("before", 19, 0.9), ("after", 19, 0.9), ("else", 25, 0.8)]))
    assert "before, after" in found
    assert "before" not in found


def test_labels_of_near_builds_do_not_meet() -> None:
    svg = scatter(
        [("before it was changed", 19, 0.9), ("after it was changed", 19, 0.9001), ("else", 40, 0.5)]
    )
    nodes = [node for node in ET.fromstring(svg).iter() if node.tag.endswith("text")]
    places = {
        "".join(node.itertext()): [float(x) for x in re.findall(r"-?[\d.]+", node.attrib["transform"])]
        for node in nodes
        if "transform" in node.attrib
    }
    first, second = places["before it was changed"], places["after it was changed"]
    assert abs(first[2] - second[2]) > 10


def test_luts_are_counted_in_whole_numbers() -> None:
    found = texts(scatter([("a", 1, 0.9), ("b", 2, 0.8)]))
    assert {"1", "2"} <= set(found)
    assert not [text for text in found if re.fullmatch(r"[01]\.\d+", text)]


@pytest.mark.parametrize("after", [0, 5])
def test_cubes_of_a_constant_table_can_be_drawn(after: int) -> None:
    svg = cube_bars({"pixel": {"cubes_before": after, "cubes_after": after}})
    assert str(after) in texts(svg)


def test_narrow_charts_say_the_same_in_less_width(report: dict[str, Any]) -> None:
    points = [("a build of a long name, too long for a phone", 1, 0.9), ("b", 2, 0.8)]
    charts: list[tuple[Callable[..., Any], Any]]
    charts = [(partial(light_lines, "exposure"), report["light"]["curves"]["exposure"])]
    charts += [(lut_bars, report), (cube_bars, report["minimised"]), (scatter, points)]
    for draw, argument in charts:
        wide, narrow = (draw(argument, narrow=narrow) for narrow in (False, True))
        assert for_all_widths(draw, argument) == wide + narrow
        labels = [re.findall(r'aria-label="[^"]+"', svg) for svg in (wide, narrow)]
        assert labels[0] == labels[1] != []
        widths = [float(svg.split('viewBox="0 0 ')[1].split()[0]) for svg in (wide, narrow)]
        assert widths[1] < 350 < widths[0]
        assert not set(re.findall(r' id="([^"]+)"', wide)) & set(re.findall(r' id="([^"]+)"', narrow))
    assert set(texts(lut_bars(report, narrow=True))) == set(texts(lut_bars(report)))
    assert "a build of a long n…" in texts(scatter(points, narrow=True))


def test_a_network_is_not_compared_with_published_circuits_for_pictures(report: dict[str, Any]) -> None:
    report["parts"]["network"] = report["parts"].pop("block")
    svg = lut_bars(report)
    assert "135" not in texts(svg)
    assert "Published" not in svg


def test_the_same_figures_give_the_same_bytes(report: dict[str, Any]) -> None:
    assert lut_bars(report) == lut_bars(report)
