"""Winner-takes-all."""

from typing import Literal

import numpy as np
import pytest

from hdl_templates.winner import winner_network
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.packing import packed_luts

Tie = Literal["first", "last"]


@pytest.mark.parametrize("tie", ["first", "last"])
@pytest.mark.parametrize("widths", [(1, 1), (2, 1, 3), (2, 2, 2, 2), (1, 3, 2, 1, 3), (5, 6), (7, 8)])
def test_the_largest_word_wins_and_the_rule_decides_ties(widths: tuple[int, ...], tie: Tie) -> None:
    codes = np.arange(1 << sum(widths))
    words = [codes >> sum(widths[:i]) & ((1 << width) - 1) for i, width in enumerate(widths)]
    largest = np.max(words, axis=0)
    order = range(len(words)) if tie == "first" else range(len(words))[::-1]
    winner = np.select([words[i] == largest for i in order], list(order))
    index = codes_to_bits(winner, (len(words) - 1).bit_length())
    np.testing.assert_array_equal(winner_network(widths, tie=tie).evaluate(codes), index)


def test_five_words_of_four_bits_take_fourteen_luts() -> None:
    assert packed_luts(winner_network((4,) * 5, tie="first")) == 14


def test_the_network_grows_with_the_words_not_faster() -> None:
    """Nested expressions would be of a size that is exponential in the levels of the tree."""
    assert len(winner_network((8,) * 100, tie="first").luts) < 100 * 16
