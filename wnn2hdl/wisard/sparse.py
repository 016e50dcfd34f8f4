"""Training a WiSARD whose RAMs store only the addresses that they have seen."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import Encoder
from wnn2hdl.ir.models import SparseWisardModel
from wnn2hdl.wisard.bleaching import candidates
from wnn2hdl.wisard.rams import addresses, chunks, silent_rams

MARKED_ADDRESSES = 1 << 16
"""Addresses of a RAM up to which each has a mark of its own while training."""


def train_sparse(
    bits: NDArray[np.bool_],
    owners: NDArray[np.int64],
    encoder: Encoder,
    classes: tuple[str, ...],
    mapping: NDArray[np.int64],
    bleaching: int | None = None,
    origin: Mapping[str, Any] | None = None,
) -> SparseWisardModel:
    """Train one discriminator per class on samples.

    Args:
        bits: bool ``[samples, encoder.width]``.
        owners: class index of each sample, int64 ``[samples]``.
        encoder: what made the bits.
        classes: class names.
        mapping: int64 ``[1 or classes, k, n]``, as `draw_mapping` gives it.
        bleaching: the threshold; None takes the one with the best leave-one-out accuracy, the lowest among
            equals.
        origin: what to record in the model's `SparseWisardModel.origin`.
    """
    seen = [_Seen.of(addresses(bits, group[np.newaxis])[0]) for group in mapping]
    counts = [
        np.bincount(seen[owner % len(seen)].places[:, owners == owner].ravel(), minlength=here.size)
        for owner in range(len(classes))
        for here in (seen[owner % len(seen)],)
    ]
    if bleaching is None:
        bleaching = _choose_bleaching(seen, counts, owners)
    stored, offsets = [], [0]
    for owner, count in enumerate(counts):
        used = count > 0
        stored.append((seen[owner % len(seen)].addresses[used], count[used]))
        ends = np.concatenate([[0], np.cumsum(used)])[seen[owner % len(seen)].offsets[1:]]
        offsets += (offsets[-1] + ends).tolist()
    return SparseWisardModel(
        encoder=encoder,
        classes=classes,
        mapping=mapping.astype(np.int32),
        offsets=np.array(offsets, dtype=np.int64),
        addresses=np.concatenate([kept for kept, _ in stored]),
        counts=np.concatenate([kept for _, kept in stored]).astype(np.int64),
        bleaching=bleaching,
        origin=origin or {},
    )


@dataclass(frozen=True, eq=False)
class _Seen:
    """The addresses that occur at the RAMs of one mapping, RAM after RAM.

    Attributes:
        addresses: uint64 ``[size]``, rising within each RAM.
        offsets: int64 ``[k + 1]``, where each RAM's begin.
        places: int64 ``[k, samples]``, where in ``addresses`` each sample's address stands.
    """

    addresses: NDArray[np.uint64]
    offsets: NDArray[np.int64]
    places: NDArray[np.int64]

    @property
    def size(self) -> int:
        """Addresses of all RAMs together."""
        return len(self.addresses)

    @classmethod
    def of(cls, where: NDArray[np.int64]) -> "_Seen":
        """The addresses in ``where``, int64 ``[k, samples]``, which are unsigned."""
        distinct, places = zip(*map(_distinct, where.view(np.uint64)), strict=True)
        offsets = np.concatenate([[0], np.cumsum([len(ram) for ram in distinct])])
        return cls(np.concatenate(distinct), offsets, np.stack(places) + offsets[:-1, np.newaxis])


def _distinct(ram: NDArray[np.uint64]) -> tuple[NDArray[np.uint64], NDArray[np.int64]]:
    """The addresses that occur, rising, and which of them each sample has."""
    highest = int(ram.max(initial=0))
    if highest >= MARKED_ADDRESSES:
        distinct, places = np.unique(ram, return_inverse=True)
        return distinct, places
    # Marking addresses takes a tenth of the time of sorting them.
    marked = np.zeros(highest + 1, dtype=np.bool_)
    marked[ram] = True
    return np.flatnonzero(marked).astype(np.uint64), (np.cumsum(marked) - 1)[ram]


def _choose_bleaching(seen: list[_Seen], counts: list[NDArray[np.int64]], owners: NDArray[np.int64]) -> int:
    """As `choose_bleaching_for_samples`, of counts by place in `_Seen.addresses`, one array a class."""
    thresholds = candidates(np.concatenate(counts))
    levels = [np.searchsorted(thresholds, count, side="right") for count in counts]
    without = [np.searchsorted(thresholds, count - 1, side="right") for count in counts]
    right = np.zeros(len(thresholds), dtype=np.int64)
    order = np.argsort(owners, kind="stable")
    bounds = np.searchsorted(owners[order], np.arange(len(counts) + 1))
    entries = max(len(seen[0].offsets), len(counts) * len(thresholds))
    for owner, (start, end) in enumerate(pairwise(bounds.tolist())):
        for part in chunks(end - start, entries):
            samples = order[start:end][part]
            silent = [
                silent_rams(
                    (without if other == owner else levels)[other][
                        seen[other % len(seen)].places[:, samples]
                    ],
                    len(thresholds),
                )
                for other in range(len(counts))
            ]
            right += np.count_nonzero(np.stack(silent).argmin(axis=0) == owner, axis=0)
    return int(thresholds[right.argmax()])
