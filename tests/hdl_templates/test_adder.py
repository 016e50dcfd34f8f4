"""Sums of weighted bits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates.adder import sum_network
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.packing import packed_luts


@given(
    st.lists(st.integers(-17, 17).filter(bool), min_size=1, max_size=11),
    st.integers(-9, 9),
    st.integers(1, 9),
)
@settings(max_examples=40, deadline=None)
def test_the_network_adds_the_weights_of_the_set_bits(weights: list[int], offset: int, width: int) -> None:
    codes = np.arange(1 << len(weights))
    total = codes_to_bits(codes, len(weights)) @ np.array(weights) + offset
    wanted = codes_to_bits(total % (1 << width), width)
    np.testing.assert_array_equal(sum_network(tuple(weights), offset, width).evaluate(codes), wanted)


@pytest.mark.parametrize(("bits", "luts"), [(3, 1), (5, 2), (6, 3), (7, 4), (10, 7), (20, 15), (64, 57)])
def test_counting_bits_takes_few_luts(bits: int, luts: int) -> None:
    assert packed_luts(sum_network((1,) * bits, 0, bits.bit_length())) == luts


@pytest.mark.parametrize(
    ("weights", "offset", "width", "luts"), [((15,) * 4, 0, 6, 5), ((-1,) * 6, 6, 3, 3), ((1, -1), 1, 2, 1)]
)
def test_few_digits_are_added_and_inverting_is_free(
    weights: tuple[int, ...], offset: int, width: int, luts: int
) -> None:
    assert packed_luts(sum_network(weights, offset, width)) == luts
