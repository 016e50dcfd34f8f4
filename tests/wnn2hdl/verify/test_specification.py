"""Claims: words as numbers, care sets as flags."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.ir.care import Codes, Everything, Implied
from wnn2hdl.ir.pixels import bits_to_pixels, pixel_bits
from wnn2hdl.ir.wires import word_values
from wnn2hdl.verify.specification import flags_of, show, value_bits


@given(st.integers(1, 230).flatmap(lambda width: st.tuples(st.just(width), st.integers(0, 2**width - 1))))
def test_a_word_of_any_width_is_its_number(case: tuple[int, int]) -> None:
    width, value = case
    bits = value_bits(value, width)
    assert bits.shape == (1, width)
    assert bits.dtype == np.bool_
    assert word_values(bits) == [value]


def test_a_window_port_holds_pixel_0_in_its_low_bits_and_red_in_each_pixels_high_byte() -> None:
    pixels = np.arange(27, dtype=np.uint8).reshape(1, 9, 3)
    (word,) = word_values(pixel_bits(pixels))
    assert word & 0xFFFFFF == 0x000102
    assert word >> 24 * 8 == 0x18191A
    assert np.array_equal(bits_to_pixels(value_bits(word, 216)), pixels)


def test_each_kind_of_care_set_says_which_codes_matter() -> None:
    some = np.array([True, False, True, True])
    assert flags_of(Everything(2), 2, "pixel").tolist() == [True] * 4
    assert flags_of(Codes(some), 2, "pixel").tolist() == some.tolist()
    assert flags_of(Implied(2, ((0, 1),)), 2, "pixel").tolist() == [True, True, False, True]


def test_an_empty_care_set_is_refused_since_any_circuit_would_pass() -> None:
    with pytest.raises(InputError, match=r"care set of the pixel is empty.*nothing to prove"):
        flags_of(Codes(np.zeros(4, dtype=np.bool_)), 2, "pixel")


def test_values_are_shown_in_hexadecimal() -> None:
    assert show({"window": 255, "reference_bits": 16}) == "window 0xff, reference_bits 0x10"


def test_a_care_set_of_other_codes_is_refused() -> None:
    with pytest.raises(InputError, match=r"has other codes: 30 bits, not 2"):
        flags_of(Everything(30), 2, "pixel")
