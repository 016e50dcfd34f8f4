"""The page of a build says what report.json says, and nothing else."""

import json
import re
import time
from html.parser import HTMLParser
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import BitSelect, Lut, LutNetwork, Neighbourhood, Tap
from wnn2hdl.report.page import Picture, build_page
from wnn2hdl.report.shell import form, percent

VOID = {"meta", "link", "img", "input", "br"}


class Outline(HTMLParser):
    """Elements with their attributes, text of the figures, and whether all that is opened is closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.stack: list[tuple[str, dict[str, str | None]]] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.figures: dict[str, set[tuple[str, str]]] = {}
        self.feed(page)
        assert self.stack == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.stack.append((tag, dict(attrs)))

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.stack.pop()[0] == tag

    def handle_data(self, data: str) -> None:
        if self.stack and self.stack[-1][0] == "data":
            attributes = self.stack[-1][1]
            key, value = attributes["data-key"], attributes["value"]
            assert key is not None
            assert value is not None
            self.figures.setdefault(key, set()).add((value, data))

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]


def at(report: Any, key: str) -> Any:
    for step in key.split("."):
        report = report[int(step)] if isinstance(report, list) else report[step]
    return report


def test_every_figure_is_the_one_at_its_path(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    figures = Outline(build_page(report, networks)).figures
    for key, reported in figures.items():
        assert {json.loads(value) for value, _ in reported} == {at(report, key)}, key
    assert {"parts.block.luts", "parts.sobel.luts", "published.0.luts", "accuracy", "care.coverage"} <= set(
        figures
    )
    assert {"confusion.0.1", "minimised.pixel.cubes_after", "model.bleaching", "tools.pyosys"} <= set(figures)
    assert figures["parts.block.luts"] == {("19", "19")}
    assert figures["confusion.0.0"] == {("130900", "130,900")}
    assert figures["accuracy"] == {("0.9165", "91.65 %")}


def test_accuracy_in_changed_light_is_drawn_and_listed(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    page = build_page(report, networks)
    figures = Outline(page).figures
    assert figures["light.curves.exposure.2.accuracy"] == {("0.7313", "73.13 %")}
    assert figures["light.curves.exposure.1.worst_image.name"] == {('"dim-1"', "dim-1")}
    # The interval of the accuracy itself is the one at the exposure of 1.
    assert "light.curves.exposure.1.interval.0" in page.split('id="light"')[0]
    assert "0.8: 88.71 %, worst image 68.71 %" in page
    assert "R7 is not read" in page
    del report["light"]
    assert 'id="light"' not in build_page(report, networks)


def test_saturation_of_every_ram_is_drawn(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    strips = [x for x in Outline(build_page(report, networks)).all("span") if "data-key" in x]
    assert [float(str(x["data-value"])) for x in strips] == [0.25, 0.5, 1.0, 0.0, 0.75, 0.5]
    assert [x.get("class") for x in strips] == [None, None, "full", None, None, None]


def test_it_needs_nothing_from_anywhere(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    picture = Picture("Input", "A picture", b"\x89PNG", 4, 4)
    page = build_page(report, networks, [picture], [("forest", "#165c2c")])
    outline = Outline(page)
    places = [x.get(key) or "" for _, x in outline.elements for key in ("src", "href", "xlink:href")]
    assert all(place == "" or place.startswith(("data:", "#")) for place in places)
    assert not re.search(r"url\((?!#)|@import", page)
    assert [x["alt"] for x in outline.all("img")] == ["A picture"]


def test_it_can_be_used_without_seeing_or_pointing(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    page = build_page(report, networks)
    outline = Outline(page)
    tags = [tag for tag, _ in outline.elements]
    assert [tags.count(tag) for tag in ("header", "main", "footer", "h1", "nav")] == [1, 1, 1, 1, 1]
    assert tags.count("table") == tags.count("caption")
    assert outline.all("html") == [{"lang": "en"}]
    ids = {x["id"] for _, x in outline.elements if "id" in x}
    for _, x in outline.elements:
        for key in ("aria-labelledby", "aria-controls"):
            assert x.get(key) is None or x[key] in ids
    cells = [x for x in outline.all("g") if (x.get("class") or "").startswith("cell")]
    assert [x["tabindex"] for x in cells] == ["0"] * 4
    assert "LUT2 t0: R7 & G7, INIT 4'h8" in {x["aria-label"] for x in cells}
    assert "MUXF7 t2: t2 = G7 ? t1 : t0" in {x["aria-label"] for x in cells}
    for x in outline.all("svg"):
        assert x["role"] in ("img", "group")
        assert x["aria-label"]
    levels = [int(tag[1]) for tag in tags if re.fullmatch(r"h[1-6]", tag)]
    assert all(b - a <= 1 for a, b in pairwise(levels))


def test_no_id_occurs_twice(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    ids = [x["id"] for _, x in Outline(build_page(report, networks)).elements if "id" in x]
    assert len(ids) == len(set(ids))


def test_parts_that_were_not_measured_are_neither_listed_nor_drawn(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    for part in ("edge", "block", "match"):
        del report["parts"][part]
    report |= {"target": "pixel", "utilisation": {}}
    page = build_page(report, {"pixel": networks["pixel"]})
    assert "Schematic of pixel" in page
    assert "Schematic of edge" not in page
    assert 'class="overview"' not in page
    assert "parts.edge.luts" not in Outline(page).figures


def test_columns_and_rows_in_which_nothing_was_measured_are_left_out(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    full = Outline(build_page(report, networks)).figures
    for figures in report["parts"].values():
        figures["delay_ps"] = None
    report |= {"utilisation": {}, "model_accuracy": None}
    report["care"] |= {"coverage": None}
    report["proof"] |= {"seconds": None}
    report["options"] |= {"palette": None}
    page = build_page(report, networks)
    figures = Outline(page).figures
    gone = {"parts.block.delay_ps", "utilisation.block.luts", "care.coverage", "proof.seconds"}
    assert gone < set(full)
    assert not gone & set(figures)
    assert "options.palette" not in figures
    assert "share of LUTs" not in page
    # What the paper has no figure of is published so.
    assert [key for key, told in figures.items() if ("null", "n/a") in told] == ["published.1.registers"]


def test_a_simulation_that_passed_before_is_told_as_such(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    report["options"] |= {"simulated_vectors": {"match": 262144, "pixel": 150}, "simulated_before": "match"}
    page = build_page(report, networks)
    rows = re.findall(r'<th scope="row">(\w+)</th><td class="number">.*?</td><td>([\w ]+)</td>', page)
    assert rows[-2:] == [
        ("match", "passed before on the same vectors"),
        ("pixel", "simulated for this build"),
    ]
    assert "options.simulated_before" not in Outline(page).figures


def test_a_proof_of_an_earlier_build_is_told_as_such(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    told = "Proved by an earlier build, with the same Verilog and netlist, and not again: "
    assert told not in build_page(report, networks)
    report["proof"]["before"] = ["pixel", "edge"]
    assert f"{told}pixel, edge." in build_page(report, networks)


def test_how_the_block_and_its_matcher_add_up_is_said(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    words = "The block is nine pixels of 2 and an edge filter of 1: 19."
    assert f"<p>{words}</p>" in build_page(report, networks)
    report["parts"]["block_match"] = report["parts"]["match"] | {"luts": 29}
    assert f"{words} With match and count, of 10, it is block_match: 29." in build_page(report, networks)


@pytest.fixture
def network_report(report: dict[str, Any]) -> dict[str, Any]:
    """The report of a network of tables that has no discriminators, no pictures and no care set."""
    parts = dict.fromkeys(("encoder", "core", "network"), report["parts"]["block"])
    model: dict[str, Any] = {"address_bits": None, "rams": None, "bleaching": None, "saturation": []}
    model |= {"classes": ["0", "1", "2"], "bits": [f"x{i}" for i in range(4000)], "training": {}}
    report |= {"target": "network", "mode": "exact", "parts": parts, "model": model, "utilisation": {}}
    report["edges"] = dict.fromkeys(report["edges"])
    report["care"] = dict.fromkeys(report["care"])
    report["confusion"] = None
    report["light"] = {"curves": {}, "warning": None}
    return report


def tables(count: int) -> dict[str, LutNetwork]:
    names = tuple(f"x{i}" for i in range(6))
    six = LutNetwork(names, (Lut("t0", names, 0x8000_0000_0000_0001),), (("f", "t0"),))
    four = LutNetwork(names[:4], (Lut("t0", names[:4], 0x8001),), (("f", "t0"),))
    return {f"node_{i}": six if i % 4 else four for i in range(count)}


def test_a_network_without_discriminators_has_a_page(network_report: dict[str, Any]) -> None:
    page = build_page(network_report, tables(3))
    figures = Outline(page).figures
    assert "LUTs of the network" in page
    assert "4,000: x0 … x3999" in page
    assert not [key for key in figures if key.startswith(("care", "model.", "parts.sobel"))]
    assert "Saturation" not in page
    assert page.count("Schematic of") == 3


def test_a_page_of_a_thousand_tables_is_quick_and_small(network_report: dict[str, Any]) -> None:
    sizes = network_report["minimised"]["pixel"]
    network_report["minimised"] = {f"node_{i}": sizes for i in range(1000)}
    network_report["options"]["mapping"] = {f"node_{i}": "decpla" for i in range(1000)}
    network_report["model"] |= {"classes": [f"c{i}" for i in range(100)], "saturation": [[0.5] * 50] * 100}
    network_report["confusion"] = [[10] * 100] * 100
    networks = tables(1000)
    build_page(network_report, {})
    started = time.process_time()
    page = build_page(network_report, networks)
    assert time.process_time() - started < 2
    assert len(page) < 300_000
    assert "Schematic of" not in page
    rows = re.findall(r"<tr>((?:<td class=\"number\">[\d,]+</td>){5})</tr>", page)
    assert [re.findall(r"[\d,]+(?=<)", row) for row in rows] == [
        ["4", "250", "250", "0", "1"],
        ["6", "750", "750", "0", "1"],
    ]
    assert "all 1,000 together" in page
    assert "119,000" in page


def test_a_table_of_very_many_luts_is_not_drawn_either(network_report: dict[str, Any]) -> None:
    names = tuple(f"x{i}" for i in range(6))
    luts = tuple(Lut(f"t{i}", names, i + 1) for i in range(500))
    wide = LutNetwork(names, luts, tuple((f"f{i}", f"t{i}") for i in range(500)))
    page = build_page(network_report, {"core": wide})
    assert "Schematic of" not in page
    assert "too many look-up tables to draw" in page


def test_a_part_of_several_networks_shows_them_all(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    for part in ("pixel", "edge", "block", "match"):
        report["parts"][part] = dict.fromkeys(report["parts"][part])
    report["parts"]["neighbourhood"] = report["parts"]["sobel"]
    report["edges"] = dict.fromkeys(report["edges"])
    several = {"tap0": networks["edge"], "decision": networks["pixel"]}
    page = build_page(report | {"target": "neighbourhood", "utilisation": {}}, several)
    assert "Schematic of tap0" in page
    assert "Schematic of decision" in page
    assert "LUTs of the neighbourhood" in page
    assert "Edge patterns" not in page


def test_a_neighbourhood_shows_which_pixels_it_looks_at(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    bits = BitSelect(("R7", "G7"))
    window = Neighbourhood(3, (Tap(0, 2, bits, 8), Tap(1, 1, bits, 8), Tap(0, 2, bits, 6)))
    report["parts"]["neighbourhood"] = report["parts"]["sobel"]
    several = dict.fromkeys(window.names, networks["edge"]) | {"decision": networks["pixel"]}
    page = build_page(report | {"target": "neighbourhood", "utilisation": {}}, several, window=window)
    assert re.findall(r'<td class="(.*?)">(.*?)</td>', page[: page.index("<h3")])[-9:] == [
        *[("", ""), ("", ""), ("tap", "tap0, tap2")],
        *[("", ""), ("tap middle", "tap1"), ("", "")],
        *[("", ""), ("", ""), ("", "")],
    ]
    assert "tap0: row 0, column 2; 1 LUT<" in page
    assert "tap1: row 1, column 1; 1 LUT<" in page
    assert "decision: 2 LUTs, 1 multiplexer<" in page
    assert "classified pixel" not in build_page(report, networks)


def test_why_the_matcher_has_no_drawing_is_said(report: dict[str, Any]) -> None:
    for part in ("pixel", "edge", "block"):
        report["parts"][part] = dict.fromkeys(report["parts"][part])
    page = build_page(report | {"target": "match", "utilisation": {}}, {})
    assert "Match and count is not drawn" in page
    assert '<a href="#circuit">' in page
    report["parts"]["match"] = dict.fromkeys(report["parts"]["match"])
    assert "Match and count" not in build_page(report | {"target": "block"}, {})


def test_a_report_without_images_model_and_tables_has_a_page(report: dict[str, Any]) -> None:
    for key in ("accuracy", "model_accuracy", "confusion", "model", "command"):
        report[key] = None
    report |= {"minimised": {}, "utilisation": {}, "options": {}}
    page = build_page(report, {})
    assert Outline(page).figures["accuracy"] == {("null", "n/a")}
    assert "None" not in page


@pytest.mark.parametrize(("target", "tables"), [("edge", ["edge"]), ("match", [])])
def test_a_target_without_a_classifier_shows_no_row_of_one(
    report: dict[str, Any], networks: dict[str, LutNetwork], target: str, tables: list[str]
) -> None:
    for part in {"pixel", "edge", "block", "match"} - {target}:
        report["parts"][part] = dict.fromkeys(report["parts"][part])
    report |= {"target": target, "utilisation": {}, "accuracy": None, "model_accuracy": None}
    report |= {"confusion": None, "minimised": {table: report["minimised"][table] for table in tables}}
    report["care"] = dict.fromkeys(report["care"])
    if target == "match":
        report["edges"] = dict.fromkeys(report["edges"])
    page = build_page(report, networks)
    figures = Outline(page).figures
    assert not [key for key in figures if key.startswith(("accuracy", "care.", "minimised.pixel", "model."))]
    assert "#model" not in page
    assert ("edges.patterns" in figures) == ("#answers" in page) == (target == "edge")


def test_the_commands_are_those_of_the_report(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    page = build_page(report, networks).replace("&#39;", "'")
    assert report["command"] in page
    assert report["evaluation"] in page
    assert "That file does not tell the command that trained" in page
    page = build_page(report | {"command": None, "evaluation": None}, networks)
    assert "wnn2hdl evaluate" not in page
    assert "IMAGES" not in page


def test_the_command_that_trained_the_model_is_told_where_the_model_tells_it(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    notes = report["model"]["training"] | {"command": "wnn2hdl train --luts-per-pixel 2"}
    page = build_page(report | {"model": report["model"] | {"training": notes}}, networks)
    assert f"<code>wnn2hdl train --luts-per-pixel 2 -o {report['name']}-again.json\n" in page
    assert "That file does not tell" not in page
    assert '<th scope="row">command</th>' not in page


def test_limits_are_stated(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    page = build_page(report, networks)
    assert "Yosys is not Vivado" in page
    assert "Domain mode." in page
    assert "Domain mode." not in build_page(report | {"mode": "exact"}, networks)
    assert "This build failed" not in page


def test_a_failed_build_gives_the_reason_and_claims_nothing(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    page = build_page(report, networks)
    assert "Equal to the model on" in page
    assert '<strong class="good">proved</strong> equal to the model by SAT' in page
    report["proof"] |= {"status": "failed", "failure": "the pixel differs for (1,2,3)"}
    page = build_page(report, networks)
    assert "This build failed" in page
    assert "The circuit is not the model: the pixel differs for (1,2,3). Do not use it." in page
    assert '<strong class="bad">not proved</strong> equal to the model: failed' in page
    assert "Equal to the model on" not in page
    assert "Domain mode." not in page


def test_texts_of_others_are_escaped(report: dict[str, Any], networks: dict[str, LutNetwork]) -> None:
    hostile = "<img src=x onerror=alert(1)>"
    report["name"] = hostile
    report["model"]["classes"] = [hostile, "b"]
    report["model"]["training"] = {"note": hostile}
    report["options"]["care"] = hostile
    picture = Picture(hostile, hostile, b"", 1, 1)
    page = build_page(report, networks, [picture], [(hostile, "#fff")])
    assert hostile not in page
    assert "&lt;img src=x onerror=alert(1)&gt;" in page
    assert "'&lt;img src=x onerror=alert(1)&gt;'" in page.replace("&#39;", "'")


def test_the_same_report_gives_the_same_bytes(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    assert build_page(report, networks) == build_page(report, networks)


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (None, "percent", "n/a"),
        (0.9165, "percent", "91.65 %"),
        (0.0357142, "points", "0.036 %"),
        (0.0, "points", "0 %"),
        (1400, "ps", "1,400 ps"),
        (0.5, "seconds", "0.50 s"),
        (262144, "count", "262,144"),
        (0.5, "count", "0.5"),
        ("0.70", "text", "0.70"),
        (None, "text", "n/a"),
    ],
)
def test_figures_as_a_person_reads_them(value: Any, kind: str, text: str) -> None:
    assert form(value, kind) == text


@given(st.integers(1, 10**8), st.integers(0, 10**8))
def test_a_share_is_all_or_nothing_only_if_it_is(total: int, part: int) -> None:
    part = min(part, total)
    shown = float(percent(part / total).removesuffix(" %"))
    assert (shown == 0) == (part == 0)
    assert (shown == 100) == (part == total)


def test_notes_of_the_training_are_told_whatever_they_are(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    report["model"]["training"] = {
        "images": [f"i{x}" for x in range(12)],
        "cascade": [["R7", "G6"]],
        "search": {"folds": 5, "best": None},
        "share": 0.25,
        "shuffled": True,
    }
    page = build_page(report, networks)
    for text in ("12: i0 … i11", "R7, G6", "folds 5, best n/a", "0.25", "True"):
        assert f"<td>{text}</td>" in page


def test_notes_nested_deeper_than_anybody_reads_are_cut_off(
    report: dict[str, Any], networks: dict[str, LutNetwork]
) -> None:
    note: Any = "bottom"
    for _ in range(600):
        note = {"in": note}
    report["model"]["training"] = {"deep": note}
    assert "<td>in in in in in …</td>" in build_page(report, networks)


def test_a_circuit_of_wires_alone_has_a_drawing_without_luts(report: dict[str, Any]) -> None:
    wires = LutNetwork(("R7",), (), (("class_bit0", "R7"), ("class_bit1", "1")))
    page = build_page(report, {"pixel": wires})
    assert "Schematic of pixel: inputs 1, cells 0, outputs 2" in page
    assert "There is no look-up table" in page
