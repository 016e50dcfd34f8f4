import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import CENTRE, WINDOW_CODES, EdgeFilter, window_codes


def test_bit_0_is_top_left_and_bit_8_bottom_right() -> None:
    image = np.zeros((3, 3), dtype=np.bool_)
    for position in range(9):
        image[:] = False
        image.flat[position] = True
        assert window_codes(image).tolist() == [[1 << position]]
    assert CENTRE == 4


@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, min_side=3, max_side=7)))
def test_each_window_is_read_where_it_lies(image: NDArray[np.bool_]) -> None:
    codes = window_codes(image)
    assert codes.shape == (image.shape[0] - 2, image.shape[1] - 2)
    for row, column in np.ndindex(codes.shape):
        window = image[row : row + 3, column : column + 3].ravel().tolist()
        assert codes[row, column] == sum(int(bit) << i for i, bit in enumerate(window))


def test_a_filter_is_its_table() -> None:
    patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
    patterns[[16, 511]] = True
    edges = EdgeFilter("two", patterns)
    assert edges.size == 2
    assert edges.evaluate([[16, 17], [511, 0]]).tolist() == [[True, False], [True, False]]
    table = edges.table()
    assert table.inputs == tuple(f"bit{i}" for i in range(9))
    assert table.outputs == ("edge_bit",)
    assert np.array_equal(table.values[:, 0], patterns)


@given(st.sets(st.integers(0, 511)))
def test_json_gives_the_filter_back(codes: set[int]) -> None:
    patterns = np.isin(np.arange(WINDOW_CODES), sorted(codes))
    again = EdgeFilter.from_json(json.loads(json.dumps(EdgeFilter("any", patterns).to_json())))
    assert again.name == "any"
    assert np.array_equal(again.patterns, patterns)


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"name": "x"},
        {"name": "x", "patterns": [512]},
        {"name": "x", "patterns": [-1]},
        {"name": "x", "patterns": [1.5]},
        {"name": "x", "patterns": 7},
        {"patterns": [7]},
    ],
)
def test_a_saved_filter_that_was_damaged(data: dict[str, object]) -> None:
    with pytest.raises(ModelFileError, match="not a list of edge patterns"):
        EdgeFilter.from_json(data)


def test_a_saved_filter_with_true_for_a_pattern() -> None:
    with pytest.raises(ModelFileError, match="not a list of edge patterns"):
        EdgeFilter.from_json({"name": "x", "patterns": [True]})


def test_a_filter_holds_512_bools() -> None:
    with pytest.raises(ValueError, match="holds 512 bools"):
        EdgeFilter("short", np.zeros(511, dtype=np.bool_))
    with pytest.raises(ValueError, match="holds 512 bools"):
        EdgeFilter("bytes", np.zeros(512, dtype=np.uint8))
