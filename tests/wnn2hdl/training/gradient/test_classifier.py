"""`LutNetworkClassifier` as scikit-learn expects it."""

from typing import Any

import numpy as np
import pytest
from sklearn.base import BaseEstimator
from sklearn.utils.estimator_checks import parametrize_with_checks

from wnn2hdl.errors import InputError
from wnn2hdl.training.gradient import LutNetworkClassifier


@parametrize_with_checks([LutNetworkClassifier("Q11.16", nodes=4, epochs=150, validation=0, made_up=0)])
def test_scikit_learn(estimator: BaseEstimator, check: Any) -> None:
    check(estimator)


def test_labels_come_back_as_they_were_and_the_model_answers_as_the_classifier() -> None:
    rng = np.random.default_rng(0)
    owners = rng.integers(0, 3, 300)
    X = rng.normal(size=(300, 4)) + 3 * np.eye(4)[owners]
    y = np.array(["wheat", "oats", "rye"])[owners]
    classifier = LutNetworkClassifier("Q4.4", nodes=6, epochs=200, made_up=0).fit(X, y)
    assert classifier.classes_.tolist() == ["oats", "rye", "wheat"]
    assert classifier.score(X, y) > 0.85
    model = classifier.model_
    answers = model.evaluate(model.encoder.bits(X))
    assert np.array_equal(classifier.classes_[answers], classifier.predict(X))
    assert np.array_equal(model.responses(model.encoder.bits(X)), classifier.decision_function(X))
    assert (classifier.luts_, classifier.teacher_) == (None, None)


def test_few_samples_are_taught_unless_no_rows_are_to_be_made_up() -> None:
    rng = np.random.default_rng(1)
    X = rng.integers(0, 256, (60, 3))
    y = X[:, 0] > X[:, 1]
    classifier = LutNetworkClassifier("UQ8.0", nodes=6, epochs=4).fit(X, y)
    assert classifier.teacher_ is not None
    assert classifier.teacher_.accuracy > 0.8
    assert classifier.score(X, y) > 0.8


def test_what_cannot_be_trained_is_refused() -> None:
    X, y = np.arange(20.0).reshape(10, 2), np.arange(10) % 2
    with pytest.raises(ValueError, match="is not a format of words"):
        LutNetworkClassifier("8 bits").fit(X, y)
    with pytest.raises(InputError, match="no network of 2 classes fits: 1 LUTs"):
        LutNetworkClassifier("UQ5.0", max_luts=1).fit(X, y)
