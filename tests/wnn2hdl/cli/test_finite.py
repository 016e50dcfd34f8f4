"""Numbers on the command line that are numbers, and ranges of them."""

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
    assert SpanType(0.1, 10).convert("0.8..1.5", None, None) == (0.8, 1.5)
    assert SpanType(0, 1).convert("0..0.1", None, None) == (0.0, 0.1)


@pytest.mark.parametrize("text", ["0.8", "1.5..0.8", "1..1", "0..2", "0.5..11", "nan..1", "1..2..3", "a..b"])
def test_nothing_else_is_a_range(text: str) -> None:
    with pytest.raises(click.BadParameter, match=r"is not a range|does not rise within"):
        SpanType(0.1, 10).convert(text, None, None)
