"""Bases of exclusive ors: they span what was given, with as few bits as there can be."""

from functools import reduce
from itertools import combinations
from operator import xor

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.ir.linear import basis, combination

MASKS = st.lists(st.integers(0, 255), max_size=6)


def span(masks: list[int] | tuple[int, ...]) -> set[int]:
    sums = {0}
    for mask in masks:
        sums |= {mask ^ other for other in sums}
    return sums


@given(MASKS)
def test_a_basis_spans_the_same_and_has_no_mask_too_many(masks: list[int]) -> None:
    found = basis(masks)
    assert span(found) == span(masks)
    assert len(span(found)) == 1 << len(found)


@given(st.lists(st.integers(0, 31), max_size=4))
@settings(max_examples=30)
def test_no_basis_has_fewer_bits(masks: list[int]) -> None:
    found = basis(masks)
    others = [
        sum(mask.bit_count() for mask in other)
        for other in combinations(span(masks), len(found))
        if len(span(other)) == 1 << len(found)
    ]
    assert sum(mask.bit_count() for mask in found) == min(others)


@given(MASKS)
def test_the_order_of_the_masks_does_not_matter(masks: list[int]) -> None:
    assert basis(masks) == basis(masks[::-1])


@given(MASKS, st.integers(0, 255))
def test_a_combination_is_the_mask_or_there_is_none(masks: list[int], mask: int) -> None:
    found = basis(masks)
    if mask in span(masks):
        chosen = combination(mask, found)
        assert reduce(xor, [each for i, each in enumerate(found) if chosen >> i & 1], 0) == mask
    else:
        with pytest.raises(ValueError, match="no exclusive or of the masks given"):
            combination(mask, found)


def test_a_high_rank_is_not_enumerated() -> None:
    masks = [1 << place | 1 << place + 1 for place in range(20)]
    assert basis(masks) == tuple(masks)
