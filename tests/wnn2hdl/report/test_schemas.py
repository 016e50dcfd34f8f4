"""Only reports that the pages understand are let in."""

from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.errors import ModelFileError
from wnn2hdl.report import BuildReport, Parts, report_dict
from wnn2hdl.report.schemas import check_report


def test_every_report_that_is_written_fits(report: dict[str, Any]) -> None:
    check_report(report, Path("report.json"))


def test_an_empty_report_fits() -> None:
    check_report(report_dict(BuildReport("b", "block", "exact", Parts())), Path("report.json"))


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
        check_report(report | {"version": 2}, Path("r.json"))


def test_what_the_pages_stand_on_must_be_there(report: dict[str, Any]) -> None:
    with pytest.raises(ModelFileError, match="at target: 'nonsense' is not one of"):
        check_report(report | {"target": "nonsense"}, Path("r.json"))
    for part in ("block", "pixel"):
        parts = {name: figures for name, figures in report["parts"].items() if name != part}
        with pytest.raises(ModelFileError, match=f"at parts: '{part}' is a required property"):
            check_report(report | {"parts": parts}, Path("r.json"))
    with pytest.raises(ModelFileError, match="at model/saturation/0"):
        check_report(report | {"model": report["model"] | {"saturation": [[]]}}, Path("r.json"))
