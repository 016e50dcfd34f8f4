"""Only reports that the pages understand are let in."""

import json
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.errors import ModelFileError
from wnn2hdl.report import BuildReport, PartFigures, report_dict
from wnn2hdl.report.schemas import check_report


def test_every_report_that_is_written_fits(report: dict[str, Any]) -> None:
    check_report(report, Path("report.json"))


def test_an_empty_report_fits() -> None:
    report = BuildReport("b", "block", "exact", {"block": PartFigures()})
    check_report(json.loads(json.dumps(report_dict(report))), Path("report.json"))


@pytest.mark.parametrize("key", ["version", "name", "parts", "proof", "edges", "published"])
def test_a_missing_key_is_named(report: dict[str, Any], key: str) -> None:
    del report[key]
    with pytest.raises(ModelFileError, match=f"r.json.*'{key}' is a required property") as caught:
        check_report(report, Path("r.json"))
    assert "compile the model again" in caught.value.line()


def test_a_figure_of_another_kind_is_refused(report: dict[str, Any]) -> None:
    report["parts"]["block"]["luts"] = "19"
    with pytest.raises(ModelFileError, match="at parts/block/luts"):
        check_report(report, Path("r.json"))


def test_a_report_of_another_version_is_refused(report: dict[str, Any]) -> None:
    with pytest.raises(ModelFileError, match="not a report, or one of another version"):
        check_report(report | {"version": 1}, Path("r.json"))


def test_what_the_pages_stand_on_must_be_there(report: dict[str, Any]) -> None:
    with pytest.raises(ModelFileError, match="the target nonsense is not one of its parts"):
        check_report(report | {"target": "nonsense"}, Path("r.json"))
    parts = {name: figures for name, figures in report["parts"].items() if name != "block"}
    with pytest.raises(ModelFileError, match="the target block is not one of its parts"):
        check_report(report | {"parts": parts}, Path("r.json"))
    with pytest.raises(ModelFileError, match="at model/saturation/0"):
        check_report(report | {"model": report["model"] | {"saturation": [[]]}}, Path("r.json"))


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("tools/py.osys", "0.70"),
        ("seconds/a.b", 1.0),
        ("options/a.b", 1),
        ("minimised/a.b", {}),
        ("parts/a.b", {"luts": 1, "delay_ps": 1}),
        ("hashes/model.json", "ab12"),
        ("published/0/luts", "many"),
        ("published/0/luts", None),
        ("published/0/what", 5),
        ("edges/precision", "high"),
        ("edges/patterns", "all"),
        ("parts/block/muxf7", "hi"),
        ("parts/block/luts", 10**400),
        ("options/simulated_vectors", "abc"),
        ("options/edges", {"a": {"b": 1}}),
        ("model/rams", "many"),
        ("proof/failure", 5),
    ],
)
def test_what_a_page_cannot_show_is_refused(report: dict[str, Any], place: str, value: object) -> None:
    *steps, last = place.split("/")
    where: Any = report
    for step in steps:
        where = where[int(step) if isinstance(where, list) else step]
    where[int(last) if isinstance(where, list) else last] = value
    with pytest.raises(ModelFileError, match="not a report, or one of another version") as caught:
        check_report(report, Path("r.json"))
    assert len(caught.value.line()) < 400
