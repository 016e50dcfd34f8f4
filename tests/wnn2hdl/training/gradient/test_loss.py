"""Gradients against what they stand for: the loss with another answer, another input, without a node."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.training.gradient.layer import VotingLayer
from wnn2hdl.training.gradient.loss import (
    GRAIN,
    MAX_BATCH,
    node_effects,
    slopes,
    weight_gradient,
    wiring_gradient,
)

HEAT = 0.8


def some_layer(seed: int, nodes: int = 6) -> VotingLayer:
    rng = np.random.default_rng(seed)
    weights = rng.uniform(-1, 1, (nodes, 64)).astype(np.float32)
    return VotingLayer(rng.integers(0, 9, (6, nodes)), weights, classes=2)


def some_samples(seed: int, count: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    rng = np.random.default_rng(seed)
    return rng.integers(0, 2, (9, count), dtype=np.uint8), rng.integers(0, 2, count)


def cross_entropy(votes: NDArray[np.floating], labels: NDArray[np.int64]) -> float:
    logits = votes / HEAT
    right = logits[labels, np.arange(len(labels))]
    return float((np.log(np.exp(logits).sum(axis=0)) - right).sum())


def test_slopes_are_those_of_cross_entropy() -> None:
    votes, labels = np.array([[2, 0], [1, 3], [0, 3]]), np.array([0, 2])
    step = 1e-4
    for owner in range(3):
        for sample in range(2):
            up, down = votes.astype(float), votes.astype(float)
            up[owner, sample] += step * HEAT
            down[owner, sample] -= step * HEAT
            numeric = (cross_entropy(up, labels) - cross_entropy(down, labels)) / (2 * step)
            assert abs(slopes(votes, labels, HEAT)[owner, sample] * GRAIN - numeric) < 2 * GRAIN


def test_an_address_gets_the_slopes_of_the_samples_that_meet_it() -> None:
    layer, (rows, labels) = some_layer(0), some_samples(1, 40)
    places = layer.places(rows)
    node_slopes = np.repeat(slopes(layer.votes(layer.answers(places)), labels, HEAT), 3, axis=0)
    gradient = weight_gradient(layer, places, node_slopes)
    node = 4
    for address in range(64):
        meets = places[node] == node * 64 + address
        assert gradient[node, address] == node_slopes[node, meets].sum()


def test_a_score_gets_the_change_of_the_answer_times_the_sign_of_the_bit() -> None:
    layer, (rows, labels) = some_layer(2), some_samples(3, 40)
    places = layer.places(rows)
    node_slopes = np.repeat(slopes(layer.votes(layer.answers(places)), labels, HEAT), 3, axis=0)
    gradient = wiring_gradient(layer, places, node_slopes, rows).reshape(6, 6, 9)
    for slot, node, bit in ((0, 0, 0), (3, 2, 8), (5, 5, 4)):
        expected = 0.0
        for sample in range(40):
            address = int(places[node, sample]) - node * 64
            with_one, with_zero = (
                layer.tables[node, a] for a in (address | 1 << slot, address & ~(1 << slot))
            )
            sign = 2 * int(rows[bit, sample]) - 1
            expected += (int(with_one) - int(with_zero)) * node_slopes[node, sample] * sign
        assert gradient[slot, node, bit] == expected


def test_sums_over_a_batch_are_exact_in_any_order() -> None:
    """So they do not depend on how a library parts the work among threads."""
    layer, (rows, labels) = some_layer(4), some_samples(5, MAX_BATCH)
    order = np.random.default_rng(6).permutation(MAX_BATCH)

    def gradients(chosen: NDArray[np.int64]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        places = layer.places(rows[:, chosen])
        node_slopes = np.repeat(slopes(layer.votes(layer.answers(places)), labels[chosen], HEAT), 3, axis=0)
        return (
            weight_gradient(layer, places, node_slopes),
            wiring_gradient(layer, places, node_slopes, np.ascontiguousarray(rows[:, chosen])),
        )

    for one, other in zip(gradients(np.arange(MAX_BATCH)), gradients(order), strict=True):
        assert np.array_equal(one, other)
        assert one.any()


def test_the_effect_of_a_node_is_the_rise_of_the_loss_without_it() -> None:
    layer, (rows, labels) = some_layer(7), some_samples(8, 50)
    answers = layer.answers(layer.places(rows)).astype(float)
    effects = node_effects(layer, rows, labels, HEAT)

    def loss(of: NDArray[np.float64]) -> float:
        return cross_entropy(np.stack([of[:3].sum(axis=0), of[3:].sum(axis=0)]), labels) / 50

    for node in range(6):
        without = answers.copy()
        without[node] = answers[node].mean()
        assert abs(effects[node] - (loss(without) - loss(answers))) < 1e-9
