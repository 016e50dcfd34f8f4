"""Peaks: apart from one another, ordered, with ties to the top left."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.matching.peaks import Cells, Match, Peak, Window, find_peaks, keep_apart


def test_peaks_lie_apart_and_ties_go_to_the_top_left() -> None:
    scores = np.zeros((30, 40))
    scores[5, 6] = scores[20, 30] = 1.0
    scores[5, 8] = 0.9
    match = find_peaks(scores, Window(100, 200, 130, 240), exclusion=3)
    assert match is not None
    assert match.peaks[:2] == (Peak(105, 206, 1.0), Peak(120, 230, 1.0))
    assert match.peaks[2].score == 0
    assert match.margin == 0
    assert match.mean == pytest.approx(2.9 / 1200)


def test_a_window_without_allowed_positions_has_no_peak() -> None:
    assert find_peaks(np.full((3, 3), -np.inf), Window(0, 0, 3, 3), 1) is None


def test_of_peaks_too_near_the_best_is_kept() -> None:
    peaks = [Peak(0, 0, 0.5), Peak(3, 3, 0.7), Peak(50, 0, 0.4)]
    assert keep_apart(peaks, 10) == (Peak(3, 3, 0.7), Peak(50, 0, 0.4))


def test_cells_gather_the_same_as_the_whole() -> None:
    rng = np.random.default_rng(0)
    scores = rng.normal(size=(64, 96)).astype(np.float32)
    scores[3, :20] = -np.inf
    cells = Cells(4, 8)
    for left in range(0, 96, 32):
        cells.add(scores[:, left : left + 32], 10, 20 + left)
    known = scores[scores > -np.inf].astype(np.float64)
    assert cells.mean == pytest.approx(known.mean(), abs=1e-6)
    assert cells.std == pytest.approx(known.std(), rel=1e-5)
    maxima = scores.reshape(8, 8, 12, 8).max(axis=(1, 3))
    assert [-cell.loss for cell in cells.best] == sorted(maxima.ravel(), reverse=True)[:4]
    best = np.unravel_index(maxima.argmax(), maxima.shape)
    assert (cells.best[0].row, cells.best[0].col) == (10 + 8 * best[0], 20 + 8 * best[1])


def test_confidence_grows_with_height_and_with_lead() -> None:
    lonely = Match((Peak(0, 0, 0.6), Peak(50, 50, 0.2)), 0.0, 0.1)
    rivalled = Match((Peak(0, 0, 0.6), Peak(50, 50, 0.5)), 0.0, 0.1)
    low = Match((Peak(0, 0, 0.3), Peak(50, 50, 0.2)), 0.0, 0.1)
    assert lonely.confidence > rivalled.confidence > low.confidence
    assert lonely.psr == pytest.approx(6)
    assert lonely.margin == pytest.approx(4)


def test_a_flat_surface_gives_no_confidence() -> None:
    assert Match((Peak(0, 0, 0.0), Peak(9, 9, 0.0)), 0.0, 0.0).confidence == 0


def test_a_window_around_a_position_holds_it_in_the_middle() -> None:
    window = Window.around(10.2, 20.0, 3)
    assert window == Window(7, 17, 14, 24)
    assert window.shape == (7, 7)
    assert window.clip(Window(12, 0, 13, 99)).positions == 7
