"""Cross-entropy of the votes, and its gradients with respect to tables and wiring.

The gradient with respect to a vote is rounded to whole multiples of 2**-15. All that is summed over a batch
is then whole numbers that float32 holds exactly, so a sum is the same in whatever order, and on however
many threads, a library computes it.
"""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS
from wnn2hdl.training.gradient.layer import VotingLayer, chunks

GRAIN = 2.0**-15

MAX_BATCH = 256
"""Samples whose sum of gradients float32 holds exactly: ``MAX_BATCH / GRAIN`` is below 2**24."""


def temperature(nodes_per_class: int, scale: float) -> float:
    """What votes are divided by before the softmax: it grows as the spread of a sum of that many votes."""
    return scale * float(np.sqrt(nodes_per_class))


def slopes(votes: NDArray[np.int64], labels: NDArray[np.int64], heat: float) -> NDArray[np.float64]:
    """Gradient of the loss with respect to each class's logit, ``votes / heat``, in units of `GRAIN`.

    Args:
        votes: int64 ``[classes, samples]``.
        labels: index of the right class, ``[samples]``.
        heat: see `temperature`.

    Returns:
        whole numbers, float64 ``[classes, samples]``.
    """
    shares = _softmax(votes, heat)
    shares[labels, np.arange(len(labels))] -= 1
    return np.rint(shares / GRAIN)


def weight_gradient(
    layer: VotingLayer, places: NDArray[np.int64], node_slopes: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Gradient with respect to the weights, as if a node answered with its weight: float32 ``[nodes, 64]``.

    Args:
        layer: the layer.
        places: see `VotingLayer.places`.
        node_slopes: the slope of each node's class, ``[nodes, samples]``.
    """
    sums = np.bincount(places.ravel(), node_slopes.ravel(), layer.weights.size)
    return sums.reshape(layer.weights.shape).astype(np.float32)


def wiring_gradient(
    layer: VotingLayer,
    places: NDArray[np.int64],
    node_slopes: NDArray[np.float64],
    rows: NDArray[np.uint8],
) -> NDArray[np.float32]:
    """Gradient with respect to the scores that choose what each slot reads, for all bits it could read.

    A slot that reads 1 instead of 0 changes its node's answer by a finite difference of its table; the bits
    stand for -1 and 1.

    Args:
        layer: the layer.
        places: see `VotingLayer.places`.
        node_slopes: the slope of each node's class, whole numbers ``[nodes, samples]``.
        rows: the input bits, 0 or 1, ``[bits, samples]``.

    Returns:
        float32 ``[6 * nodes, bits]``, slot by slot.
    """
    tables = layer.tables.ravel().astype(np.float32)
    effects = np.empty((LUT_INPUTS, *places.shape), dtype=np.float32)
    for slot in range(LUT_INPUTS):
        bit = 1 << slot
        change = tables.take(places | bit) - tables.take(places & ~bit)
        np.multiply(change, node_slopes, out=effects[slot], casting="same_kind")
    signs = rows.astype(np.float32)
    signs *= 2
    signs -= 1
    return np.asarray(effects.reshape(-1, rows.shape[1]) @ signs.T)


def node_effects(
    layer: VotingLayer, rows: NDArray[np.uint8], labels: NDArray[np.int64], heat: float
) -> NDArray[np.float64]:
    """How much the mean loss rises if a node answers with its mean instead: float64 ``[nodes]``.

    Args:
        layer: the layer.
        rows: bits of the samples it is measured on, ``[bits, samples]``.
        labels: index of the right class, ``[samples]``.
        heat: see `temperature`.
    """
    owners = np.repeat(np.arange(layer.classes), layer.nodes_per_class)
    rise = np.zeros(layer.nodes)
    start = 0
    for part in chunks(rows):
        right = labels[start : start + part.shape[1]]
        start += part.shape[1]
        answers = layer.answers(layer.places(part))
        shares = _softmax(layer.votes(answers), heat)[owners]
        change = (answers.mean(axis=1, keepdims=True) - answers) / heat
        rise += (np.log1p(shares * np.expm1(change)) - change * (owners[:, np.newaxis] == right)).sum(axis=1)
    return rise / len(labels)


def _softmax(votes: NDArray[np.int64], heat: float) -> NDArray[np.float64]:
    powers = np.exp((votes - votes.max(axis=0)) / heat)
    return np.asarray(powers / powers.sum(axis=0))
