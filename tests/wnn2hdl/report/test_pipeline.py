"""Cores are laid out so that nothing lies on anything else and each wire ends at its boxes."""

import re
from dataclasses import replace
from itertools import combinations, pairwise
from typing import Any

import pytest

from wnn2hdl.ir.steps import Step
from wnn2hdl.report import build_page
from wnn2hdl.report.pipeline import Pipeline, lay_out, memory, waiting

CHAIN = (
    Step("in", "stream", (), 24),
    Step("pixel classifier", "circuit", ("in",), 1, 2, "pixel"),
    Step("3x3 window", "memory", ("pixel classifier",), 9, 3, words=1024, word_bits=4, lines=1, beats=1),
    Step("edge filter", "circuit", ("3x3 window",), 1, 1, "edge", 2),
    Step("out", "stream", ("edge filter",), 8),
)
MORE = "edge filter", "more", "still more", "most", "all"
LONG = (*CHAIN[:-1], *(Step(after, "circuit", (before,), 1) for before, after in pairwise(MORE)))
JOINED = (
    Step("one", "stream", (), 32),
    Step("other", "stream", (), 8),
    Step("lanes", "circuit", ("one", "other"), 11),
)
PARTS = {"pixel": {"luts": 24}, "edge": {"luts": 1}}


@pytest.mark.parametrize("steps", [CHAIN, LONG, JOINED], ids=["chain", "rows", "joined"])
@pytest.mark.parametrize("narrow", [False, True])
def test_boxes_do_not_meet_and_wires_end_at_them(steps: tuple[Step, ...], narrow: bool) -> None:
    drawing = lay_out(steps, PARTS, narrow=narrow)
    for one, other in combinations(drawing.boxes, 2):
        beside = abs(one.x - other.x) >= drawing.box_width
        assert beside or abs(one.y - other.y) >= drawing.box_height, (one, other)
    for box in drawing.boxes:
        assert 0 <= box.x <= drawing.width - drawing.box_width
        assert 0 <= box.y <= drawing.height - drawing.box_height
    wires = [(name, step.name) for step in steps for name in step.reads]
    boxes = {box.step.name: box for box in drawing.boxes}
    for (source, target), link in zip(wires, drawing.links, strict=True):
        start, end = _ends(link.path)
        assert _on_border(drawing, boxes[source].x, boxes[source].y, start)
        assert _on_border(drawing, boxes[target].x, boxes[target].y, end)


def _ends(path: str) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where a path of M, H and V begins and ends."""
    x = y = 0.0
    places = []
    for letter, numbers in re.findall(r"([MHV])([^MHV]*)", path):
        values = [float(number) for number in numbers.split()]
        x = values[0] if letter in "MH" else x
        y = values[-1] if letter in "MV" else y
        places.append((x, y))
    return places[0], places[-1]


def _on_border(drawing: Pipeline, x: float, y: float, place: tuple[float, float]) -> bool:
    right, below = place[0] - x, place[1] - y
    inside = 0 <= right <= drawing.box_width and 0 <= below <= drawing.box_height
    return inside and (right in (0, drawing.box_width) or below in (0, drawing.box_height))


def test_boxes_say_what_the_steps_are() -> None:
    drawing = lay_out(CHAIN, PARTS, narrow=False)
    assert [box.lines for box in drawing.boxes] == [
        ("in",),
        ("pixel classifier", "24 LUTs", "2 cycles"),
        ("3x3 window", "1,024 \N{MULTIPLICATION SIGN} 4 bits", "1 line, 1 beat, 3 cycles"),
        ("edge filter", "2 \N{MULTIPLICATION SIGN} 1 LUT", "1 cycle"),
        ("out",),
    ]
    assert [link.label for link in drawing.links] == ["24 bits", "1 bit", "9 bits", "1 bit"]
    assert (memory(CHAIN[0]), waiting(CHAIN[0])) == ("", "")


def test_the_page_of_a_core_draws_its_steps(report: dict[str, Any], networks: dict[str, Any]) -> None:
    page = build_page(report, networks, steps=CHAIN)
    assert page.count('<svg class="overview') >= 2
    assert "an answer comes 1 line, 1 beat and 6 cycles after its pixel" in page
    again = replace(CHAIN[2], name="again", reads=("3x3 window",))
    # What is beside the way of the answers does not delay them.
    aside = replace(CHAIN[2], name="aside", reads=("3x3 window",))
    twice = (*CHAIN[:3], again, aside, replace(CHAIN[3], reads=("again",)), CHAIN[4])
    assert "2 lines, 2 beats and 9 cycles" in build_page(report, networks, steps=twice)
    assert 'id="pipeline"' not in build_page(report, networks)
