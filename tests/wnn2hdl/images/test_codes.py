"""One number stands for a value or a colour of a mask."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.images.codes import code_of, colour_codes, colour_of, parse_code, spoken, value_codes

level = st.integers(0, 255)


@given(colour=st.tuples(level, level, level))
def test_a_code_is_a_colour_and_is_written_as_it_is_read(colour: tuple[int, int, int]) -> None:
    code = code_of(colour)
    assert colour_of(code) == colour
    assert parse_code(spoken(code)) == code
    assert colour_codes(np.array([[colour]], dtype=np.uint8)).tolist() == [[code]]


@given(value=st.integers(-1000, 1000))
def test_a_value_is_its_code(value: int) -> None:
    assert parse_code(str(value)) == parse_code(value) == value
    assert spoken(value) == str(value)


def test_a_grey_and_a_value_are_the_same_and_a_dark_blue_is_not() -> None:
    assert parse_code("#030303") == parse_code("3") == 3
    assert parse_code("#000003") not in range(256)


@pytest.mark.parametrize("entry", ["", "wet", "#12", 7.5, None, True, 1 << 30])
def test_what_is_no_code_is_refused(entry: object) -> None:
    with pytest.raises(ValueError, match=r".+"):
        parse_code(entry)


def test_values_that_are_no_whole_numbers_are_refused_where_they_are_valid() -> None:
    values = np.array([[0.0, 1.0, np.nan, 0.5]], dtype=np.float32)
    valid = np.array([[True, True, False, False]])
    assert value_codes(values, valid, Path("m.tif")).tolist() == [[0, 1, 0, 0]]
    with pytest.raises(InputError, match=r"1 values of the mask do not stand for a class: m\.tif \(0\.5\)"):
        value_codes(values, np.isfinite(values), Path("m.tif"))
