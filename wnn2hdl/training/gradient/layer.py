"""A layer of 6-input look-up tables that vote for classes, in the form that is trained."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS

ADDRESSES = 1 << LUT_INPUTS

_CHUNK = 2048
"""Samples that are evaluated at a time."""


@dataclass(frozen=True, eq=False)
class VotingLayer:
    """Nodes of six inputs, as many for each class.

    The class with the most votes wins, the first among equals.

    Attributes:
        mapping: int64 ``[6, nodes]``, which input bit each slot of a node reads; slot 0 is the least
            significant address bit. The nodes of class 0 come first.
        weights: float32 ``[nodes, 64]``, from -1 to 1; a node votes at the addresses whose weight is above 0.
        classes: how many.
    """

    mapping: NDArray[np.int64]
    weights: NDArray[np.float32]
    classes: int

    @property
    def nodes(self) -> int:
        """Nodes of all classes."""
        return len(self.weights)

    @property
    def nodes_per_class(self) -> int:
        """Nodes that vote for one class."""
        return self.nodes // self.classes

    @property
    def tables(self) -> NDArray[np.bool_]:
        """The answer of each node at each address: bool ``[nodes, 64]``."""
        return self.weights > 0

    def places(self, rows: NDArray[np.uint8]) -> NDArray[np.int64]:
        """Where each node looks in all weights laid end to end: ``node * 64 + address``.

        Args:
            rows: 0 or 1, ``[bits, samples]``.

        Returns:
            int64 ``[nodes, samples]``.
        """
        address = rows[self.mapping[0]]
        for slot in range(1, LUT_INPUTS):
            address |= rows[self.mapping[slot]] << np.uint8(slot)
        return np.asarray(address + np.arange(0, self.weights.size, ADDRESSES)[:, np.newaxis])

    def answers(self, places: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Answers of the nodes at `places`: bool ``[nodes, samples]``."""
        return self.tables.ravel().take(places)

    def votes(self, answers: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Votes for each class: answers ``[nodes, samples]`` give int64 ``[classes, samples]``."""
        by_class = answers.reshape(self.classes, self.nodes_per_class, -1)
        return np.asarray(by_class.sum(axis=1, dtype=np.int64))

    def predict(self, rows: NDArray[np.uint8]) -> NDArray[np.int64]:
        """Index of the winning class for bits ``[bits, samples]``: int64 ``[samples]``."""
        return np.concatenate(
            [self.votes(self.answers(self.places(part))).argmax(axis=0) for part in chunks(rows)]
        )

    def best_nodes(self, per_class: int, effects: NDArray[np.float64]) -> Self:
        """The layer with the nodes of each class that have the largest effects, in the order they had.

        Args:
            per_class: nodes to keep of each class.
            effects: of each node, ``[nodes]``.
        """
        by_class = effects.reshape(self.classes, self.nodes_per_class)
        kept = np.sort(np.argsort(-by_class, axis=1, kind="stable")[:, :per_class], axis=1)
        flat = (kept + np.arange(self.classes)[:, np.newaxis] * self.nodes_per_class).ravel()
        return replace(self, mapping=self.mapping[:, flat], weights=self.weights[flat])


def chunks(rows: NDArray[np.uint8]) -> list[NDArray[np.uint8]]:
    """Bits ``[bits, samples]`` in parts of a size that fits caches; at least one part."""
    return [rows[:, start : start + _CHUNK] for start in range(0, max(1, rows.shape[1]), _CHUNK)]
