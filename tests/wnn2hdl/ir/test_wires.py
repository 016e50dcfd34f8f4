"""Ports, slices and words."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir.wires import MAX_WORD, Port, Slice, read_word, width_of, word_from_json, word_to_json

NETS = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,8}(\.[a-z0-9_]{1,8})?", fullmatch=True)
SLICES = st.builds(Slice, NETS, st.integers(0, 300), st.integers(1, 300))


def test_a_slice_is_written_as_in_verilog() -> None:
    assert str(Slice("window", 24, 24)) == "window[47:24]"
    assert Slice.parse("pixel_0.class_bits[0:0]") == Slice("pixel_0.class_bits")


@given(st.lists(SLICES).map(tuple))
def test_words_read_back_as_they_were_written(word: tuple[Slice, ...]) -> None:
    assert word_from_json(word_to_json(word)) == word


@pytest.mark.parametrize(
    "text", ["a", "a[0]", "a[0:1]", "a[-1:0]", "[1:0]", "a b[1:0]", "a[1:0] ", "9[1:0]", ""]
)
def test_anything_else_is_no_slice(text: str) -> None:
    with pytest.raises(ValueError, match="is not a slice of a net"):
        Slice.parse(text)


def test_the_first_slice_of_a_word_holds_the_least_significant_bits() -> None:
    nets = {"a": np.array([[True, False, False]]), "b": np.array([[False, True]])}
    word = (Slice("b", 0, 2), Slice("a", 0, 1), Slice("a", 2, 1))
    assert width_of(word) == 4
    assert read_word(nets, word).tolist() == [[False, True, True, False]]
    assert read_word(nets, (Slice("a", 1, 2),)).tolist() == [[False, False]]


def test_the_word_of_a_port_is_all_of_it() -> None:
    assert Port("rgb", 24).word == (Slice("rgb", 0, 24),)


def test_a_port_has_bits() -> None:
    with pytest.raises(ValueError, match="port rgb has 0 bits; it may have 1 to 1048576"):
        Port("rgb", 0)
    with pytest.raises(ValueError, match="port rgb has 1048577 bits"):
        Port("rgb", MAX_WORD + 1)


@pytest.mark.parametrize(
    "name", ["edge", "Signal", "int", "a b", "a-b", "1st", "a__b", "a_", "_a", "clk", "", "é"]
)
def test_a_port_has_a_name_that_every_hdl_can_have(name: str) -> None:
    with pytest.raises(ValueError, match=r"is not a name|reserved word|called clk"):
        Port(name, 1)
