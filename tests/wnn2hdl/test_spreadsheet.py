import csv

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.spreadsheet import csv_lines


def test_a_line_for_each_row_and_one_for_the_headers() -> None:
    lines = list(csv_lines(["name", "value"], [["a,b", -1.5], [None, 2]]))
    assert lines == ["name,value\n", '"a,b",-1.5\n', ",2\n"]


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", " \r\n=1"])
def test_no_text_is_run_as_a_formula(text: str) -> None:
    _, line = csv_lines(["frame"], [[text]])
    assert next(csv.reader([line]))[0] == "'" + " ".join(text.splitlines())


@given(st.lists(st.text(), min_size=1))
def test_no_text_adds_a_row_or_a_column(cells: list[str]) -> None:
    _, line = csv_lines(cells, [cells])
    assert line.count("\n") == 1
    (back,) = csv.reader([line], strict=True)
    assert [text.removeprefix("'") for text in back] == [
        " ".join(text.splitlines()).removeprefix("'") for text in cells
    ]
