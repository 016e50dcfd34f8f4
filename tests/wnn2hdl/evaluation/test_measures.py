"""Figures of merit against scikit-learn's, and the bootstrap against what it must do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from sklearn import metrics

from wnn2hdl.evaluation.measures import (
    Measure,
    accuracy,
    class_scores,
    defined,
    interval,
    ious,
    kappa,
    mean_iou,
    wilson,
)

full = arrays(np.int64, st.integers(2, 4).map(lambda n: (n, n)), elements=st.integers(1, 50))


def pixels(confusion: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """True classes, answers and weights that make the confusion matrix."""
    truth, answers = np.indices(confusion.shape).reshape(2, -1)
    return truth, answers, confusion.ravel()


@given(full)
def test_scores_are_those_of_scikit_learn(confusion: NDArray[np.int64]) -> None:
    truth, answers, weights = pixels(confusion)
    assert accuracy(confusion) == pytest.approx(metrics.accuracy_score(truth, answers, sample_weight=weights))
    expected = metrics.cohen_kappa_score(truth, answers, sample_weight=weights)
    assert kappa(confusion) == pytest.approx(expected, abs=1e-12)
    iou = metrics.jaccard_score(truth, answers, average=None, sample_weight=weights)
    assert ious(confusion) == pytest.approx(iou)
    assert mean_iou(confusion) == pytest.approx(iou.mean())
    precision, recall, f1, _ = metrics.precision_recall_fscore_support(truth, answers, sample_weight=weights)
    found = class_scores(confusion)
    assert [s.precision for s in found] == pytest.approx(precision)
    assert [s.recall for s in found] == pytest.approx(recall)
    assert [s.f1 for s in found] == pytest.approx(f1)


def test_what_is_undefined_is_none_and_not_zero() -> None:
    # The third class is neither in the labels nor in the answers; the second is never answered.
    absent, missed = class_scores(np.array([[5, 0, 0], [2, 0, 0], [0, 0, 0]]))[:0:-1]
    assert (absent.precision, absent.recall, absent.f1, absent.iou) == (None, None, None, None)
    assert (missed.precision, missed.recall, missed.f1, missed.iou) == (None, 0.0, 0.0, 0.0)
    assert defined(kappa(np.array([[7, 0], [0, 0]]))) is None
    assert defined(accuracy(np.zeros((2, 2), np.int64))) is None


def test_classes_that_do_not_occur_do_not_count_in_the_mean() -> None:
    assert mean_iou(np.array([[3, 1, 0], [0, 4, 0], [0, 0, 0]])) == pytest.approx((3 / 4 + 4 / 5) / 2)


@given(full)
def test_stacks_of_matrices_are_measured_one_by_one(confusion: NDArray[np.int64]) -> None:
    stack = np.stack([confusion, confusion.T])
    for measure in (accuracy, kappa, mean_iou):
        assert measure(stack).tolist() == [measure(confusion), measure(confusion.T)]


def of_accuracies(shares: list[float]) -> NDArray[np.int64]:
    return np.array([[[round(100 * share), 100 - round(100 * share)], [0, 0]] for share in shares])


@pytest.mark.parametrize("measure", [accuracy, kappa, mean_iou])
def test_an_interval_holds_the_figure_and_depends_on_the_seed_alone(measure: Measure) -> None:
    confusions = np.random.default_rng(5).integers(1, 100, (12, 2, 2))
    found = interval(confusions, measure, seed=3)
    assert found is not None
    assert found[0] < measure(confusions.sum(axis=0)) < found[1]
    assert found == interval(confusions, measure, seed=3) != interval(confusions, measure, seed=4)


def test_whole_images_are_drawn_again() -> None:
    assert interval(of_accuracies([0.9] * 10), accuracy, 0) == (0.9, 0.9)
    # Of two images, one resample in four has the better one twice, and one in four the worse.
    assert interval(of_accuracies([0.6, 0.8]), accuracy, 0) == (0.6, 0.8)


def test_one_image_has_no_interval() -> None:
    assert interval(of_accuracies([0.9]), accuracy, 0) is None


def test_an_interval_is_none_where_a_resample_has_no_figure() -> None:
    # Kappa is undefined for an image of one class that is all right.
    confusions = np.array([[[9, 0], [0, 0]], [[4, 1], [1, 4]]])
    assert interval(confusions, kappa, 0) is None


def test_wilsons_interval_is_that_of_the_textbook() -> None:
    # 10 of 20 right: centre 0.5, half-width z * sqrt(z²/4n² + p(1-p)/n) / (1 + z²/n).
    assert wilson(np.array([[4, 5], [5, 6]])) == pytest.approx((0.2993, 0.7007), abs=1e-4)
    assert wilson(np.array([[3, 0], [0, 0]])) == pytest.approx((0.4385, 1.0), abs=1e-4)
