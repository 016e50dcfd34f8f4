"""The two phases of a training."""

import numpy as np

from wnn2hdl.training.gradient.samples import Batch, Samples
from wnn2hdl.training.gradient.training import Recipe, Training, enough_epochs, usual_heat

RECIPE = Recipe(epochs=6, wiring=0.5, patience=0.4, wiring_every=1)


def hidden_rule(rows: int = 600) -> Batch:
    """Twenty bits of noise, of which three decide by majority."""
    bits = np.random.default_rng(0).integers(0, 2, (20, rows), dtype=np.uint8)
    return bits, (bits[[3, 8, 14]].sum(axis=0) > 1).astype(np.int64)


def training(recipe: Recipe = RECIPE, luts: float = 0) -> Training:
    bits, labels = hidden_rule()
    return Training(recipe, Samples([bits], labels, seed=0), np.full(20, luts, np.float32), 2, 4)


def test_wiring_finds_the_bits_that_matter_and_tables_learn_the_rule() -> None:
    bits, labels = hidden_rule()
    learning = training(Recipe(epochs=100, wiring_every=1))
    while learning.epoch < 70:
        learning.run_epoch()
    used = np.bincount(learning.layer.mapping.ravel(), minlength=20)
    assert used[[3, 8, 14]].sum() > 0.5 * used.sum()
    learning.freeze(learning.layer)
    while not learning.finished:
        learning.run_epoch()
        learning.validate((bits, labels))
    learning.take_best()
    assert (learning.layer.predict(bits) == labels).mean() > 0.97


def test_a_price_presses_slots_onto_fewer_bits() -> None:
    read = []
    for price in (0.0, 3.0):
        learning = training(Recipe(epochs=30, wiring=1, bit_price=price, wiring_every=1), luts=1)
        while not learning.finished:
            learning.run_epoch()
        read.append(len(np.unique(learning.layer.mapping)))
    assert read[1] < read[0]


def test_frozen_wiring_stays() -> None:
    learning = training()
    learning.run_epoch()
    assert learning.wiring
    learning.freeze(learning.layer.best_nodes(2, np.arange(8.0)))
    assert (learning.wiring, learning.layer.nodes) == (False, 4)
    mapping, weights = learning.layer.mapping.copy(), learning.layer.weights.copy()
    learning.run_epoch()
    assert np.array_equal(learning.layer.mapping, mapping)
    assert not np.array_equal(learning.layer.weights, weights)


def test_it_ends_when_validation_does_not_improve_and_takes_the_best() -> None:
    bits, _ = hidden_rule()
    learning = training(Recipe(epochs=50, wiring=0.02, patience=0.04))
    learning.run_epoch()
    learning.freeze(learning.layer)
    learning.run_epoch()
    right = learning.layer.predict(bits)
    best = learning.layer.weights.copy()
    learning.validate((bits, right))
    while not learning.finished:
        learning.run_epoch()
        learning.validate((bits, 1 - learning.layer.predict(bits)))
    assert (learning.epoch, learning.best, learning.best_epoch) == (4, 1.0, 2)
    learning.take_best()
    assert np.array_equal(learning.layer.weights, best)


def test_a_saved_training_goes_on_as_it_was() -> None:
    for frozen in (False, True):
        one, other = training(), training()
        one.run_epoch()
        if frozen:
            one.freeze(one.layer.best_nodes(3, np.arange(8.0)))
            one.run_epoch()
            one.validate(hidden_rule())
        other.restore({name: array.copy() for name, array in one.arrays().items()})
        for learning in (one, other):
            learning.run_epoch()
        assert one.wiring == other.wiring == (not frozen)
        assert (one.epoch, one.best) == (other.epoch, other.best)
        assert all(np.array_equal(array, other.arrays()[name]) for name, array in one.arrays().items())


def test_few_samples_are_shown_more_often_and_with_softer_votes() -> None:
    assert [enough_epochs(samples) for samples in (100, 16_000, 60_000)] == [10_000, 159, 43]
    heats = [usual_heat(samples) for samples in (100, 5_000, 20_000, 60_000)]
    assert np.allclose(heats, [1, 0.66, 0.33, 0.33])
