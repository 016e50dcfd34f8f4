"""Two builds side by side."""

import copy
from typing import Any

import numpy as np
import pytest

from wnn2hdl.ir import Lut, LutNetwork
from wnn2hdl.report.compare import Change, compare, compare_tables

MINUS = "\N{MINUS SIGN}"


def figures(first: dict[str, Any], second: dict[str, Any]) -> dict[str, Change]:
    return {change.what: change for change in compare(first, second)["Figures"]}


def test_the_same_build_shows_no_change(report: dict[str, Any]) -> None:
    sections = compare(report, report)
    assert not any(change.change for change in sections["Figures"])
    assert sections["Options"] == sections["Tools"] == sections["Files, SHA-256"] == ()


def test_changes_are_told_and_judged(report: dict[str, Any]) -> None:
    other = copy.deepcopy(report)
    other["parts"]["block"]["luts"] = 10
    other["parts"]["pixel"]["luts"] = None
    other["accuracy"] = 0.9
    other["care"] |= {"codes": 64}
    other |= {
        "mode": "exact",
        "options": report["options"] | {"edges": "learned"},
        "tools": {"pyosys": "0.71"},
    }
    changed = figures(report, other)
    assert changed["LUTs of block"] == Change("LUTs of block", "19", "10", MINUS + "9", "better")
    assert changed["LUTs of pixel"].change == "measured in one build only"
    assert changed["LUTs of edge"] == Change("LUTs of edge", "1", "1", "", "")
    assert changed["accuracy of the circuit"].change == MINUS + "1.65 points"
    assert changed["accuracy of the circuit"].judgement == "worse"
    assert changed["codes cared for"] == Change("codes cared for", "150", "64", MINUS + "86", "")
    assert changed["mode"] == Change("mode", "domain", "exact", "differs")
    sections = compare(report, other)
    assert sections["Options"] == (Change("edges", "boundary", "learned", "differs"),)
    assert sections["Tools"] == (
        Change("wnn2hdl", "0.1.0", "n/a", "differs"),
        Change("pyosys", "0.70", "0.71", "differs"),
    )


def test_delays_change_by_picoseconds(report: dict[str, Any]) -> None:
    other = copy.deepcopy(report)
    other["parts"]["block"]["delay_ps"] += 1127
    assert figures(report, other)["logic delay of the target"].change == "+1,127 ps"


def test_a_small_change_is_not_told_as_none(report: dict[str, Any]) -> None:
    other = report | {"accuracy": report["accuracy"] + 1e-6}
    assert figures(report, other)["accuracy of the circuit"].change == "+0.0001 points"


@pytest.mark.parametrize(
    ("difference", "reported"),
    [
        (0.0000038147, "+0.0004 points"),
        (-0.0000038147, MINUS + "0.0004 points"),
        (0.000096, "+0.01 points"),
        (0.012345, "+1.23 points"),
        (1e-9, "less than 0.0001 points more"),
        (-1e-16, "less than 0.0001 points fewer"),
    ],
)
def test_points_have_as_many_digits_as_a_person_reads(
    report: dict[str, Any], difference: float, reported: str
) -> None:
    other = report | {"accuracy": 0.5 + difference}
    assert figures(report | {"accuracy": 0.5}, other)["accuracy of the circuit"].change == reported


def test_many_tables_are_summed_up() -> None:
    one = {f"t{i}": lut("ab", 0b1000) for i in range(1000)}
    changes = compare_tables(one, one | {"t7": lut("ab", 0b1001)})
    assert [change.what for change in changes] == ["function of t7", "functions that are the same"]
    assert changes[1].after == "999 of 1,000"


def test_cubes_of_many_tables_are_summed_up(report: dict[str, Any]) -> None:
    sizes = report["minimised"]["pixel"]
    first = report | {"minimised": {f"t{i}": sizes for i in range(1000)}}
    second = first | {"minimised": first["minimised"] | {"t7": sizes | {"cubes_after": 10}}}
    reported = [change for change in compare(first, second)["Figures"] if change.what.startswith("cubes")]
    assert reported == [Change("cubes of all 1,000 tables", "11,000", "10,999", MINUS + "1")]


@pytest.mark.parametrize(
    ("after", "reported"), [(0.91, "+1 points"), (1.0, "+10 points"), (0.915, "+1.5 points")]
)
def test_whole_points_have_no_decimal_point(report: dict[str, Any], after: float, reported: str) -> None:
    assert (
        figures(report | {"accuracy": 0.9}, report | {"accuracy": after})["accuracy of the circuit"].change
        == reported
    )


def lut(inputs: str, init: int) -> LutNetwork:
    return LutNetwork(tuple("abcd"), (Lut("t0", tuple(inputs), init),), (("f", "t0"),))


def test_functions_are_compared_over_the_inputs_that_either_reads() -> None:
    one, other = lut("ab", 0b1000), lut("ac", 0b1000)
    (change,) = compare_tables({"pixel": one}, {"pixel": other})
    codes = np.arange(16)
    rows = (one.evaluate(codes) != other.evaluate(codes)).sum() // 2
    assert rows == 2
    assert change.change == "differ in 2 of 8 rows, 25.0 %"


def test_the_order_of_inputs_is_no_difference() -> None:
    one = LutNetwork(("a", "b"), (Lut("t0", ("a", "b"), 0b0010),), (("f", "t0"),))
    other = LutNetwork(("b", "x", "a"), (Lut("u", ("b", "a"), 0b0100),), (("f", "u"),))
    assert compare_tables({"pixel": one}, {"pixel": other})[0].change == ""


def test_what_cannot_be_compared_is_said() -> None:
    wide = [
        LutNetwork(tuple(f"{x}{i}" for i in range(12)), (), tuple((f"f{i}", f"{x}{i}") for i in range(12)))
        for x in "ab"
    ]
    (change,) = compare_tables({"pixel": wide[0]}, {"pixel": wide[1]})
    assert change.change == "not compared: 24 inputs together"
    assert compare_tables({"pixel": lut("a", 1)}, {})[0].change == "in one build only"
    renamed = LutNetwork(("a",), (), (("g", "a"),))
    assert compare_tables({"pixel": lut("a", 1)}, {"pixel": renamed})[0].change == "other outputs"
