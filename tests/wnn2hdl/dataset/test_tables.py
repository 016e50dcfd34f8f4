from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError


def test_all_columns_but_the_label_are_features(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text('\ufeffa,class,"b, c"\n1,x,-2.5\n\n3e2, y ,4\n', encoding="utf-8")
    table = read_table(path, "class")
    assert table.columns == ("a", "b, c")
    assert table.features.tolist() == [[1.0, -2.5], [300.0, 4.0]]
    assert table.labels == ("x", "y")


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"", r"no such column: class in .*"),
        (b"a,b\n1,2\n", r"no such column: class in .*; it has a, b"),
        (b"class\nx\n", "a table needs features"),
        (b"a,a,class\n1,2,x\n", "each with its own name"),
        (b"a,class\n", "the table has no rows"),
        (b"a,class\n1,x\n2\n", "no label or another length than the first: row 2 of"),
        (b"a,class\n1, \n", "no label or another length than the first: row 1 of"),
        (b"a,class\nnan,x\n", "not a finite number: 'nan' in row 1 of"),
        (b"a,class\n1,x\ninf,x\n", "not a finite number: 'inf' in row 2 of"),
        (b"a,class\n,x\n", "not a finite number: '' in row 1 of"),
        (b"a,class\n1e999,x\n", "not a finite number"),
        (b"a,class\n\xff,x\n", "not a CSV table"),
        (b'a,class\n"1"2,x\n', "not a CSV table"),
    ],
)
def test_a_table_that_cannot_be_used_gets_one_line(tmp_path: Path, content: bytes, line: str) -> None:
    path = tmp_path / "t.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=line):
        read_table(path, "class")


def test_a_missing_table(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read a table: .*No such file"):
        read_table(tmp_path / "none.csv", "class")


numbers = st.floats(allow_nan=False, allow_infinity=False)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(numbers, numbers, st.sampled_from(["a", "b"])), min_size=1, max_size=8))
def test_numbers_come_back_exactly(tmp_path: Path, rows: list[tuple[float, float, str]]) -> None:
    path = tmp_path / "t.csv"
    path.write_text("x,y,class\n" + "".join(f"{a!r},{b!r},{label}\n" for a, b, label in rows))
    table = read_table(path, "class")
    assert table.features.tolist() == [[a, b] for a, b, _ in rows]
    assert table.labels == tuple(label for _, _, label in rows)


def test_arrays_are_flattened_to_rows(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    images = np.arange(12, dtype=np.uint8).reshape(3, 2, 2)
    np.savez(path, x_train=images, y_train=[4, 2, 4], x_test=images[:1] + 1, y_test=["b"])
    table = read_table(path, None, "train")
    assert table.features.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]]
    assert table.labels == ("4", "2", "4")
    assert table.columns == ("x0", "x1", "x2", "x3")
    assert read_table(path, None).features.tolist() == [[1, 2, 3, 4]]
    assert read_table(path, None).labels == ("b",)


@pytest.mark.parametrize(
    ("arrays", "line"),
    [
        ({"x": [[1.0]]}, "the file has no such array: x_test in .*; it has x"),
        ({"x_test": [[1.0]], "y_test": [1, 2]}, r"one label for each row of features: shapes \[1, 1\] and"),
        ({"x_test": [1.0], "y_test": [1]}, "one label for each row"),
        ({"x_test": [["a"]], "y_test": [1]}, "features must be numbers"),
        ({"x_test": [[1.0]], "y_test": [1.5]}, "labels whole numbers or texts"),
        ({"x_test": [[np.inf]], "y_test": [1]}, "a feature is not a finite number"),
        ({"x_test": np.array([[None]]), "y_test": [1]}, "not a file of NumPy arrays"),
    ],
)
def test_arrays_that_cannot_be_used_get_one_line(tmp_path: Path, arrays: Any, line: str) -> None:
    path = tmp_path / "a.npz"
    np.savez(path, **arrays)
    with pytest.raises(InputError, match=line):
        read_table(path, None)


def test_labels_are_named_for_tables_and_not_for_arrays(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", x_test=[[1.0]], y_test=[1])
    with pytest.raises(InputError, match="arrays have no columns: --label class"):
        read_table(tmp_path / "a.npz", "class")
    (tmp_path / "t.csv").write_text("x,class\n1,a\n")
    with pytest.raises(InputError, match=r"which column has the labels\?: .*; name it with --label"):
        read_table(tmp_path / "t.csv", None)
