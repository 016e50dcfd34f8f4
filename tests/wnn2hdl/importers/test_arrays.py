import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from wnn2hdl.importers.arrays import NUMPY, array_of
from wnn2hdl.importers.pickles import UnreadablePickleError, read_pickle

types = st.sampled_from(["<i8", ">i8", "<i4", "u1", "?", "<f8", ">f4", "<f2", "<u2"])


@given(
    arrays.arrays(types, arrays.array_shapes(min_dims=0, min_side=0)), st.sampled_from([2, 4]), st.booleans()
)
def test_arrays_are_what_numpy_reads(array: Any, protocol: int, columns_first: bool) -> None:
    ordered = np.array(array, order="F" if columns_first else "C")
    found = array_of(read_pickle(pickle.dumps(ordered, protocol), NUMPY.get), "it")
    assert found.shape == array.shape
    assert np.array_equal(found, array, equal_nan=array.dtype.kind == "f")


def test_numbers_of_numpy_are_arrays_without_dimensions() -> None:
    assert read_pickle(pickle.dumps(np.float64(2.5), 4), NUMPY.get) == 2.5


@pytest.mark.parametrize("value", [np.array([{}]), np.array(["text"]), np.array([1j]), np.zeros(1, "i4,i4")])
def test_arrays_of_other_things_are_refused(value: Any) -> None:
    with pytest.raises(UnreadablePickleError):
        array_of(read_pickle(pickle.dumps(value, 4), NUMPY.get), "it")


@pytest.mark.parametrize("value", [3, None, [1, 2]])
def test_other_values_are_no_arrays(value: Any) -> None:
    with pytest.raises(UnreadablePickleError, match="mapping is not an array"):
        array_of(value, "mapping")
