"""From features to a network, killed or not, within a budget or not."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.training.gradient import Architecture, Recipe, Trained, network, train_network
from wnn2hdl.training.gradient.cost import network_luts

WORDS = FixedPoint.parse("UQ8.0")
RECIPE = Recipe(epochs=10, wiring_every=1)
CLASSES = ("dark", "left", "right")


def silent(step: str, done: int, total: int) -> None:
    pass


def pictures(count: int = 400) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Noise of 4x4 pixels with a bright column on the left, on the right, or nowhere."""
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 3, count)
    levels = rng.integers(0, 140, (count, 4, 4)).astype(np.float64)
    levels[labels == 1, :, 0] += 100
    levels[labels == 2, :, 3] += 100
    return levels.reshape(count, 16), labels


def trained(architecture: Architecture, recipe: Recipe = RECIPE, checkpoint: Path | None = None) -> Trained:
    features, labels = pictures()
    return train_network(features, labels, CLASSES, architecture, recipe, silent, checkpoint)


def test_a_network_learns_and_says_how_well() -> None:
    found = trained(Architecture(WORDS, nodes=5, levels=2), Recipe(epochs=100, wiring_every=1))
    features, labels = pictures()
    answers = found.model.evaluate(found.model.encoder.bits(features))
    assert (answers == labels).mean() > 0.9
    assert found.validation is not None
    assert 0.85 < found.validation <= 1
    assert (found.nodes, found.luts) == (5, None)
    assert [nodes for nodes, _ in found.steps] == [5, 5, 5]
    assert found.steps[-1][1] == found.validation
    assert found.steps[0] == found.steps[1]  # nothing was dropped
    assert found.model.classes == CLASSES


@pytest.mark.slow
def test_a_budget_is_kept_and_used() -> None:
    found = trained(Architecture(WORDS, max_luts=30, levels=1, grid=(4, 4)))
    assert found.luts is not None
    assert 20 < found.luts <= 30
    assert found.luts == network_luts(found.model)
    assert found.model.layers[-1].nodes == 3 * found.nodes
    before, dropped, again = found.steps
    assert before[0] > dropped[0] == again[0]


def test_without_validation_all_epochs_are_trained_on_all_samples() -> None:
    found = trained(Architecture(WORDS, nodes=2, validation=0), Recipe(epochs=5, patience=0.2))
    assert (found.validation, found.epochs, found.steps) == (None, 5, ())


def test_distorted_pictures_give_another_network() -> None:
    plain, moved = (
        trained(Architecture(WORDS, nodes=2, grid=(4, 4), distortions=count), Recipe(epochs=20))
        for count in (0, 1)
    )
    assert plain.model.digest() != moved.model.digest()


@pytest.mark.parametrize("killed_after", [3, 8])
def test_a_killed_training_goes_on_and_gives_the_same_network(
    killed_after: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(network, "SAVE_BATCHES", 1)
    features, labels = pictures()
    architecture, state = Architecture(WORDS, nodes=3), tmp_path / "state"
    whole = trained(architecture)
    begun: list[int] = []

    def killed(step: str, done: int, total: int) -> None:
        if done == killed_after:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train_network(features, labels, CLASSES, architecture, RECIPE, killed, state)
    assert state.exists()
    again = train_network(
        features, labels, CLASSES, architecture, RECIPE, lambda _, done, __: begun.append(done), state
    )
    assert begun[0] == killed_after
    assert again.model.digest() == whole.model.digest()
    assert again.steps == whole.steps
    assert not state.exists()


def test_a_state_of_another_seed_is_not_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network, "SAVE_BATCHES", 1)
    features, labels = pictures()
    architecture, state = Architecture(WORDS, nodes=3), tmp_path / "state"

    def killed(step: str, done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train_network(features, labels, CLASSES, architecture, Recipe(epochs=10, seed=1), killed, state)
    assert trained(architecture, checkpoint=state).model.digest() == trained(architecture).model.digest()


def test_a_class_without_samples_is_named() -> None:
    features, labels = pictures()
    with pytest.raises(InputError, match="a class has no sample to train on: right; add some"):
        train_network(features, labels % 2, CLASSES, Architecture(WORDS), RECIPE, silent)
