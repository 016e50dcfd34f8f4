"""What a match engine answers, and which engine is fast enough."""

import numpy as np
import pytest

from wnn2hdl.ir.engine import CELL, EngineFormat, agreement, picture_words


def test_scores_are_counts_of_equal_pixels() -> None:
    draw = np.random.default_rng(0)
    template, segment = draw.random((5, 7)) < 0.3, draw.random((11, 16)) < 0.3
    counted = [[int((segment[y : y + 5, x : x + 7] == template).sum()) for x in range(10)] for y in range(7)]
    assert np.array_equal(agreement(template, segment), counted)


def test_a_template_is_found_where_it_was_cut_out() -> None:
    engine = EngineFormat((20, 30), (120, 140), 4, 10)
    segment = np.random.default_rng(1).random(engine.segment) < 0.3
    answer = engine.answer(segment[70:90, 55:85], segment)
    assert (answer.best, answer.score) == ((70, 55), 600)
    assert answer.second is not None
    assert max(abs(answer.second[0] - 70), abs(answer.second[1] - 55)) > CELL
    scores = agreement(segment[70:90, 55:85], segment)
    assert answer.mean == pytest.approx(scores.mean())
    assert answer.std == pytest.approx(scores.std())


def test_the_first_of_equal_scores_wins_and_few_positions_have_no_second() -> None:
    engine = EngineFormat((2, 2), (4, 4), 1, 2)
    answer = engine.answer(np.zeros((2, 2), np.bool_), np.zeros((4, 4), np.bool_))
    assert (answer.best, answer.second) == ((0, 0), None)
    assert answer.words == (0, 4, 0, 1 << 31, 36, 0, 144, 0)


def test_segments_are_sent_row_by_row_from_the_lowest_bit() -> None:
    picture = np.zeros((3, 12), np.bool_)
    picture[0, 1] = picture[1, 0] = picture[2, 11] = True
    assert picture_words(picture).tolist() == [1 << 1 | 1 << 12, 1 << 3]


def test_the_engine_chosen_is_fast_enough_and_a_slower_one_is_smaller() -> None:
    fast, slow = (EngineFormat.fast_enough((22, 20), (60, 64), cycles) for cycles in (5000, 50000))
    assert fast.cycles(16) <= 5000
    assert slow.luts < fast.luts
    with pytest.raises(ValueError, match="at least"):
        EngineFormat.fast_enough((22, 20), (60, 64), 1000)


@pytest.mark.parametrize(
    ("template", "segment", "fault"),
    [
        ((4, 4), (4, 9), "4x4 does not move in a segment of 4x9"),
        ((9, 9), (4, 4), "9x9 does not move in a segment of 4x4"),
        ((1, 4), (9, 9), "at least 2x2 pixels, not 1x4"),
        ((4, 4), (9, 4096), "at most 2048x2048 pixels, not 9x4096"),
    ],
)
def test_sizes_that_leave_nothing_to_search_are_refused(
    template: tuple[int, int], segment: tuple[int, int], fault: str
) -> None:
    with pytest.raises(ValueError, match=fault):
        EngineFormat.fast_enough(template, segment, 10**9)


def test_an_engine_goes_through_json() -> None:
    engine = EngineFormat((4, 6), (9, 12), 4, 3)
    assert EngineFormat.from_json({**engine.to_json(), "template": [4, 6]}) == engine
    with pytest.raises(ValueError, match="lanes"):
        EngineFormat.from_json({**engine.to_json(), "lanes": 7})
    with pytest.raises(ValueError, match="columns"):
        EngineFormat.from_json({**engine.to_json(), "columns": 4})
