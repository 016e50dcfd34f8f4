"""Which constants a binary search compares with."""

from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.lower.search import shape


@given(st.sets(st.integers(1, 255), min_size=1, max_size=15), st.integers(0, 4))
def test_a_search_ends_between_two_neighbouring_thresholds(found: set[int], round_levels: int) -> None:
    levels = tuple(sorted(found))
    depth = len(levels).bit_length()
    of = shape(8, levels, depth, round_levels)
    if of is None:
        assert round_levels
        return
    assert len(of.leaves) == 1 << depth
    for low, high in of.leaves:
        assert not any(low < level < high for level in levels)


def test_first_levels_compare_with_round_numbers() -> None:
    of = shape(8, (0x33, 0x5D, 0xA7), 3, 1)
    assert of is not None
    assert of.constants[0] == (0x80,)


def test_there_is_no_search_of_too_few_or_too_many_levels() -> None:
    assert shape(8, (3, 5), 1, 0) is None
    assert shape(8, (3,), 2, 0) is None
