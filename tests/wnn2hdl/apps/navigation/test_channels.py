"""Matching of several binary images at once: against the map index of one picture, and by brute force."""

import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.channels import ChannelIndex
from wnn2hdl.apps.navigation.matching import MapIndex, Score, Window
from wnn2hdl.apps.navigation.matching.scores import Sums, evaluate
from wnn2hdl.errors import InputError

SCORES: tuple[Score, ...] = ("ncc", "match_count", "correlation")


@pytest.mark.parametrize("score", SCORES)
@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32))
def test_one_channel_gives_the_match_of_the_map_index(score: Score, seed: int) -> None:
    rng = np.random.default_rng(seed)
    ground, valid = rng.random((40, 50)) < 0.3, rng.random((40, 50)) < 0.9
    template, mask = rng.random((9, 13)) < 0.3, rng.random((9, 13)) < 0.8
    window = Window(*rng.integers(-15, 20, 2), *rng.integers(21, 60, 2))
    found = ChannelIndex(ground[np.newaxis], valid).search(template[np.newaxis], mask, score, window)
    expected = MapIndex(ground, valid).search(template, mask, score, window)
    assert (found is None) == (expected is None)
    if found is not None and expected is not None:
        assert found.peaks == expected.peaks


@pytest.mark.parametrize("score", SCORES)
def test_channels_count_together_in_one_score(score: Score) -> None:
    rng = np.random.default_rng(3)
    ground, valid = rng.random((4, 24, 30)) < 0.3, rng.random((24, 30)) < 0.95
    template, mask = rng.random((4, 7, 6)) < 0.4, rng.random((7, 6)) < 0.8
    window = Window(0, 0, 24 - 7 + 1, 30 - 6 + 1)
    best = (-np.inf, 0, 0)
    for row, column in np.ndindex(*window.shape):
        part = np.s_[row : row + 7, column : column + 6]
        common = valid[part] & mask
        if common.sum() < 0.75 * mask.sum():
            continue
        f = ground[(slice(None), *part)][:, common].astype(float)
        w = template[:, common].astype(float)
        totals = (f.size, f.sum(), f.sum(), w.sum(), w.sum(), (f * w).sum())
        value = float(evaluate(score, Sums(*(np.array([total], float) for total in totals)))[0])
        if value > best[0]:
            best = value, row, column
    match = ChannelIndex(ground, valid).search(template, mask, score, window)
    assert match is not None
    assert (match.score, match.row, match.col) == best


def test_a_piece_of_the_map_is_found_where_it_was_cut_also_with_spectra_kept() -> None:
    rng = np.random.default_rng(4)
    ground, valid = rng.random((3, 90, 120)) < 0.2, np.ones((90, 120), dtype=np.bool_)
    index = ChannelIndex(ground, valid)
    for row, column, height, width in ((0, 0, 20, 20), (50, 70, 25, 31), (70, 100, 20, 20), (10, 5, 70, 40)):
        piece = ground[:, row : row + height, column : column + width]
        match = index.search(piece, np.ones((height, width), dtype=np.bool_))
        assert match is not None
        assert (match.row, match.col) == (row, column)
        assert match.score == pytest.approx(1)


def test_windows_of_one_size_do_not_share_spectra() -> None:
    rng = np.random.default_rng(6)
    ground, valid = rng.random((2, 80, 80)) < 0.3, np.ones((80, 80), dtype=np.bool_)
    index = ChannelIndex(ground, valid)
    for row, column in ((10, 10), (50, 40), (10, 10)):
        piece = ground[:, row : row + 20, column : column + 20]
        window = Window.around(row + 2, column - 3, 5)
        match = index.search(piece, np.ones((20, 20), dtype=np.bool_), window=window)
        assert match is not None
        assert (match.row, match.col) == (row, column)


def test_threads_may_search_at_once() -> None:
    rng = np.random.default_rng(6)
    ground = rng.random((2, 60, 60)) < 0.3
    index = ChannelIndex(ground, np.ones((60, 60), dtype=np.bool_))
    places = rng.integers(0, 50, (200, 2)).tolist()

    def search(place: list[int]) -> list[int]:
        row, column = place
        cut = np.ascontiguousarray(ground[:, row : row + 9, column : column + 9])
        window = Window(row - 3, column - 3, row + 4, column + 4)
        match = index.search(cut, np.ones(cut.shape[1:], dtype=np.bool_), "ncc", window)
        assert match is not None
        return [match.row, match.col]

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as pool:
            assert list(pool.map(search, places)) == places
    finally:
        sys.setswitchinterval(interval)


def test_a_template_may_reach_beyond_the_map_as_far_as_the_overlap_allows() -> None:
    rng = np.random.default_rng(5)
    scene = rng.random((2, 60, 60)) < 0.3
    index = ChannelIndex(scene[:, 10:, 10:], np.ones((50, 50), dtype=np.bool_))
    template, mask = scene[:, 5:35, 5:35], np.ones((30, 30), dtype=np.bool_)
    match = index.search(template, mask, min_overlap=0.6)
    assert match is not None
    assert (match.row, match.col) == (-5, -5)
    narrow = Window(-5, -5, -4, -4)
    assert index.search(template, mask, window=narrow, min_overlap=0.8) is None


@pytest.mark.parametrize(
    ("channels", "inside"),
    [
        (np.zeros((4, 5), bool), np.ones((4, 5), bool)),
        (np.zeros((2, 4, 5), np.uint8), np.ones((4, 5), bool)),
        (np.zeros((2, 4, 5), bool), np.ones((5, 4), bool)),
        (np.zeros((0, 4, 5), bool), np.ones((4, 5), bool)),
    ],
)
def test_what_is_no_stack_of_binary_images_is_refused(channels: np.ndarray, inside: np.ndarray) -> None:
    with pytest.raises(InputError, match="not binary images"):
        ChannelIndex(channels, inside)


def test_template_and_map_must_have_the_same_channels() -> None:
    index = ChannelIndex(np.zeros((3, 9, 9), dtype=np.bool_), np.ones((9, 9), dtype=np.bool_))
    with pytest.raises(InputError, match="different channels"):
        index.search(np.zeros((2, 4, 4), dtype=np.bool_), np.ones((4, 4), dtype=np.bool_))
