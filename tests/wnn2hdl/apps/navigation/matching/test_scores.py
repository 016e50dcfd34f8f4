"""The scores, from sums taken by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.matching.scores import Sums, check_score, evaluate
from wnn2hdl.errors import InputError


def sums(of_map: list[bool], of_template: list[bool]) -> Sums:
    """Those of a single position all of whose pixels are common."""
    f, w = np.array(of_map, dtype=np.float64), np.array(of_template, dtype=np.float64)
    totals = (len(f), f.sum(), (f * f).sum(), w.sum(), (w * w).sum(), (f * w).sum())
    return Sums(*(np.asarray(total, dtype=np.float64) for total in totals))


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=40))
def test_scores_are_their_definitions(pixels: list[tuple[bool, bool]]) -> None:
    of_map, of_template = ([pair[side] for pair in pixels] for side in (0, 1))
    given_sums = sums(of_map, of_template)
    assert evaluate("correlation", given_sums) == sum(a and b for a, b in pixels)
    assert evaluate("match_count", given_sums) == pytest.approx(sum(a == b for a, b in pixels) / len(pixels))
    constant = len(set(of_map)) == 1 or len(set(of_template)) == 1
    expected = 0 if constant else np.corrcoef(of_map, of_template)[0, 1]
    assert evaluate("ncc", given_sums) == pytest.approx(expected, abs=1e-9)


def test_nothing_in_common_scores_nothing() -> None:
    nothing = Sums(*(np.zeros(1) for _ in range(6)))
    for score in ("correlation", "ncc", "match_count"):
        assert evaluate(score, nothing) == 0


def test_the_match_count_wants_bits() -> None:
    check_score("match_count", np.zeros((2, 2), dtype=np.bool_))
    check_score("ncc", np.zeros((2, 2), dtype=np.uint8))
    with pytest.raises(InputError, match="compares bits, not grey levels: uint8"):
        check_score("match_count", np.zeros((2, 2), dtype=np.uint8))
