"""Covers lie between their bounds and waste no term."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Cover, Cube, Term, irredundant_cover, pack_contents


def table_of(terms: tuple[Term, ...], width: int) -> int:
    return sum(any(a & mask == value for mask, value in terms) << a for a in range(1 << width))


@given(st.integers(0, 6), st.data())
def test_a_cover_lies_between_its_bounds_and_has_no_superfluous_term(width: int, data: st.DataObject) -> None:
    everything = (1 << (1 << width)) - 1
    lower = data.draw(st.integers(0, everything))
    upper = lower | data.draw(st.integers(0, everything))
    terms = irredundant_cover(lower, upper, width)
    covered = table_of(terms, width)
    assert covered & lower == lower
    assert covered | upper == upper
    for i in range(len(terms)):
        rest = table_of((*terms[:i], *terms[i + 1 :]), width)
        assert rest & lower != lower


def test_a_table_of_twenty_inputs_is_covered_too() -> None:
    codes = np.arange(1 << 20)
    values = (codes >> 15 == 21) | (codes & 31 == 7)
    contents = pack_contents(values)
    assert sorted(irredundant_cover(contents, contents, 20)) == [(31, 7), (31 << 15, 21 << 15)]


def test_a_cube_feeds_the_outputs_of_its_mask() -> None:
    cover = Cover(("a", "b"), ("y", "z"), (Cube(0b11, 0b01, 0b10), Cube(0b10, 0b10, 0b11)))
    assert cover.literals == 3
    assert cover.evaluate(range(4)).tolist() == [[False, False], [False, True], [True, True], [True, True]]
