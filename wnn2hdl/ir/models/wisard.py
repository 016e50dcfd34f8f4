"""A WiSARD over any number of bits: RAMs that store the addresses they have seen, and no others."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.encoder import Encoder, encoder_from_json
from wnn2hdl.ir.modelfile import header, pack, unpack
from wnn2hdl.ir.models.base import (
    ClassifierModel,
    FirstOrLast,
    addresses,
    check_classes,
    check_mapping,
    in_chunks,
)

MAX_ADDRESS_BITS = 64


@dataclass(frozen=True)
class Dynamic:
    """Bleaching whose threshold rises from 1 for each sample until the answer is clear.

    It rises while the highest response is above 1 and not clear of the others. Classes are looked at in
    order: one that is higher than all before it is clear for now; a later one that is less than
    ``confidence`` below the highest so far makes the answer unclear again. With a confidence of 1 that is:
    while the highest response is shared.

    Attributes:
        confidence: how far below the highest a later class has to stay, at least 1.
    """

    confidence: int = 1

    def __post_init__(self) -> None:
        if self.confidence < 1:
            raise ValueError(f"the confidence is {self.confidence}; the lowest is 1")


@dataclass(frozen=True, eq=False)
class SparseWisardModel(ClassifierModel):
    """A WiSARD with one discriminator per class, each of ``k`` RAMs with ``n`` address bits, at most 64.

    A RAM fires if the count at its address reaches the bleaching threshold; a discriminator's response is how
    many of its RAMs fire. An address that a RAM does not store has a count of 0 and never fires; that is also
    how a model ignores address 0. A RAM with fewer inputs reads `wnn2hdl.ir.models.base.ZERO` at the others.

    Attributes:
        encoder: what turns features, or a pixel, into the input bits.
        classes: class names.
        mapping: int32 ``[m, k, n]``, indices of input bits or ZERO, which may repeat; ``m`` is 1 (all classes
            share it) or the number of classes. Entry 0 of the last axis is the least significant address bit.
        offsets: int64 ``[classes * k + 1]``: RAM ``r`` of class ``c`` stores entries ``offsets[i]`` to
            ``offsets[i + 1] - 1`` with ``i = c * k + r``.
        addresses: uint64 ``[entries]``, rising within each RAM.
        counts: int64 ``[entries]``, how often each was seen in training, at least 1.
        bleaching: the threshold, at least 1, or how it is found for each sample.
        ties: which of several highest classes wins.
        origin: where the model comes from.
    """

    kind: ClassVar[str] = "sparse-wisard"
    encoder: Encoder
    classes: tuple[str, ...]
    mapping: NDArray[np.int32]
    offsets: NDArray[np.int64]
    addresses: NDArray[np.uint64]
    counts: NDArray[np.int64]
    bleaching: int | Dynamic
    ties: FirstOrLast = "first"
    origin: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_classes(self.classes)
        if self.mapping.ndim != 3 or self.mapping.shape[0] not in (1, len(self.classes)) or not self.rams:
            raise ValueError(f"the mapping has shape {self.mapping.shape}; it must be [1 or classes, k, n]")
        if not 1 <= self.address_bits <= MAX_ADDRESS_BITS:
            raise ValueError(f"a RAM has 1 to {MAX_ADDRESS_BITS} address bits, not {self.address_bits}")
        check_mapping(self.mapping, self.width)
        if isinstance(self.bleaching, int) and self.bleaching < 1:
            raise ValueError(f"the bleaching threshold is {self.bleaching}; the lowest is 1")
        self._check_contents()

    def _check_contents(self) -> None:
        rams, entries = len(self.classes) * self.rams, len(self.addresses)
        starts = self.offsets
        if (
            starts.shape != (rams + 1,)
            or starts[0] != 0
            or starts[-1] != entries
            or (np.diff(starts) < 0).any()
        ):
            raise ValueError(f"the offsets do not share {entries} entries among {rams} RAMs")
        if self.counts.shape != self.addresses.shape or self.counts.min(initial=1) < 1:
            raise ValueError("there must be a count of at least 1 for each address")
        if entries and int(self.addresses.max()) >> self.address_bits:
            raise ValueError(f"address {self.addresses.max()} does not fit {self.address_bits} bits")
        rising = self.addresses[1:] > self.addresses[:-1]
        # Between the last entry of a RAM and the first of the next nothing has to rise.
        seams = starts[1:-1][(starts[1:-1] > 0) & (starts[1:-1] < entries)] - 1
        rising[seams] = True
        if not rising.all():
            raise ValueError("the addresses of a RAM do not rise")

    @property
    def rams(self) -> int:
        """k, the RAMs of a discriminator."""
        return int(self.mapping.shape[1])

    @property
    def address_bits(self) -> int:
        """n, the address bits of a RAM."""
        return int(self.mapping.shape[2])

    def contents(self, owner: int, ram: int) -> tuple[NDArray[np.uint64], NDArray[np.int64]]:
        """Addresses and counts that RAM ``ram`` of class ``owner`` stores."""
        at = owner * self.rams + ram
        here = slice(int(self.offsets[at]), int(self.offsets[at + 1]))
        return self.addresses[here], self.counts[here]

    def votes(self, bits: ArrayLike) -> NDArray[np.int64]:
        """The count at each RAM's address: bits ``[samples, width]`` give int64 ``[samples, classes, k]``."""
        cells = len(self.classes) * self.rams
        return in_chunks(bits, self.width, 16 * cells, lambda rows: np.moveaxis(self._votes(rows), 2, 0))

    def responses(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Firing RAMs of each discriminator at the threshold that decides: int64 ``[samples, classes]``."""
        cells = len(self.classes) * self.rams
        return in_chunks(
            bits, self.width, 16 * cells + self.width, lambda rows: self._bleached(self._votes(rows))
        )

    def to_json(self) -> dict[str, Any]:
        """The model file's object."""
        return {
            **header(self.kind),
            "encoder": self.encoder.to_json(),
            "classes": list(self.classes),
            "mapping": pack(self.mapping),
            "offsets": pack(self.offsets),
            "addresses": pack(self.addresses),
            "counts": pack(self.counts),
            "bleaching": {"threshold": self.bleaching}
            if isinstance(self.bleaching, int)
            else {"confidence": self.bleaching.confidence},
            "ties": self.ties,
            "origin": dict(self.origin),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        bleaching = data["bleaching"]
        return cls(
            encoder=encoder_from_json(data["encoder"]),
            classes=tuple(data["classes"]),
            mapping=unpack(data["mapping"], np.int32, 3),
            offsets=unpack(data["offsets"], np.int64, 1),
            addresses=unpack(data["addresses"], np.uint64, 1),
            counts=unpack(data["counts"], np.int64, 1),
            bleaching=bleaching["threshold"]
            if "threshold" in bleaching
            else Dynamic(bleaching["confidence"]),
            ties=data["ties"],
            origin=data["origin"],
        )

    def _votes(self, rows: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Counts for bits ``[width, samples]``: int64 ``[classes, k, samples]``."""
        votes = np.zeros((len(self.classes), self.rams, rows.shape[1]), dtype=np.int64)
        for group, mapping in enumerate(self.mapping):
            owners = range(len(self.classes)) if len(self.mapping) == 1 else (group,)
            seen = addresses(rows, mapping, np.uint64)
            for ram in range(self.rams):
                for owner in owners:
                    stored, counts = self.contents(owner, ram)
                    if len(stored):
                        at = np.minimum(np.searchsorted(stored, seen[ram]), len(stored) - 1)
                        votes[owner, ram] = np.where(stored[at] == seen[ram], counts[at], 0)
        return votes

    def _bleached(self, votes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Responses ``[samples, classes]`` of votes ``[classes, k, samples]``."""
        if isinstance(self.bleaching, int):
            return np.asarray((votes >= self.bleaching).sum(axis=1).T)
        responses = np.asarray((votes >= 1).sum(axis=1).T)
        open_samples = np.arange(votes.shape[2])
        threshold = np.ones(votes.shape[2], dtype=np.int64)
        while True:
            unclear = _unclear(responses[open_samples], self.bleaching.confidence)
            open_samples = open_samples[unclear]
            if not len(open_samples):
                return responses
            here = votes[:, :, open_samples]
            firing = np.where(here >= threshold[open_samples], here, np.iinfo(np.int64).max)
            # No response changes before the threshold passes the lowest count that still fires.
            threshold[open_samples] = firing.min(axis=(0, 1)) + 1
            responses[open_samples] = (here >= threshold[open_samples]).sum(axis=1).T


def _unclear(responses: NDArray[np.int64], confidence: int) -> NDArray[np.bool_]:
    """Samples whose threshold has to rise (see `Dynamic`): bool of responses ``[samples, classes]``."""
    highest = np.zeros(len(responses), dtype=np.int64)
    unclear = np.zeros(len(responses), dtype=np.bool_)
    for response in responses.T:
        higher = response > highest
        unclear = ~higher & (unclear | (highest - response < confidence))
        highest = np.maximum(highest, response)
    return unclear & (highest > 1)
