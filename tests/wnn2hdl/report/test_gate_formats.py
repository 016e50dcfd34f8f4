"""What the gate found, as build servers and people read it."""

import json
import re
from typing import Any
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.report.baseline import recorded
from wnn2hdl.report.gate import Check, Limits, run_gate
from wnn2hdl.report.gate_formats import gate_json, gate_junit, gate_markdown

Reports = dict[str, dict[str, Any]]


@pytest.fixture
def checks(report: dict[str, Any]) -> tuple[Check, ...]:
    """A build that passes all but the limit of its LUTs."""
    return run_gate({"amazon": report}, {"amazon": ()}, Limits(max_luts=18), {"amazon": recorded(report)})


def test_json_has_its_stable_keys(report: dict[str, Any], checks: tuple[Check, ...]) -> None:
    data = json.loads(json.dumps(gate_json({"amazon": report}, checks)))
    assert list(data) == ["format", "version", "passed", "builds", "checks"]
    assert (data["format"], data["version"], data["passed"]) == ("wnn2hdl-gate", 1, False)
    assert data["builds"] == [
        {
            "name": "amazon",
            "target": "block",
            "mode": "domain",
            "luts": {"block": 19, "edge": 1, "match": 10, "pixel": 2},
            "accuracy": 0.9165,
            "proof": "proved",
        }
    ]
    assert data["checks"][2] == {
        "build": "amazon",
        "name": "max-luts",
        "passed": False,
        "text": "the block takes 19 LUTs, allowed are 18",
    }


def test_markdown_is_a_short_table_and_the_reasons(report: dict[str, Any], checks: tuple[Check, ...]) -> None:
    text = gate_markdown({"amazon": report}, checks, {"amazon": recorded(report)})
    assert text == (
        "### wnn2hdl: ✗ failed, 1 of 9 checks\n"
        "\n"
        "| build | result | LUTs | baseline | accuracy | baseline | proof |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | --- |\n"
        "| amazon | ✗ failed | 19 | 19 | 91.65 % | 91.65 % | proved |\n"
        "\n"
        "Why it failed:\n"
        "\n"
        "- **amazon**, max-luts: the block takes 19 LUTs, allowed are 18\n"
    )


def test_markdown_without_a_baseline_has_no_columns_for_it(report: dict[str, Any]) -> None:
    text = gate_markdown(
        {"amazon": report}, run_gate({"amazon": report}, {"amazon": ()}, Limits(), None), None
    )
    assert text.startswith(
        "### wnn2hdl: ✓ passed, 2 checks\n\n| build | result | LUTs | accuracy | proof |\n"
    )
    assert "| amazon | ✓ passed | 19 | 91.65 % | proved |" in text


def test_markdown_has_no_column_in_which_nothing_was_measured(report: dict[str, Any]) -> None:
    report["accuracy"] = None
    text = gate_markdown({"n/a": report}, (), {})
    assert (
        "| build | result | LUTs | proof |\n| --- | --- | ---: | --- |\n| n/a | ✓ passed | 19 | proved |"
        in text
    )
    other = report | {"accuracy": 0.5}
    text = gate_markdown({"a": report, "b": other}, (), None)
    assert "| build | result | LUTs | accuracy | proof |" in text
    assert "| a | ✓ passed | 19 | n/a | proved |" in text


def test_markdown_tells_what_got_better(report: dict[str, Any]) -> None:
    before = recorded(report)
    report["parts"]["block"]["luts"] = 18
    checks = run_gate({"x": report}, {"x": ()}, Limits(), {"x": before})
    text = gate_markdown({"x": report}, checks, {"x": before})
    assert "✓ passed" in text
    assert "`--write-baseline` records it:\n\n- **x**, luts of block: 18, in the baseline 19\n" in text


@given(st.text(min_size=1))
def test_no_name_breaks_the_table(name: str) -> None:
    report = {
        "target": "pixel",
        "mode": "exact",
        "accuracy": 0.5,
        "proof": {"status": "proved"},
        "parts": {"pixel": {"luts": 1}},
    }
    text = gate_markdown({name: report}, run_gate({name: report}, {name: ()}, Limits(), None), None)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len(rows) == 3
    assert all(len(re.findall(r"(?<!\\)\|", row)) == 6 for row in rows)
    assert "<" not in re.sub(r"\\<", "", text)


@st.composite
def several_checks(draw: st.DrawFn) -> tuple[Check, ...]:
    builds = draw(st.lists(st.text(), unique=True, max_size=3))
    return tuple(
        Check(build, name, draw(st.booleans()), draw(st.text()))
        for build in builds
        for name in ("proof", "max-luts", "luts of block")
    )


@given(several_checks())
def test_junit_is_what_gitlab_and_github_read(checks: tuple[Check, ...]) -> None:
    # The elements and attributes of docs.gitlab.com/ci/testing/unit_test_reports and of the JUnit schema.
    root = ET.fromstring(gate_junit(checks).encode())
    assert root.tag == "testsuites"
    cases = root.findall("./testsuite/testcase")
    assert len(cases) == len(checks)
    for case, check in zip(cases, checks, strict=True):
        assert set(case.attrib) == {"classname", "name", "time"}
        failures = case.findall("failure")
        assert len(list(case)) == len(failures) == (not check.passed)
        for failure in failures:
            assert set(failure.attrib) == {"message", "type"}
            assert failure.text
            assert check.name in failure.text
    for suite in [root, *root.findall("testsuite")]:
        own = suite.findall(".//testcase")
        assert set(suite.attrib) == {"name", "tests", "failures", "errors", "time"}
        assert int(suite.attrib["tests"]) == len(own)
        assert int(suite.attrib["failures"]) == len(suite.findall(".//failure"))


def test_no_two_cases_of_junit_have_one_name(report: dict[str, Any]) -> None:
    # Of equal names GitLab shows the first only.
    known = {"a": recorded(report), "b": recorded(report), "gone": recorded(report)}
    checks = run_gate({"a": report, "b": report}, {"a": (), "b": ()}, Limits(20, 0.5), known)
    names = [case.attrib["name"] for case in ET.fromstring(gate_junit(checks)).iter("testcase")]
    assert len(set(names)) == len(names) == len(checks)


def test_junit_gives_the_reason_where_either_reader_looks(checks: tuple[Check, ...]) -> None:
    (failure,) = ET.fromstring(gate_junit(checks)).iter("failure")
    assert failure.text == failure.attrib["message"]
    assert failure.text == "amazon: max-luts: the block takes 19 LUTs, allowed are 18"
