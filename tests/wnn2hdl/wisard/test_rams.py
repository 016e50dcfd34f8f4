import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.encode import high_bits
from wnn2hdl.ir import WisardModel
from wnn2hdl.wisard.rams import addresses, chunks, count, responses, winners

WIDTH = 6


@st.composite
def cases(draw: st.DrawFn) -> tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.int64]]:
    """Patterns, a mapping (shared or one per class) and counts."""
    classes, rams, address_bits = draw(st.integers(2, 4)), draw(st.integers(1, 5)), draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    mapping = rng.integers(0, WIDTH, (draw(st.sampled_from([1, classes])), rams, address_bits))
    counts = rng.integers(0, 6, (classes, rams, 1 << address_bits))
    return rng.random((draw(st.integers(1, 9)), WIDTH)) < 0.5, mapping, counts


def test_entry_0_of_a_mapping_is_the_least_significant_address_bit() -> None:
    bits = np.array([[True, False, True], [False, False, True]])
    assert addresses(bits, np.array([[[0, 1], [2, 0]]])).tolist() == [[[1, 0], [3, 1]]]


def test_a_count_is_made_for_each_occurrence() -> None:
    where = np.array([[0, 3, 3], [1, 1, 0]])
    assert count(where, 2).tolist() == [[1, 0, 0, 2], [1, 2, 0, 0]]
    assert count(where, 2, np.array([5, 1, 2])).tolist() == [[5, 0, 0, 3], [2, 6, 0, 0]]


def test_weighted_sums_are_exact_up_to_2_to_53() -> None:
    large = 2**53 - 3
    assert count(np.array([[1, 1]]), 1, np.array([large, 1])).tolist() == [[0, large + 1]]


@given(cases(), st.integers(1, 6))
def test_responses_are_those_of_the_model(
    case: tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.int64]], bleaching: int
) -> None:
    bits, mapping, counts = case
    model = WisardModel(high_bits(2), tuple("abcd"[: len(counts)]), mapping, counts, bleaching)
    assert np.array_equal(responses(counts >= bleaching, addresses(bits, mapping)), model.responses(bits))


@given(cases(), st.lists(st.integers(1, 8), min_size=1, max_size=6).map(sorted))
def test_winners_under_each_threshold_are_those_of_the_model(
    case: tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.int64]], thresholds: list[int]
) -> None:
    bits, mapping, counts = case
    found = winners(counts, addresses(bits, mapping), np.array(thresholds))
    for row, bleaching in zip(found, thresholds, strict=True):
        model = WisardModel(high_bits(2), tuple("abcd"[: len(counts)]), mapping, counts, bleaching)
        assert np.array_equal(row, model.evaluate(bits))


@given(cases(), st.integers(1, 5))
def test_a_pattern_left_out_counts_once_less_for_its_class(
    case: tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.int64]], bleaching: int
) -> None:
    bits, mapping, counts = case
    less = counts.copy()
    less[1] -= 1
    where = addresses(bits, mapping)
    thresholds = np.array([bleaching])
    assert np.array_equal(winners(counts, where, thresholds, left_out=1), winners(less, where, thresholds))


@pytest.mark.parametrize(("patterns", "entries"), [(0, 3), (1, 1), (10, 1 << 21), (7, 1 << 30)])
def test_chunks_cover_everything_once(patterns: int, entries: int) -> None:
    covered = [i for part in chunks(patterns, entries) for i in range(patterns)[part]]
    assert covered == list(range(patterns))
