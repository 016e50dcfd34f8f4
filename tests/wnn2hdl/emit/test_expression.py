"""Verilog expressions."""

import pytest

from wnn2hdl.emit.expression import Operation, Piece, constant, pieces, render, render_word

WIDTHS = {"a": 8, "b": 9, "c": 1}


def test_chains_lose_their_parentheses_and_mixtures_keep_them() -> None:
    inner = Operation("&", ("a", Operation("~", ("b",))))
    chain = Operation("&", (inner, "c")).flat()
    assert render(chain) == "a & ~b & c"
    assert render(Operation("|", (chain, "d"))) == "(a & ~b & c) | d"
    assert render(Operation("~", (chain,))) == "~(a & ~b & c)"
    assert render(Operation("?", ("s", chain, "d"))) == "s ? (a & ~b & c) : d"


def test_a_choice_inside_a_choice_is_no_chain() -> None:
    inner = Operation("?", ("s", "a", "b"))
    assert render(Operation("?", ("t", inner, "c")).flat()) == "t ? (s ? a : b) : c"
    assert render(Operation("~", (Operation("~", ("a",)),)).flat()) == "~~a"


def test_neighbours_are_joined_to_words() -> None:
    bits: list[Piece] = [("a", 2, 1), ("a", 3, 1), ("b", 4, 1), ("a", 5, 2), ("a", 7, 1)]
    assert pieces(bits) == [("a", 2, 2), ("b", 4, 1), ("a", 5, 3)]
    assert pieces([("a", 3, 1), ("a", 2, 1)]) == [("a", 3, 1), ("a", 2, 1)]


def test_constants_are_joined_to_numbers() -> None:
    bits: list[Piece] = [("", 1, 1), ("", 0, 1), ("", 1, 1), ("a", 0, 1), ("", 1, 1)]
    assert pieces(bits) == [("", 0b101, 3), ("a", 0, 1), ("", 1, 1)]


@pytest.mark.parametrize(
    ("word", "text"),
    [
        ([("a", 0, 8)], "a"),
        ([("c", 0, 1)], "c"),
        ([("a", 7, 1)], "a[7]"),
        ([("a", 2, 3)], "a[4:2]"),
        ([("", 5, 3)], "3'h5"),
        ([("a", 0, 8), ("", 0, 1), ("b", 0, 1)], "{b[0], 1'h0, a}"),
    ],
)
def test_a_word_is_written_with_the_most_significant_bits_first(word: list[Piece], text: str) -> None:
    assert render_word(word, WIDTHS) == text


def test_constants_have_all_their_digits() -> None:
    assert constant(0, 9) == "9'h000"
    assert constant(0xB3, 8) == "8'hb3"
