"""Small functions as equations."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Equation, equation

NAMES = "abcdef"


@given(st.integers(1, 6), st.data())
def test_the_text_computes_the_table(width: int, data: st.DataObject) -> None:
    contents = data.draw(st.integers(0, (1 << (1 << width)) - 1))
    text = equation(contents, width).text(NAMES[:width])
    for address in range(1 << width):
        values = {NAMES[i]: address >> i & 1 for i in range(width)}
        assert eval(text, {"__builtins__": {}}, values) & 1 == contents >> address & 1


@pytest.mark.parametrize(
    ("contents", "width", "kind", "text"),
    [
        (0b00, 1, "sum", "0"),
        (0b11, 1, "sum", "1"),
        (0b10, 1, "sum", "a"),
        (0b01, 1, "sum", "~a"),
        (0b1000, 2, "sum", "a & b"),
        (0x7FFF, 4, "sum", "~a | ~b | ~c | ~d"),
        (0b11101000, 3, "sum", "a & b | a & c | b & c"),
        (0b0110, 2, "parity", "a ^ b"),
        (0b01101001, 3, "parity", "~(a ^ b ^ c)"),
        (sum(1 << x for x in range(16) if x & 3 and x & 12), 4, "product", "(a | b) & (c | d)"),
        (sum(1 << x for x in range(16) if x & 7 and not x & 8), 4, "product", "(a | b | c) & ~d"),
    ],
)
def test_the_shortest_form_is_taken_and_has_no_superfluous_parentheses(
    contents: int, width: int, kind: str, text: str
) -> None:
    found = equation(contents, width)
    assert found.kind == kind
    assert found.text(NAMES[:width]) == text


def test_literals_decide_between_a_sum_and_its_complement() -> None:
    three_clauses = sum(1 << a for a in range(64) if a & 3 and a & 12 and a & 48)
    assert (equation(three_clauses, 6).kind, equation(three_clauses, 6).literals) == ("product", 6)
    assert equation((1 << 64) - 1 - (1 << 63), 6).literals == 6
    assert equation(0b1001, 2) == Equation("parity", ((0b11, 1),))
