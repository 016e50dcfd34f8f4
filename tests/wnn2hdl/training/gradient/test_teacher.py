"""A teacher is chosen by cross-validation, and rows are made up where samples lie."""

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.training.gradient import Architecture, Recipe, train_network, usual_made_up
from wnn2hdl.training.gradient.teacher import choose_teacher, made_up

BYTES = FixedPoint.parse("UQ8.0")


def ring(count: int = 120) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points of a plane, inside of a circle or outside."""
    points = np.random.default_rng(0).uniform(0, 255, (count, 2))
    return np.rint(points), (np.hypot(*(points - 128).T) < 100).astype(np.int64)


def test_the_teacher_that_is_most_often_right_is_chosen() -> None:
    points, inside = ring()
    curved = choose_teacher(points, inside, seed=0)
    assert curved.name != "linear discriminant"
    assert curved.accuracy > 0.9
    assert (curved.classifier.predict(points) == inside).mean() > 0.95
    straight = np.random.default_rng(1).normal(size=(60, 12))
    assert choose_teacher(straight, (straight.sum(axis=1) > 0).astype(np.int64), seed=0).name in (
        "linear discriminant",
        "logistic regression",
    )


def test_two_samples_suffice_for_a_teacher() -> None:
    teacher = choose_teacher(np.array([[0.0], [9.0]]), np.array([0, 1]), seed=0)
    assert teacher.accuracy == 0
    assert teacher.classifier.predict([[1.0], [8.0]]).tolist() == [0, 1]


@pytest.mark.parametrize("value", [5.0, 1e302])
def test_features_that_never_vary_are_refused_as_without_a_teacher(value: float) -> None:
    features = np.full((20, 2), value)
    for rows in (0, 100):
        with pytest.raises(InputError, match="no feature tells samples apart in this format of words"):
            train_network(
                features,
                np.arange(20) % 2,
                ("a", "b"),
                Architecture(BYTES, made_up=rows),
                Recipe(epochs=2),
                lambda *_: None,
            )


def test_a_teacher_learns_from_features_as_hardware_saturates_them() -> None:
    features = np.array([[0.0], [10.0], [1e308], [-1e308]] * 10)
    found = train_network(
        features,
        (features[:, 0] > 5).astype(np.int64),
        ("low", "high"),
        Architecture(BYTES, made_up=500),
        Recipe(epochs=2),
        lambda *_: None,
    )
    assert found.teacher is not None
    assert found.teacher.accuracy == 1


def test_rows_lie_between_neighbours_and_are_words() -> None:
    cross = np.array([[0.0, 0.0], [4.0, 0.0]] * 20 + [[200.0, 7.0], [204.0, 7.0]] * 20)
    rows = made_up(cross, BYTES, 500, seed=3)
    assert rows.shape == (500, 2)
    assert np.array_equal(rows, BYTES.values(BYTES.words(rows)))
    assert rows.min() >= 0
    assert rows.max() <= 204
    assert (np.abs(rows[:, 0] - 102) > 40).all()  # no row in the gap between the two groups
    assert len(np.unique(rows, axis=0)) > 50
    assert np.array_equal(rows, made_up(cross, BYTES, 500, seed=3))
    assert not np.array_equal(rows, made_up(cross, BYTES, 500, seed=4))


def test_rows_are_rounded_to_the_nearest_word_and_a_constant_feature_stays() -> None:
    halves = FixedPoint.parse("Q3.1")
    rows = made_up(np.array([[1.5, 2.0], [3.5, 2.0]]), halves, 4000, seed=0)
    assert set(rows[:, 0]) == {1.5, 2.0, 2.5, 3.0, 3.5}
    assert abs(rows[:, 0].mean() - 2.5) < 0.05
    assert set(rows[:, 1]) == {2.0}


def test_only_few_samples_that_are_no_pictures_are_taught() -> None:
    assert usual_made_up(150, pictures=False) > 1000
    assert usual_made_up(150, pictures=True) == 0
    assert usual_made_up(50_000, pictures=False) == 0


@pytest.mark.slow
def test_a_taught_network_answers_rows_it_has_not_seen_more_often_right() -> None:
    points, inside = ring(1120)
    right = []
    for rows in (0, 8000):
        architecture = Architecture(BYTES, nodes=10, levels=12, made_up=rows)
        found = train_network(
            points[:60], inside[:60], ("out", "in"), architecture, Recipe(epochs=60), lambda *_: None
        )
        assert (found.teacher is not None) == bool(rows)
        answers = found.model.evaluate(found.model.encoder.bits(points[120:]))
        right.append((answers == inside[120:]).mean())
    assert right[1] > right[0] + 0.02
    assert right[1] > 0.88
