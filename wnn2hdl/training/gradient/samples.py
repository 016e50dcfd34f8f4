"""The labelled samples that a layer is trained on, batch by batch, and those that it is validated on."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

Batch = tuple[NDArray[np.uint8], NDArray[np.int64]]
"""Input bits, 0 or 1, ``[bits, samples]``, and the index of the class of each sample, ``[samples]``."""


class Samples:
    """Samples as bits, eight to a byte.

    Args:
        copies: the samples as they are, and distorted; each 0 or 1, uint8 ``[bits, samples]``. Every epoch
            takes the next copy.
        labels: class index of each sample, int64 ``[samples]``.
        seed: of their order in each epoch.
    """

    def __init__(self, copies: Sequence[NDArray[np.uint8]], labels: NDArray[np.int64], seed: int) -> None:
        self._width = len(copies[0])
        # By sample, since a batch is drawn from anywhere.
        self._packed = [np.packbits(rows.T, axis=1) for rows in copies]
        self._labels = labels
        self._seed = seed

    def __len__(self) -> int:
        return len(self._labels)

    def epoch(self, number: int, batch: int) -> Iterator[Batch]:
        """All samples once, in an order that depends on the seed and the epoch's number.

        Args:
            number: of the epoch.
            batch: samples at a time; what is left at the end makes a smaller batch.
        """
        order = np.random.default_rng((self._seed, number)).permutation(len(self))
        packed = self._packed[number % len(self._packed)]
        for start in range(0, len(order), batch):
            yield self._batch(packed, order[start : start + batch])

    def some(self, count: int) -> Batch:
        """At most ``count`` of the undistorted samples, always the same."""
        chosen = np.random.default_rng(self._seed).permutation(len(self))[:count]
        return self._batch(self._packed[0], chosen)

    def _batch(self, packed: NDArray[np.uint8], chosen: NDArray[np.int64]) -> Batch:
        bits = np.unpackbits(packed[chosen], axis=1, count=self._width)
        return np.ascontiguousarray(bits.T), self._labels[chosen]


def split(labels: NDArray[np.int64], share: float, seed: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which samples are trained on and which are kept for validation, drawn class by class.

    Args:
        labels: class index of each sample, ``[samples]``.
        share: of each class that is kept, rounded down.
        seed: of the draw.

    Returns:
        indices, ascending: int64 ``[training]`` and ``[validation]``.
    """
    rng = np.random.default_rng(seed)
    kept = np.zeros(len(labels), dtype=np.bool_)
    for label in np.unique(labels):
        of_class = rng.permutation(np.flatnonzero(labels == label))
        kept[of_class[: int(share * len(of_class))]] = True
    return np.flatnonzero(~kept), np.flatnonzero(kept)
