"""Searches by segments answer with what a match engine answers in each."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching import MapIndex, SegmentIndex, Window
from wnn2hdl.ir.engine import EngineFormat

Bits = NDArray[np.bool_]

ENGINE = EngineFormat((8, 10), (50, 70), lanes=1, columns=10)


def bits(seed: int, shape: tuple[int, int]) -> Bits:
    return np.random.default_rng(seed).random(shape) < 0.5


MAP = bits(0, (120, 150))
EVERYWHERE = np.ones(MAP.shape, dtype=np.bool_)
WHOLE = np.ones(ENGINE.template, dtype=np.bool_)


def index(valid: Bits = EVERYWHERE) -> SegmentIndex:
    return SegmentIndex(MAP, valid, engine=ENGINE)


def test_one_segment_gives_the_engine_s_own_answer() -> None:
    engine = EngineFormat(ENGINE.template, (110, 120), lanes=1, columns=10)
    template = bits(1, engine.template)
    window = Window(5, 20, 5 + engine.positions[0], 20 + engine.positions[1])
    answer = engine.answer(template, MAP[5:115, 20:140])
    match = SegmentIndex(MAP, EVERYWHERE, engine=engine).search(template, WHOLE, window=window)
    assert match is not None
    assert answer.second is not None
    best, second = match.peaks
    assert (best.row - 5, best.col - 20, best.score) == (*answer.best, answer.score)
    assert (second.row - 5, second.col - 20, second.score) == (*answer.second, answer.second_score)
    assert match.mean == pytest.approx(answer.mean)
    assert match.std == pytest.approx(answer.std)


@settings(max_examples=30, deadline=None)
@given(
    seed=st.integers(1, 2**32),
    top=st.integers(0, 60),
    left=st.integers(0, 60),
    rows=st.integers(43, 112),
    columns=st.integers(61, 140),
)
def test_many_segments_find_the_best_of_the_window(
    seed: int, top: int, left: int, rows: int, columns: int
) -> None:
    """The exact search for the share of agreeing pixels is the rival, which knows nothing of segments."""
    window = Window(top, left, min(top + rows, 113), min(left + columns, 141))
    template = bits(seed, ENGINE.template)
    segments = list(index().segments(window))
    covered = np.zeros(MAP.shape, dtype=np.bool_)
    for segment in segments:
        rows_, columns_ = ENGINE.positions
        covered[max(segment.top, 0) : segment.top + rows_, max(segment.left, 0) : segment.left + columns_] = (
            True
        )
    assert covered[window.top : window.bottom, window.left : window.right].all()
    found = index().search(template, WHOLE, window=window)
    best = MapIndex(MAP, EVERYWHERE).search(template, WHOLE, "match_count", window)
    assert best is not None
    alone = len(segments) == 1 and window.shape != ENGINE.positions
    if found is None or alone:
        # A single segment may have more positions than the window, and its best one beside it.
        assert alone
        return
    assert (found.row, found.col, found.score) == (best.row, best.col, best.score * 80)


def test_a_template_is_cut_out_of_the_middle_of_what_a_frame_shows() -> None:
    mask = np.zeros((40, 60), dtype=np.bool_)
    mask[5:23, 10:50] = True
    assert index().piece(mask) == (15, 25)
    frame = MAP[30:70, 40:100]
    match = index().search(frame, mask)
    assert match is not None
    assert (match.row, match.col, match.score) == (30, 40, 80)


def test_a_frame_smaller_than_the_template_lies_in_its_middle() -> None:
    assert index().piece(np.ones((6, 10), dtype=np.bool_)) == (-1, 0)
    assert index().search(MAP[30:34, 40:50], np.ones((4, 10), dtype=np.bool_)) is None
    match = index().search(MAP[30:37, 40:50], np.ones((7, 10), dtype=np.bool_))
    assert match is not None
    assert (match.row, match.col) == (30, 40)


def test_answers_off_the_map_or_the_window_do_not_count() -> None:
    template = MAP[30:38, 40:50]
    valid = EVERYWHERE.copy()
    valid[30:38, 44:48] = False
    found = index(valid).search(template, WHOLE)
    assert found is None or (found.row, found.col) != (30, 40)
    away = Window(31, 41, 45, 60)
    found = index().search(template, WHOLE, window=away)
    assert found is None or all(peak.row >= 31 and peak.col >= 41 for peak in found.peaks)
    assert index().search(template, WHOLE, window=Window(500, 500, 510, 510)) is None
