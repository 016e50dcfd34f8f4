"""A table of numbers as a weighted sum of bits is the table, and takes few columns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.lower.addends import Addends, addends


def added(parts: Addends) -> NDArray[np.int64]:
    width = len(parts.columns).bit_length() - 1
    bits = codes_to_bits(np.arange(len(parts.columns)), width)
    places = 1 << np.arange(parts.columns.shape[1])
    return np.asarray(parts.constant + bits @ np.array(parts.weights) + parts.columns @ places)


@given(
    st.integers(1, 5).flatmap(lambda n: st.lists(st.integers(-99, 99), min_size=1 << n, max_size=1 << n)),
    st.data(),
)
@settings(max_examples=40, deadline=None)
def test_the_sum_is_the_table_wherever_it_matters(values: list[int], data: st.DataObject) -> None:
    care = np.array(data.draw(st.lists(st.booleans(), min_size=len(values), max_size=len(values))))
    care[data.draw(st.integers(0, len(values) - 1))] = True
    parts = addends(np.array(values), care)
    assert np.array_equal(added(parts)[care], np.array(values)[care])


@pytest.mark.parametrize("weights", [(1, 2, 4, 8), (-1, -2, -4, -8), (3, 0, -12, 16)])
def test_a_weighted_sum_of_the_bits_needs_no_table(weights: tuple[int, ...]) -> None:
    values = codes_to_bits(np.arange(16), 4) @ np.array(weights) - 7
    parts = addends(values, np.ones(16, dtype=np.bool_))
    assert (parts.weights, parts.columns.shape[1], parts.constant) == (weights, 0, -7)
