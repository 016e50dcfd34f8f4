"""Training of a layer in two phases: first what its nodes read and their tables, then the tables alone."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS
from wnn2hdl.training.gradient.adam import Adam, mean_squares
from wnn2hdl.training.gradient.layer import ADDRESSES, VotingLayer
from wnn2hdl.training.gradient.loss import (
    MAX_BATCH,
    node_effects,
    slopes,
    temperature,
    weight_gradient,
    wiring_gradient,
)
from wnn2hdl.training.gradient.samples import Batch, Samples

MIN_BATCHES = 10_000
"""Batches of a training of `enough_epochs`, at least."""


MANY_SAMPLES = 20_000
MOST_HEAT = 1.0
"""See `usual_heat`."""

_EFFECT_SAMPLES = 10_000
"""Samples on which the effect of each node is measured."""


@dataclass(frozen=True)
class Recipe:
    """How a layer is trained.

    Attributes:
        epochs: passes over the training samples, both phases together; see `enough_epochs`.
        wiring: share of the epochs in which wiring is trained, too.
        patience: share of the epochs after which the second phase ends if no better accuracy in validation
            was reached meanwhile.
        heat: see `wnn2hdl.training.gradient.loss.temperature` and `usual_heat`.
        bit_price: how hard scores are pressed away from a bit that costs a LUT and that nothing else reads,
            in units of the wiring gradient's root mean square. It rises from 0 at the start to this at the
            end of the first phase.
        weight_rate: Adam's rate for weights at the start; it falls to 0 along a cosine.
        wiring_rate: the same for scores of the wiring.
        wiring_every: batches from one step of the wiring to the next.
        seed: of everything that is random.
    """

    epochs: int
    wiring: float = 0.7
    patience: float = 0.15
    heat: float = 0.33
    bit_price: float = 0.4
    weight_rate: float = 1e-2
    wiring_rate: float = 1e-1
    wiring_every: int = 8
    seed: int = 0

    @property
    def wiring_epochs(self) -> int:
        """Epochs of the first phase."""
        return round(self.epochs * self.wiring)


def enough_epochs(samples: int) -> int:
    """Epochs that suffice in most cases: 40, and more for so few samples that an epoch is a few batches."""
    return max(40, -(-MIN_BATCHES // -(-samples // MAX_BATCH)))


def usual_heat(samples: int) -> float:
    """The `Recipe.heat` that suits so many samples: few want softer votes."""
    return min(MOST_HEAT, Recipe.heat * max(1.0, float(np.sqrt(MANY_SAMPLES / samples))))


def usual_recipe(
    samples: int, *, epochs: int | None = None, heat: float | None = None, seed: int = 0
) -> Recipe:
    """The recipe for so many samples, made-up rows included.

    Args:
        samples: how many.
        epochs: None for `enough_epochs`.
        heat: None for `usual_heat`.
        seed: of everything random.
    """
    return Recipe(
        enough_epochs(samples) if epochs is None else epochs,
        heat=usual_heat(samples) if heat is None else heat,
        seed=seed,
    )


class Training:
    """A training, as far as it is.

    Args:
        recipe: how it goes on.
        samples: what is trained on.
        luts: about what each input bit costs in LUTs, float32 ``[bits]``.
        classes: how many.
        nodes_per_class: nodes that vote for one class, in the first phase.

    Attributes:
        layer: as it is now.
        epoch: how many are finished.
        best: the highest accuracy in validation in the second phase, 0 to 1; -1 before.
        best_epoch: when it was reached.
        steps: what `note` found so far: nodes for each class and accuracy.
    """

    def __init__(
        self,
        recipe: Recipe,
        samples: Samples,
        luts: NDArray[np.float32],
        classes: int,
        nodes_per_class: int,
    ) -> None:
        self._recipe = recipe
        self._samples = samples
        self._luts = luts
        self._steps = recipe.epochs * -(-len(samples) // MAX_BATCH)
        self._step = 0
        rng = np.random.default_rng(recipe.seed)
        nodes = nodes_per_class * classes
        self._scores: NDArray[np.float32] | None = rng.random((LUT_INPUTS * nodes, len(luts)), np.float32)
        weights = rng.uniform(-1, 1, (nodes, ADDRESSES)).astype(np.float32)
        self.layer = VotingLayer(_chosen(self._scores), weights, classes)
        self._by_weight, self._by_score = Adam(weights.shape), Adam(self._scores.shape, by_row=True)
        self.epoch = 0
        self.best, self.best_epoch = -1.0, 0
        self._best_weights: NDArray[np.float32] | None = None
        self.steps: list[tuple[int, float]] = []

    @property
    def wiring(self) -> bool:
        """Whether this is the first phase."""
        return self._scores is not None

    @property
    def finished(self) -> bool:
        """Whether all epochs are trained, or the second phase has not become better for long enough."""
        recipe = self._recipe
        waited = self.epoch - max(self.best_epoch, recipe.wiring_epochs)
        stale = not self.wiring and waited >= max(1, recipe.patience * recipe.epochs)
        return self.epoch >= recipe.epochs or stale

    def freeze(self, layer: VotingLayer) -> None:
        """Begin the second phase with nodes of the layer; what they read stays as it is."""
        self.layer = layer
        self._scores = None
        self._by_weight = Adam(layer.weights.shape)

    def run_epoch(self) -> None:
        """Train on every sample once."""
        for rows, labels in self._samples.epoch(self.epoch, MAX_BATCH):
            self._batch(rows, labels)
        self.epoch += 1

    def _batch(self, rows: NDArray[np.uint8], labels: NDArray[np.int64]) -> None:
        layer, recipe = self.layer, self._recipe
        places = layer.places(rows)
        votes = layer.votes(layer.answers(places))
        heat = temperature(layer.nodes_per_class, recipe.heat)
        node_slopes = np.repeat(slopes(votes, labels, heat), layer.nodes_per_class, axis=0)
        rate = (1 + np.cos(np.pi * self._step / self._steps)) / 2
        gradient = weight_gradient(layer, places, node_slopes)
        if self._scores is not None and self._step % recipe.wiring_every == 0:
            wiring = wiring_gradient(layer, places, node_slopes, rows)
            readers = np.bincount(layer.mapping.ravel(), minlength=len(self._luts))
            price = recipe.bit_price * self.epoch / recipe.wiring_epochs
            wiring += np.float32(price) * np.sqrt(mean_squares(wiring)) * self._luts / (1 + readers)
            self._by_score.step(self._scores, wiring, recipe.wiring_rate * rate)
            self.layer = replace(layer, mapping=_chosen(self._scores))
        self._by_weight.step(layer.weights, gradient, recipe.weight_rate * rate)
        np.clip(layer.weights, -1, 1, out=layer.weights)
        self._step += 1

    def effects(self) -> NDArray[np.float64]:
        """How much each node matters on some of the samples, see `node_effects`: float64 ``[nodes]``."""
        rows, labels = self._samples.some(_EFFECT_SAMPLES)
        heat = temperature(self.layer.nodes_per_class, self._recipe.heat)
        return node_effects(self.layer, rows, labels, heat)

    def note(self, validation: Batch) -> None:
        """Remember how accurate the layer is at this step, if there are samples to tell."""
        if len(validation[1]):
            self.steps.append((self.layer.nodes_per_class, self._accuracy(validation)))

    def _accuracy(self, validation: Batch) -> float:
        rows, labels = validation
        return float((self.layer.predict(rows) == labels).mean()) if len(labels) else 0.0

    def validate(self, validation: Batch) -> None:
        """Keep the weights if none were better in validation; without samples there, the last ones are."""
        right = self._accuracy(validation)
        if right >= self.best:
            self.best, self.best_epoch, self._best_weights = right, self.epoch, self.layer.weights.copy()

    def take_best(self) -> None:
        """Go back to the weights that were best in validation, if there was any."""
        if self._best_weights is not None:
            self.layer = replace(self.layer, weights=self._best_weights)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """All that a training is at the end of an epoch, by name."""
        numbers = np.array([self.epoch, self._step, self.best_epoch], dtype=np.int64)
        arrays: dict[str, NDArray[Any]] = {
            "numbers": numbers,
            "best": np.array(self.best),
            "steps": np.array(self.steps, dtype=np.float64).reshape(-1, 2),
            "mapping": self.layer.mapping,
            "weights": self.layer.weights,
        }
        arrays |= {f"by_weight.{name}": array for name, array in self._by_weight.arrays().items()}
        if self._best_weights is not None:
            arrays["best_weights"] = self._best_weights
        if self._scores is not None:
            arrays["scores"] = self._scores
            arrays |= {f"by_score.{name}": array for name, array in self._by_score.arrays().items()}
        return arrays

    def restore(self, arrays: dict[str, NDArray[Any]]) -> None:
        """Go on from `arrays` of a training of the same recipe and samples."""
        self.epoch, self._step, self.best_epoch = (int(number) for number in arrays["numbers"])
        self.best, self._best_weights = float(arrays["best"]), arrays.get("best_weights")
        self.steps = [(int(nodes), float(right)) for nodes, right in arrays["steps"]]
        self.layer = replace(self.layer, mapping=arrays["mapping"], weights=arrays["weights"])
        self._by_weight = _adam(arrays, "by_weight")
        self._scores = arrays.get("scores")
        if self._scores is not None:
            self._by_score = _adam(arrays, "by_score")


def _adam(arrays: dict[str, NDArray[Any]], prefix: str) -> Adam:
    return Adam.of({name: arrays[f"{prefix}.{name}"] for name in ("mean", "square", "steps")})


def _chosen(scores: NDArray[np.float32]) -> NDArray[np.int64]:
    """What each slot of each node reads, ``[6, nodes]``: the bit of the highest score."""
    return np.asarray(scores.argmax(axis=1).reshape(LUT_INPUTS, -1))
