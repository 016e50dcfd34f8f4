"""Nodes are dropped until the compiled network fits a number of LUTs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.training.gradient.cost import decision_luts, most_that_fit, network_luts
from wnn2hdl.training.gradient.inputs import InputBits
from wnn2hdl.training.gradient.layer import VotingLayer


@dataclass(frozen=True, eq=False)
class Budget:
    """LUTs that a whole network may take.

    Attributes:
        max_luts: how many, for encoder, nodes, votes and winner.
        inputs: what the nodes read.
        classes: class names.
    """

    max_luts: int
    inputs: InputBits
    classes: tuple[str, ...]

    def luts(self, layer: VotingLayer) -> int:
        """LUTs of the compiled network."""
        return network_luts(self.inputs.model(layer, self.classes))

    def fitted(self, layer: VotingLayer, effects: NDArray[np.float64]) -> VotingLayer:
        """The layer with as many of its best nodes as fit, the same number of each class.

        Args:
            layer: as trained; it may fit as it is.
            effects: how much each node matters, ``[nodes]``.

        Raises:
            InputError: not even one node per class fits.
        """
        # Nodes and votes are measured, but what a bit costs beside others is only bounded. The circuit of the
        # first guess says how far the bound is off.
        guess = self._largest(layer, effects, 0)
        spare = self._bound(guess) - self.luts(guess)
        kept = self._largest(layer, effects, spare)
        while self.luts(kept) > self.max_luts:
            if kept.nodes_per_class == 1:
                raise self._too_small()
            kept = layer.best_nodes(kept.nodes_per_class - 1, effects)
        return kept

    def _largest(self, layer: VotingLayer, effects: NDArray[np.float64], spare: int) -> VotingLayer:
        """The most of the best nodes whose bound, less what is spare in it, fits."""
        nodes = most_that_fit(
            layer.nodes_per_class,
            lambda n: self._bound(layer.best_nodes(n, effects)) - spare <= self.max_luts,
        )
        if nodes == 0:
            raise self._too_small()
        return layer.best_nodes(nodes, effects)

    def _bound(self, layer: VotingLayer) -> int:
        """LUTs of the network if no bit of the encoder shares logic with another."""
        encoder = self.inputs.luts[np.unique(layer.mapping)].sum()
        return layer.nodes + decision_luts(layer.classes, layer.nodes_per_class) + int(encoder)

    def _too_small(self) -> InputError:
        return InputError(
            "no network of these classes fits", value=f"{self.max_luts} LUTs", hint="allow more"
        )
