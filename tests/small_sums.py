"""Small random networks of sums of tables, for tests of lowering, proof and builds."""

import numpy as np

from wnn2hdl.ir.features import Words
from wnn2hdl.ir.models import SumLayer, TableSumModel


def sum_network(seed: int, *, word_bits: int = 3, inputs: int = 4, hidden: int = 3) -> TableSumModel:
    """Two layers; a node may have no edges, and a sum may leave its range on one side, both, or neither."""
    rng = np.random.default_rng(seed)
    widths, bits = (inputs, hidden, 3), (word_bits, 4, 3)
    layers = []
    for number in range(2):
        edges = np.argwhere(rng.random((widths[number + 1], widths[number])) < 0.7)
        slopes = rng.integers(-3, 4, (len(edges), 1))
        values = slopes * np.arange(1 << bits[number]) + rng.integers(-2, 3, (len(edges), 1 << bits[number]))
        layers.append(
            SumLayer(
                widths[number + 1],
                bits[number + 1],
                edges[:, 1].astype(np.int32),
                edges[:, 0].astype(np.int32),
                values.astype(np.int32),
            )
        )
    return TableSumModel(Words(inputs, word_bits), ("a", "b", "c"), tuple(layers))
