"""Equivalence of two Verilog modules, apart from any model."""

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.verify.equivalence import Circuit, evaluate, find_differences


def adder(expression: str, name: str = "add", ports: str = "input [3:0] a, input [3:0] b") -> Circuit:
    return Circuit(
        (f"module {name}({ports}, output [4:0] s);\n  assign s = {expression};\nendmodule\n",), name
    )


def test_equal_circuits_have_no_difference_and_a_difference_is_one() -> None:
    plain, other = adder("a + b"), adder("{1'b0, a ^ b} + {a & b, 1'b0}", "other")
    wrong = adder("a + b + (a == 4'd11 & b == 4'd6)", "wrong")
    assert find_differences([(plain, other), (plain, wrong), (other, other)], timeout=60) == [
        None,
        {"a": 11, "b": 6},
        None,
    ]


def test_constant_outputs_are_compared_too() -> None:
    zero, also_zero, one = adder("5'd0", "zero"), adder("a & ~a", "also"), adder("5'd16", "one")
    same, different = find_differences([(zero, also_zero), (zero, one)], timeout=60)
    assert same is None
    assert different is not None


def test_evaluate_answers_for_one_input() -> None:
    answer = evaluate(adder("a + b"), {"a": 9, "b": 12}, {"a": 4, "b": 4}, ["s"])
    assert answer == {"s": 21}


def test_different_ports_are_an_error() -> None:
    wide = adder("a", "wide", "input [5:0] a")
    with pytest.raises(ToolError, match="different ports"):
        find_differences([(adder("a + b"), wide)], timeout=60)


def test_unreadable_verilog_is_an_error() -> None:
    with pytest.raises(ToolError, match="syntax error"):
        find_differences([(adder("a + b"), adder("a +"))], timeout=60)


def test_loops_are_refused() -> None:
    loop = Circuit(
        (
            "module loop(input [3:0] a, input [3:0] b, output [4:0] s);\n"
            "  wire [4:0] t = {1'b0, a} & s;\n  assign s = t | {1'b0, b};\nendmodule\n",
        ),
        "loop",
    )
    with pytest.raises(ToolError, match="check -assert"):
        find_differences([(adder("a + b"), loop)], timeout=60)


def test_a_module_that_asks_to_be_kept_is_looked_into() -> None:
    kept = adder("a + b", "kept").sources[0]
    text = (
        "module top(input [3:0] a, input [3:0] b, output [4:0] s);\n"
        f'  kept k (.a(a), .b(b), .s(s));\nendmodule\n(* keep_hierarchy = "yes" *)\n{kept}'
    )
    assert find_differences([(adder("a + b"), Circuit((text,), "top"))], timeout=60) == [None]
    assert evaluate(Circuit((text,), "top"), {"a": 1, "b": 2}, {"a": 4, "b": 4}, ["s"]) == {"s": 3}
