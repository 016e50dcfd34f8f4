"""Care sets: the four kinds agree on what is allowed."""

import json
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.care import CareSet, Codes, Everything, Implied, Patterns, care_from_json

WIDTHS = st.integers(1, 8)


@st.composite
def codes(draw: st.DrawFn) -> Codes:
    width = draw(WIDTHS)
    return Codes(np.array(draw(st.lists(st.booleans(), min_size=1 << width, max_size=1 << width))))


@st.composite
def patterns(draw: st.DrawFn) -> Patterns:
    width = draw(WIDTHS)
    chosen = draw(st.lists(st.integers(0, (1 << width) - 1), unique=True, max_size=20))
    return Patterns(codes_to_bits(np.array(chosen, dtype=np.int64), width))


@st.composite
def implied(draw: st.DrawFn) -> Implied:
    width = draw(WIDTHS)
    order = draw(st.permutations(range(width)))
    cuts = sorted(draw(st.lists(st.integers(0, width), max_size=3)))
    groups = [tuple(order[low:high]) for low, high in pairwise([0, *cuts]) if high > low]
    return Implied(width, tuple(groups))


care_sets: st.SearchStrategy[CareSet] = st.one_of(
    st.builds(Everything, WIDTHS), codes(), patterns(), implied()
)


@given(care_sets, st.data())
def test_a_projection_holds_what_the_allowed_words_show(care: CareSet, data: st.DataObject) -> None:
    words = codes_to_bits(np.arange(1 << care.width), care.width)
    allowed = words[care.allows(words)]
    positions = tuple(data.draw(st.lists(st.integers(0, care.width - 1), unique=True)))
    seen = np.zeros(1 << len(positions), dtype=np.bool_)
    seen[allowed[:, list(positions)] @ (1 << np.arange(len(positions)))] = True
    assert care.project(positions).tolist() == seen.tolist()


@given(care_sets)
def test_a_care_set_reads_back_from_json(care: CareSet) -> None:
    read = care_from_json(json.loads(json.dumps(care.to_json())))
    assert (type(read), read.width) == (type(care), care.width)
    words = codes_to_bits(np.arange(1 << care.width), care.width)
    assert read.allows(words).tolist() == care.allows(words).tolist()
    assert read.to_json() == care.to_json()


def test_patterns_may_be_wide() -> None:
    rows = np.random.default_rng(0).random((50, 227)) < 0.5
    read = care_from_json(Patterns(rows).to_json())
    assert read.allows(rows).all()
    assert not read.allows(~rows).any()
    assert read.project((226, 0)).all()


def test_a_thermometer_has_no_holes() -> None:
    care = Implied(4, ((0, 1, 2),))
    words = codes_to_bits([0b0000, 0b0001, 0b0111, 0b1011, 0b0010, 0b0101], 4)
    assert care.allows(words).tolist() == [True, True, True, True, False, False]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Codes(np.ones(3, dtype=np.bool_)), r"needs 2\*\*width bools"),
        (lambda: Codes(np.ones(4, dtype=np.int64)), r"needs 2\*\*width bools"),
        (lambda: Codes(np.ones(1 << 21, dtype=np.bool_)), "at most 20 bits, not 21"),
        (lambda: Patterns(np.ones(4, dtype=np.bool_)), "patterns are bools"),
        (lambda: Implied(3, ((0, 1), (1, 2))), "name a bit twice or one beyond it"),
        (lambda: Implied(3, ((2, 3),)), "name a bit twice or one beyond it"),
    ],
)
def test_what_is_no_care_set_is_refused(make: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    "data",
    [
        {"kind": "some", "width": 2},
        {"kind": "codes", "width": 21, "codes": []},
        {"kind": "codes", "width": 2, "codes": [4]},
        {"kind": "codes", "width": 2, "codes": [-1]},
        {"kind": "patterns", "width": 9, "patterns": ["01ff", "ff"]},
        {"kind": "patterns", "width": 8, "patterns": ["", "0102"]},
        {"kind": "implied", "width": 2, "falling": [[0, 2]]},
    ],
)
def test_a_damaged_care_set_is_refused(data: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"care set|does not fit|does not have|beyond it"):
        care_from_json(data)
