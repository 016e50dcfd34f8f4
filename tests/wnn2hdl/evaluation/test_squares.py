"""Squares of random shares of their pixels: how many are counted, who wins; windows change nothing."""

from bisect import bisect_left

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.evaluation.squares import vote


def drawn(shape: tuple[int, int], valid: NDArray[np.bool_] | None, **options: float) -> NDArray[np.bool_]:
    """Which pixels are counted where a square counts one: its class is the square's."""
    found = np.zeros(shape, dtype=np.bool_)
    for place in np.ndindex(shape):
        classes = np.zeros(shape, dtype=np.uint8)
        classes[place] = 1
        found[place] = vote(classes, valid, count=2, **options).any()  # type: ignore[arg-type]
    return found


@pytest.mark.parametrize("seed", range(5))
def test_a_small_share_counts_one_pixel_of_each_square(seed: int) -> None:
    counted = drawn((7, 10), None, side=4, share=0.01, seed=seed)
    for square in (counted[:4, :4], counted[:4, 4:8], counted[:4, 8:], counted[4:, :4], counted[4:, 8:]):
        assert square.sum() == 1


def test_pixels_are_drawn_evenly() -> None:
    # 4,000 squares of nine pixels that count one each.
    classes = np.zeros((3, 12_000), dtype=np.uint8)
    shares = []
    for place in range(9):
        classes[:] = 0
        classes[place // 3, place % 3 :: 3] = 1
        shares.append(float(vote(classes, None, side=3, share=0.1, seed=3, count=2)[0, ::3].mean()))
    assert sum(shares) == pytest.approx(1)
    # Each share has a standard deviation of 0.005.
    assert max(abs(share - 1 / 9) for share in shares) < 0.02


@pytest.mark.parametrize(("share", "voters"), [(0.5, 36), (0.5, 15), (0.1, 36), (0.9, 20), (0.05, 7)])
def test_exactly_the_rounded_share_is_counted(share: float, voters: int) -> None:
    valid = (np.arange(36) < voters).reshape(6, 6)
    counted = set()
    rng = np.random.default_rng(0)
    for _ in range(150):
        # Pixels turn to class 1 in a random order; the one that turns the square over is counted, and every
        # counted pixel is that one in some order.
        order = rng.permutation(voters)

        def turned(pixels: int, order: NDArray[np.int64] = order) -> bool:
            classes = np.zeros(36, dtype=np.uint8)
            classes[order[:pixels]] = 1
            square = classes.reshape(6, 6)
            return bool(vote(square, valid, side=6, share=share, seed=0, count=2).any())

        counted.add(int(order[bisect_left(range(voters + 1), True, key=turned) - 1]))
    assert len(counted) == max(round(share * voters), 1)


def test_the_share_decides_how_many_votes_a_class_needs() -> None:
    classes = np.zeros((20, 20), dtype=np.uint8)
    classes.flat[:199] = 1
    assert not vote(classes, None, side=20, share=1, seed=0, count=2).any()
    classes.flat[:200] = 1
    assert not vote(classes, None, side=20, share=1, seed=0, count=2).any(), "a draw goes to the background"
    classes.flat[:201] = 1
    assert vote(classes, None, side=20, share=1, seed=0, count=2).all()


def test_of_several_classes_the_most_frequent_wins() -> None:
    classes = np.array([[2, 2, 0, 3], [1, 2, 3, 3]], dtype=np.uint8)
    assert vote(classes, None, side=2, share=1, seed=0, count=4).tolist() == [[2, 2, 3, 3], [2, 2, 3, 3]]


def test_invalid_pixels_have_no_vote() -> None:
    classes = np.array([[1, 1, 0], [1, 0, 0], [1, 1, 1]], dtype=np.uint8)
    valid = classes == 0
    assert not vote(classes, valid, side=3, share=0.5, seed=0, count=2).any()
    assert not vote(np.ones_like(classes), np.zeros_like(valid), side=3, share=0.5, seed=0, count=2).any()


def test_borders_have_squares_of_what_is_there() -> None:
    classes = np.zeros((5, 5), dtype=np.uint8)
    classes[4, :] = classes[:, 4] = 1
    expected = [[0, 0, 0, 0, 1]] * 4 + [[1] * 5]
    assert vote(classes, None, side=4, share=1, seed=0, count=2).tolist() == expected


@settings(deadline=None)
@given(
    classes=arrays(np.uint8, st.tuples(st.integers(1, 40), st.integers(1, 40)), elements=st.integers(0, 2)),
    side=st.integers(1, 9),
    share=st.floats(0.01, 1),
    seed=st.integers(0, 2**65),
    cuts=st.tuples(st.integers(1, 4), st.integers(1, 4)),
    masked=st.booleans(),
)
def test_how_the_picture_is_cut_into_windows_changes_nothing(
    classes: NDArray[np.uint8],
    side: int,
    share: float,
    seed: int,
    cuts: tuple[int, int],
    masked: bool,
) -> None:
    valid = np.random.default_rng(0).random(classes.shape) < 0.7 if masked else None
    whole = vote(classes, valid, side=side, share=share, seed=seed, count=3)
    down, right = (side * cut for cut in cuts)
    for top in range(0, classes.shape[0], down):
        for left in range(0, classes.shape[1], right):
            window = np.s_[top : top + down, left : left + right]
            part = vote(
                classes[window],
                None if valid is None else valid[window],
                side=side,
                share=share,
                seed=seed,
                count=3,
                row=top,
                column=left,
            )
            assert np.array_equal(part, whole[window])


def test_seeds_draw_different_pixels() -> None:
    classes = np.random.default_rng(1).integers(0, 2, (200, 200), dtype=np.uint8)
    votes = [vote(classes, None, side=10, share=0.3, seed=seed, count=2) for seed in (0, 1, 0)]
    assert (votes[0] != votes[1]).any()
    assert np.array_equal(votes[0], votes[2])


def test_a_window_that_cuts_squares_is_refused() -> None:
    with pytest.raises(ValueError, match="cuts squares of 4"):
        vote(np.zeros((4, 4), np.uint8), None, side=4, share=1, seed=0, count=2, row=2)
