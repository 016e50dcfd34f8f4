"""Numbers on the command line that are numbers, and ranges of them."""

import re

import click
import pytest

from wnn2hdl.cli.finite import FiniteRange, SpanType


def test_numbers_of_the_range_pass() -> None:
    assert FiniteRange(0, 1, min_open=True).convert("0.25", None, None) == 0.25


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "0", "half"])
def test_nothing_else_does(text: str) -> None:
    with pytest.raises(click.BadParameter):
        FiniteRange(0, min_open=True).convert(text, None, None)


def test_a_range_rises_within_its_bounds() -> None:
    assert SpanType("0.8..1.5", 0.1, 10).convert("0.8..1.5", None, None) == (0.8, 1.5)
    assert SpanType("0..0.1", 0, 1).convert("0..0.1", None, None) == (0.0, 0.1)
    assert SpanType("0..3000").convert("-0.5..1e4", None, None) == (-0.5, 1e4)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("0.8", "not a range, as in 0.8..1.5"),
        ("0.8:1.5", "not a range, as in 0.8..1.5"),
        ("1..2..3", "not a range"),
        ("a..b", "not a range"),
        ("1.5..0.8", "does not rise"),
        ("1..1", "does not rise"),
        ("nan..1", "does not rise"),
        ("1..inf", "does not rise"),
        ("0..2", "not within 0.1..10"),
        ("0.5..11", "not within 0.1..10"),
    ],
)
def test_nothing_else_is_a_range(text: str, complaint: str) -> None:
    with pytest.raises(click.BadParameter, match=re.escape(complaint)):
        SpanType("0.8..1.5", 0.1, 10).convert(text, None, None)


def test_a_range_is_spoken_as_it_is_written() -> None:
    span = SpanType("0..3000")
    assert span.convert(span.spoken((-0.5, 0.3)), None, None) == (-0.5, 0.3)
