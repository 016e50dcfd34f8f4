"""Verilog expressions."""

import pytest

from wnn2hdl.emit.expression import Operation, close, render, widen

WIDTHS = {"a": 8, "b": 9, "c": 1}


def test_chains_lose_their_parentheses_and_mixtures_keep_them() -> None:
    inner = Operation("&", ("a", Operation("~", ("b",))))
    chain = Operation("&", (inner, "c")).flat()
    assert render(chain) == "a & ~b & c"
    assert render(Operation("|", (chain, "d"))) == "(a & ~b & c) | d"
    assert render(Operation("~", (chain,))) == "~(a & ~b & c)"
    assert render(Operation("?", ("s", chain, "d"))) == "s ? (a & ~b & c) : d"


@pytest.mark.parametrize(
    ("text", "width", "expected"),
    [
        ("a - x[7:0]", 9, "{1'h0, a} - {1'h0, x[7:0]}"),
        ("$signed(a) + $signed(b)", 10, "{a[7], a[7], a} + {b[8], b}"),
        ("$signed(b) <= $signed(7'h40)", 1, "$signed(b) <= $signed(9'h1c0)"),
        ("$signed(b) >= $signed(8'h40)", 1, "$signed(b) >= $signed(9'h40)"),
        ("a == 3'h5", 1, "a == 8'h5"),
        ("$signed(c) + $signed(x[5:2])", 6, "{c, c, c, c, c, c} + {x[5], x[5], x[5:2]}"),
        ("{a, b}", 17, "{a, b}"),
        ("a", 8, "a"),
    ],
)
def test_operands_get_the_width_of_their_operator(text: str, width: int, expected: str) -> None:
    assert widen(text, width, WIDTHS) == expected


def test_reductions_and_concatenations_lose_blanks() -> None:
    assert close("| { a, b[1:0] }") == "|{a, b[1:0]}"
    assert close("& a ") == "&a"
