"""The gate says no where a build got worse, and only there."""

from dataclasses import replace
from typing import Any

import pytest

from wnn2hdl.report import gate
from wnn2hdl.report.baseline import Recorded, recorded
from wnn2hdl.report.gate import Check, Limits

NONE = Limits()


def run_gate(
    reports: dict[str, dict[str, Any]],
    limits: Limits,
    baseline: dict[str, Recorded] | None,
    changes: tuple[str, ...] = (),
) -> tuple[Check, ...]:
    """The gate over builds whose files all have the same changes."""
    return gate.run_gate(reports, dict.fromkeys(reports, changes), limits, baseline)


def failed(checks: tuple[Check, ...]) -> list[tuple[str, str]]:
    return [(check.name, check.text) for check in checks if not check.passed]


def test_a_build_as_it_was_passes(report: dict[str, Any]) -> None:
    checks = run_gate({"x": report}, Limits(19, 0.9165, 0), {"x": recorded(report)})
    assert failed(checks) == []
    assert [check.name for check in checks] == [
        "proof",
        "files",
        "max-luts",
        "min-accuracy",
        "build",
        "luts of block",
        "luts of edge",
        "luts of match",
        "luts of pixel",
        "accuracy",
    ]
    assert not any(check.better for check in checks)


@pytest.mark.parametrize("status", ["failed", "simulated", "not run"])
def test_what_is_not_proved_fails(report: dict[str, Any], status: str) -> None:
    report["proof"]["status"] = status
    assert failed(run_gate({"x": report}, NONE, None)) == [
        ("proof", f"{status}, not proved equal to the model")
    ]


def test_the_reason_of_a_failure_is_told(report: dict[str, Any]) -> None:
    report["proof"] |= {"status": "failed", "failure": "the Verilog of the pixel differs"}
    assert failed(run_gate({"x": report}, NONE, None)) == [
        ("proof", "failed, not proved equal to the model: the Verilog of the pixel differs")
    ]


def test_a_build_that_was_changed_after_its_proof_fails(report: dict[str, Any]) -> None:
    changes = ("block.v was changed", "model.json is missing")
    assert failed(run_gate({"x": report}, NONE, None, changes)) == [
        ("files", "block.v was changed, model.json is missing")
    ]


@pytest.mark.parametrize(("allowed", "passes"), [(18, False), (19, True)])
def test_luts_of_the_target_are_limited(report: dict[str, Any], allowed: int, passes: bool) -> None:
    wrong = [] if passes else [("max-luts", f"the block takes 19 LUTs, allowed are {allowed}")]
    assert failed(run_gate({"x": report}, Limits(max_luts=allowed), None)) == wrong


@pytest.mark.parametrize(("least", "passes"), [(0.91650001, False), (0.9165, True)])
def test_accuracy_has_a_least(report: dict[str, Any], least: float, passes: bool) -> None:
    wrong = [] if passes else [("min-accuracy", "0.9165, at least 0.91650001 is asked for")]
    assert failed(run_gate({"x": report}, Limits(min_accuracy=least), None)) == wrong


def test_what_was_not_measured_passes_no_limit(report: dict[str, Any]) -> None:
    report["accuracy"] = report["parts"]["block"]["luts"] = None
    assert failed(run_gate({"x": report}, Limits(100, 0.0), None)) == [
        ("max-luts", "the block was not counted, allowed are 100"),
        ("min-accuracy", "not measured, at least 0 is asked for"),
    ]


@pytest.mark.parametrize(
    ("rise", "regress", "passes"), [(1, 0, False), (1, 1, True), (2, 1, False), (-1, 0, True)]
)
def test_no_part_rises_by_more_than_allowed(
    report: dict[str, Any], rise: int, regress: int, passes: bool
) -> None:
    before = recorded(report)
    report["parts"]["edge"]["luts"] += rise
    checks = run_gate({"x": report}, Limits(max_regress=regress), {"x": before})
    assert [name for name, _ in failed(checks)] == ([] if passes else ["luts of edge"])
    assert [check.name for check in checks if check.better] == (["luts of edge"] if rise < 0 else [])


def test_the_rival_may_rise(report: dict[str, Any]) -> None:
    before = recorded(report)
    report["parts"]["sobel"]["luts"] += 10
    assert failed(run_gate({"x": report}, NONE, {"x": before})) == []


def test_accuracy_may_not_fall_by_one_pixel(report: dict[str, Any]) -> None:
    before = recorded(report)
    report["accuracy"] -= 1e-7
    assert failed(run_gate({"x": report}, NONE, {"x": before})) == [
        ("accuracy", "0.9164999, in the baseline 0.9165")
    ]
    report["accuracy"] = None
    assert failed(run_gate({"x": report}, NONE, {"x": before})) == [
        ("accuracy", "not measured, in the baseline 0.9165")
    ]
    assert failed(run_gate({"x": report}, NONE, {"x": replace(before, accuracy=None)})) == []


def test_both_sides_must_know_a_build(report: dict[str, Any]) -> None:
    checks = run_gate({"x": report}, NONE, {"y": recorded(report)})
    assert [(check.build, check.text) for check in checks if not check.passed] == [
        ("x", "not in the baseline; record it with --write-baseline"),
        ("y", "in the baseline, but not among the builds"),
    ]


def test_both_sides_must_know_a_part(report: dict[str, Any]) -> None:
    known = recorded(report)
    before = Recorded(known.accuracy, {"block": 19, "edge": 1, "pixel": 2, "old": 3}, "domain", "block")
    assert failed(run_gate({"x": report}, NONE, {"x": before})) == [
        ("luts of match", "10, not in the baseline; record it with --write-baseline"),
        ("luts of old", "not measured, in the baseline 3"),
    ]


def test_luts_of_another_mode_are_no_measure(report: dict[str, Any]) -> None:
    before = replace(recorded(report), mode="exact")
    assert failed(run_gate({"x": report}, NONE, {"x": before})) == [
        ("build", "block, domain mode and in the baseline block, exact mode")
    ]
