"""Numbers on the command line that are numbers."""

import click
import pytest

from wnn2hdl.cli.finite import FiniteRange


def test_numbers_of_the_range_pass() -> None:
    assert FiniteRange(0, 1, min_open=True).convert("0.25", None, None) == 0.25


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "0", "half"])
def test_nothing_else_does(text: str) -> None:
    with pytest.raises(click.BadParameter):
        FiniteRange(0, min_open=True).convert(text, None, None)
