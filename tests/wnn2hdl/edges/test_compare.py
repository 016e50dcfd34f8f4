"""Agreement within one pixel."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.edges import Agreement, agreement, boundary, filter_agreement
from wnn2hdl.ir import window_codes

SHAPES = st.tuples(st.integers(1, 7), st.integers(1, 7))


def line(column: int) -> NDArray[np.bool_]:
    edges = np.zeros((5, 9), dtype=np.bool_)
    edges[:, column] = True
    return edges


@pytest.mark.parametrize(("distance", "score"), [(0, 1.0), (1, 1.0), (2, 0.0)])
def test_one_pixel_is_near_and_two_are_not(distance: int, score: float) -> None:
    result = agreement(line(4), line(4 + distance))
    assert (result.precision, result.recall, result.f1) == (score, score, score)


def test_diagonal_neighbours_are_near() -> None:
    one, other = np.zeros((2, 2), dtype=np.bool_), np.zeros((2, 2), dtype=np.bool_)
    one[0, 0] = other[1, 1] = True
    assert agreement(one, other).f1 == 1


def test_precision_and_recall_count_different_pixels() -> None:
    result = agreement(line(2) | line(6), line(2))
    assert (result.precision, result.recall) == (0.5, 1.0)
    assert result.f1 == pytest.approx(2 / 3)


def test_a_score_without_pixels_is_missing_not_zero() -> None:
    nothing = np.zeros((5, 9), dtype=np.bool_)
    assert agreement(nothing, line(2)).precision is None
    assert agreement(line(2), nothing).recall is None
    assert agreement(nothing, line(2)).f1 is None


@given(edges=arrays(np.bool_, SHAPES), seed=st.integers(0, 99))
def test_counts_match_a_search_pixel_by_pixel(edges: NDArray[np.bool_], seed: int) -> None:
    reference = np.random.default_rng(seed).random(edges.shape) < 0.2
    near = sum(
        any(max(abs(y - v), abs(x - u)) <= 1 for v, u in zip(*np.nonzero(reference), strict=True))
        for y, x in zip(*np.nonzero(edges), strict=True)
    )
    result = agreement(edges, reference)
    assert (result.found, result.found_near) == (edges.sum(), near)
    assert agreement(reference, edges) == Agreement(
        result.expected, result.expected_near, result.found, result.found_near
    )


def test_pictures_are_pooled_by_pixel() -> None:
    rng = np.random.default_rng(0)
    pictures = [
        (rng.random(shape) < 0.5, rng.random((shape[0] - 2, shape[1] - 2)) < 0.1)
        for shape in ((9, 9), (20, 30))
    ]
    parts = [agreement(boundary().evaluate(window_codes(binary)), edges) for binary, edges in pictures]
    assert filter_agreement(boundary(), pictures) == parts[0] + parts[1]
