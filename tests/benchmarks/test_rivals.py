"""Rivals are trained and asked as the table says."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from benchmarks.rivals import (
    BOXES,
    ColourClassifier,
    ContextClassifier,
    Threshold,
    box_means,
    excess_green,
    levels,
    linear,
    normalised_difference,
    of_colours,
    of_context,
    of_varied_colours,
    ratios,
)
from benchmarks.surveillance import by_squares, in_light
from wnn2hdl.dataset import from_samples
from wnn2hdl.evaluation.accuracy import evaluate, with_halo
from wnn2hdl.evaluation.classifiers import PictureClassifier

DATASET = from_samples(5, 40, seed=2)


def silent(step: str, done: int, total: int) -> None:
    pass


def test_no_threshold_is_better_than_the_one_that_is_found() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        samples = rng.integers(0, 6, (30, 1)).astype(np.float64)
        labels = rng.integers(0, 2, 30).astype(np.uint8)
        found = Threshold()
        found.fit(samples, labels)
        best = max(((samples[:, 0] >= bound) == labels).sum() for bound in range(-1, 8))
        assert (found.predict(samples) == labels).sum() == best


def test_a_colour_is_answered_wherever_it_stands() -> None:
    classifier = ColourClassifier(lambda colours: (colours[:, 2] > colours[:, 0]).astype(np.int64))
    picture = np.random.default_rng(1).integers(0, 256, (9, 7, 3)).astype(np.uint8)
    assert np.array_equal(classifier.classify(picture), picture[..., 2] > picture[..., 0])


def test_context_is_the_mean_and_the_deviation_over_boxes() -> None:
    class Nothing:
        def fit(self, samples: np.ndarray, labels: np.ndarray) -> None:
            """Learn nothing."""

        def predict(self, samples: np.ndarray) -> np.ndarray:
            return np.zeros(len(samples), dtype=np.int64)

    picture = np.random.default_rng(2).integers(0, 256, (33, 34, 3)).astype(np.uint8)
    samples = ContextClassifier(levels, Nothing()).samples(picture)
    assert samples.shape == (3, 4, 3 * (1 + 2 * len(BOXES)))
    window = picture[1 + 15 - 7 : 1 + 15 + 8, 2 + 15 - 7 : 2 + 15 + 8].astype(np.float64)
    assert samples[1, 2, :3].tolist() == picture[16, 17].tolist()
    place = 3 + 6 * BOXES.index(15)
    assert samples[1, 2, place : place + 3] == pytest.approx(window.mean(axis=(0, 1)))
    assert samples[1, 2, place + 3 : place + 6] == pytest.approx(window.std(axis=(0, 1)))


def test_means_are_over_whole_squares() -> None:
    values = np.arange(12, dtype=np.float64).reshape(3, 4, 1)
    assert box_means(values, 3)[..., 0].tolist() == [[5.0, 6.0]]


def test_light_cancels_from_ratios_and_indices() -> None:
    colour = np.array([[40.0, 60.0, 30.0]])
    for feature in (normalised_difference(0, 1), normalised_difference(0, 2), excess_green, ratios):
        assert feature(1000 * colour) == pytest.approx(feature(2000 * colour), abs=1e-4)
    assert normalised_difference(0, 2)(colour) == pytest.approx(10 / 71)


@pytest.mark.parametrize("train", [of_colours, of_varied_colours, of_context])
def test_each_kind_learns_what_red_tells(train: Callable[..., PictureClassifier]) -> None:
    classifier = train(linear, levels, 500, 0, DATASET)
    assert evaluate(classifier, DATASET, silent).accuracy > 0.85
    picture = DATASET.load(DATASET.names[0]).picture
    answers, known = classifier.answer(with_halo(picture, classifier.halo))
    assert answers.shape == known.shape == picture.shape[:2]


def test_each_image_is_judged_in_its_fold() -> None:
    trainer = partial(of_colours, Threshold, levels, 200, 0)
    shares = in_light(DATASET, trainer)
    names = DATASET.names
    unseen = trainer(DATASET.subset(names[1:]))
    assert shares.shape == (5, 4)
    assert shares[0, 1] == evaluate(unseen, DATASET.subset(names[:1]), silent).accuracy
    assert by_squares(DATASET, trainer, 0)[0] == pytest.approx(shares[:, 1].mean())
