"""The stable keys of report.json."""

import json

from wnn2hdl.report import (
    REPORT_VERSION,
    BuildReport,
    Care,
    Minimised,
    PartFigures,
    Proof,
    report_dict,
)

KEYS = ["luts", "inv", "muxf7", "muxf8", "carry4", "srl", "ffs", "bram36", "dsp", "delay_ps"]


def test_every_part_has_every_figure_and_what_was_not_measured_is_null() -> None:
    figures = {"pixel": PartFigures(luts=1, inv=0), "sobel": PartFigures()}
    parts = report_dict(BuildReport("b", "pixel", "exact", figures))["parts"]
    assert all(list(figures) == KEYS for figures in parts.values())
    assert parts == {
        "pixel": dict.fromkeys(KEYS) | {"luts": 1, "inv": 0},
        "sobel": dict.fromkeys(KEYS),
    }


def test_the_keys_that_others_rely_on() -> None:
    report = report_dict(
        BuildReport(
            "b",
            "block",
            "domain",
            {},
            proof=Proof("proved", "SAT", 0.5),
            care=Care(120, 0.98),
            accuracy=0.9,
            minimised={"pixel": Minimised(60, 3, 720, 9)},
            tools={"yosys": "0.70"},
        )
    )
    assert report["version"] == REPORT_VERSION
    assert report["mode"] == "domain"
    assert report["proof"] == {
        "status": "proved",
        "method": "SAT",
        "seconds": 0.5,
        "failure": None,
        "before": (),
        "claims": (),
        "unproved": (),
    }
    assert report["care"] == {"codes": 120, "coverage": 0.98, "of": None}
    assert report["accuracy"] == 0.9
    assert report["minimised"]["pixel"]["cubes_after"] == 3
    assert report["tools"] == {"yosys": "0.70"}


def test_it_is_json_and_the_same_report_gives_the_same_text() -> None:
    report = BuildReport("b", "block", "exact", {})
    assert json.dumps(report_dict(report)) == json.dumps(report_dict(report))


def test_published_figures_are_marked_as_not_measured() -> None:
    published = report_dict(BuildReport("b", "block", "exact", {}))["published"]
    assert [figure["luts"] for figure in published] == [21, 11, 135, 114]
    assert [figure["registers"] for figure in published] == [0, None, 49, 0]
    assert all(figure["measured_here"] is False for figure in published)
