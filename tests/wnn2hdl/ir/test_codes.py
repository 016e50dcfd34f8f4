import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.ir import all_codes, bits_to_codes, codes_to_bits


def test_bit_i_of_a_code_is_element_i() -> None:
    assert codes_to_bits(0b0110, 4).tolist() == [False, True, True, False]
    assert bits_to_codes([[True, False, False], [False, False, True]]).tolist() == [1, 4]


@given(st.integers(1, 63).flatmap(lambda w: st.tuples(st.just(w), st.lists(st.integers(0, 2**w - 1)))))
def test_unpacking_and_packing_is_the_identity(case: tuple[int, list[int]]) -> None:
    width, codes = case
    bits = codes_to_bits(codes, width)
    assert bits.shape == (len(codes), width)
    assert bits_to_codes(bits).tolist() == codes


def test_shapes_are_kept() -> None:
    codes = np.arange(6).reshape(2, 3)
    assert codes_to_bits(codes, 5).shape == (2, 3, 5)
    assert np.array_equal(bits_to_codes(codes_to_bits(codes, 5)), codes)


def test_more_codes_than_a_table_has_rows_are_refused_before_they_are_made() -> None:
    assert all_codes(2).tolist() == [0, 1, 2, 3]
    for width in (21, 52, 10**9):
        with pytest.raises(InputError, match=f"too many input bits for one truth table: {width} bits"):
            all_codes(width)
