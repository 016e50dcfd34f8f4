import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import Cover, Cube, TruthTable


@st.composite
def tables(draw: st.DrawFn) -> TruthTable:
    inputs, outputs = draw(st.integers(0, 6)), draw(st.integers(0, 3))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    return TruthTable(
        tuple(f"i{x}" for x in range(inputs)),
        tuple(f"o{x}" for x in range(outputs)),
        rng.random((1 << inputs, outputs)) < 0.5,
        rng.random(1 << inputs) < 0.7,
    )


def exclusive_or() -> TruthTable:
    return TruthTable.exact(("a", "b"), ("y",), np.array([[0], [1], [1], [0]], dtype=np.bool_))


def test_rows_are_indexed_by_code() -> None:
    assert exclusive_or().evaluate([1, 3]).tolist() == [[True], [False]]
    assert exclusive_or().care.all()


def test_mismatches_are_counted_where_it_matters() -> None:
    table = exclusive_or()
    wrong = ~table.values
    assert table.mismatches(wrong).tolist() == [0, 1, 2, 3]
    assert table.mismatches(table.values).tolist() == []
    care = np.array([True, False, True, False])
    assert table.with_care(care).mismatches(wrong).tolist() == [0, 2]


@given(tables())
def test_json_gives_the_table_back(table: TruthTable) -> None:
    again = TruthTable.from_json(json.loads(json.dumps(table.to_json())))
    assert (again.inputs, again.outputs) == (table.inputs, table.outputs)
    assert np.array_equal(again.values, table.values)
    assert np.array_equal(again.care, table.care)


def test_a_column_is_a_hexadecimal_number_whose_bit_c_is_code_c() -> None:
    values = np.zeros((16, 1), dtype=np.bool_)
    values[[0, 9]] = True
    data = TruthTable.exact(("a", "b", "c", "d"), ("y",), values).to_json()
    assert data["values"] == ["0201"]
    assert data["care"] == "ffff"


@pytest.mark.parametrize(
    ("values", "care"),
    [
        (np.zeros((3, 1), dtype=np.bool_), np.ones(4, dtype=np.bool_)),
        (np.zeros((4, 2), dtype=np.bool_), np.ones(4, dtype=np.bool_)),
        (np.zeros((4, 1), dtype=np.bool_), np.ones(3, dtype=np.bool_)),
        (np.zeros((4, 1), dtype=np.uint8), np.ones(4, dtype=np.bool_)),
    ],
)
def test_shapes_and_types_that_fit_no_table(values: Any, care: Any) -> None:
    with pytest.raises(ValueError, match=r"cannot have values|must be bool"):
        TruthTable(("a", "b"), ("y",), values, care)


def test_more_inputs_than_a_table_may_have() -> None:
    empty = np.zeros((0, 0), dtype=np.bool_)
    with pytest.raises(ValueError, match="at most 20 inputs, not 21"):
        TruthTable.exact(tuple(f"i{x}" for x in range(21)), (), empty)


@pytest.mark.parametrize(
    "change",
    [
        {"values": ["zz"]},
        {"values": ["ffff"]},
        {"values": ["10"]},
        {"values": [3]},
        {"values": ["00", "00"]},
        {"care": ""},
        {"inputs": 4},
        {"inputs": [f"i{x}" for x in range(60)]},
    ],
)
def test_a_saved_table_that_was_damaged(change: dict[str, Any]) -> None:
    with pytest.raises(ModelFileError, match="not a truth table"):
        TruthTable.from_json({**exclusive_or().to_json(), **change})


@pytest.mark.parametrize("key", ["inputs", "outputs", "values", "care"])
def test_a_saved_table_with_a_part_missing(key: str) -> None:
    data = exclusive_or().to_json()
    del data[key]
    with pytest.raises(ModelFileError, match="not a truth table"):
        TruthTable.from_json(data)


def test_a_cover_is_the_or_of_its_cubes() -> None:
    cover = Cover(("a", "b"), ("xor", "a"), (Cube(3, 1, 0b01), Cube(3, 2, 0b01), Cube(1, 1, 0b10)))
    assert cover.evaluate(range(4)).tolist() == [[False, False], [True, True], [True, False], [False, True]]
    assert cover.literals == 5


def test_the_empty_cube_is_true_and_the_empty_cover_false() -> None:
    assert Cover(("a",), ("y",), (Cube(0, 0, 1),)).evaluate([0, 1]).all()
    assert not Cover(("a",), ("y",), ()).evaluate([0, 1]).any()


@given(tables())
def test_one_cube_a_row_covers_the_table(table: TruthTable) -> None:
    full = (1 << len(table.inputs)) - 1
    cubes = tuple(
        Cube(full, code, sum(int(bit) << j for j, bit in enumerate(row)))
        for code, row in enumerate(table.values)
    )
    cover = Cover(table.inputs, table.outputs, cubes)
    assert np.array_equal(cover.evaluate(np.arange(full + 1)), table.values)
