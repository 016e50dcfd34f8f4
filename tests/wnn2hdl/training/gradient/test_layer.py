"""The layer that is trained answers as the model that is compiled."""

import numpy as np

from wnn2hdl.training.gradient.layer import VotingLayer


def layer(seed: int, bits: int = 9, classes: int = 3, per_class: int = 4) -> VotingLayer:
    rng = np.random.default_rng(seed)
    nodes = classes * per_class
    weights = rng.uniform(-1, 1, (nodes, 64)).astype(np.float32)
    return VotingLayer(rng.integers(0, bits, (6, nodes)), weights, classes)


def test_slot_0_is_the_least_significant_address_bit() -> None:
    one = VotingLayer(np.arange(6)[:, np.newaxis], np.full((1, 64), -1, np.float32), 1)
    one.weights[0, 0b000101] = 1
    rows = np.zeros((6, 2), dtype=np.uint8)
    rows[[0, 2], 1] = 1
    assert one.places(rows).tolist() == [[0, 0b000101]]
    assert one.answers(one.places(rows)).tolist() == [[False, True]]


def test_votes_are_counted_class_by_class_and_the_first_of_equals_wins() -> None:
    three = layer(0, classes=3, per_class=2)
    answers = np.array([[1, 0], [0, 0], [1, 1], [0, 1], [0, 1], [0, 1]], dtype=np.bool_)
    assert three.votes(answers).tolist() == [[1, 0], [1, 2], [0, 2]]
    assert three.votes(answers).argmax(axis=0).tolist() == [0, 1]


def test_many_samples_are_predicted_as_each_alone() -> None:
    rows = np.random.default_rng(1).integers(0, 2, (9, 5000), dtype=np.uint8)
    some = layer(2)
    alone = [some.predict(rows[:, [sample]])[0] for sample in (0, 2047, 2048, 4999)]
    assert some.predict(rows)[[0, 2047, 2048, 4999]].tolist() == alone


def test_the_best_nodes_of_each_class_keep_their_order() -> None:
    some = layer(3, classes=2, per_class=3)
    kept = some.best_nodes(2, np.array([5.0, 1.0, 9.0, 2.0, 3.0, 1.0]))
    assert np.array_equal(kept.weights, some.weights[[0, 2, 3, 4]])
    assert np.array_equal(kept.mapping, some.mapping[:, [0, 2, 3, 4]])
