"""A WiSARD whose RAMs are Bloom filters (BTHOWeN)."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.encoder import encoder_from_json
from wnn2hdl.ir.features import FeatureEncoder
from wnn2hdl.ir.modelfile import header, pack, unpack
from wnn2hdl.ir.models.base import (
    ClassifierModel,
    FirstOrLast,
    check_classes,
    check_mapping,
    in_chunks,
    with_zero,
)

MAX_ENTRY_BITS = 20


@dataclass(frozen=True, eq=False)
class BloomWisardModel(ClassifierModel):
    """A WiSARD whose RAMs are Bloom filters with H3 hashes, shared by all classes.

    Hash ``h`` of a filter is the exclusive or of ``hashes[h, j]`` over its inputs ``j`` that are set. A
    filter fires if its entries at all hashes are set; a discriminator's response is how many of its filters
    fire. The lowest class index wins ties.

    Attributes:
        encoder: what turns features into the input bits.
        classes: class names.
        mapping: int32 ``[filters, n]``, indices of input bits, or `wnn2hdl.ir.models.base.ZERO` where the
            inputs were padded; all classes share it.
        hashes: uint32 ``[hashes, n]``, each below ``entries``.
        contents: bool ``[classes, filters, entries]``, ``entries`` a power of two: counts compared with the
            bleaching threshold already.
        origin: where the model comes from.
    """

    kind: ClassVar[str] = "bloom-wisard"
    encoder: FeatureEncoder
    classes: tuple[str, ...]
    mapping: NDArray[np.int32]
    hashes: NDArray[np.uint32]
    contents: NDArray[np.bool_]
    origin: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_classes(self.classes)
        if self.mapping.ndim != 2 or not self.mapping.size:
            raise ValueError(f"the mapping has shape {self.mapping.shape}; it must be [filters, n]")
        check_mapping(self.mapping, self.width)
        filters, inputs = self.mapping.shape
        if self.hashes.ndim != 2 or not len(self.hashes) or self.hashes.shape[1] != inputs:
            raise ValueError(
                f"the hashes have shape {self.hashes.shape}; the mapping asks for [hashes, {inputs}]"
            )
        if self.contents.shape[:2] != (len(self.classes), filters):
            raise ValueError(f"the contents have shape {self.contents.shape}; there are {filters} filters")
        entries = self.contents.shape[2]
        if not 2 <= entries <= 1 << MAX_ENTRY_BITS or entries & (entries - 1):
            raise ValueError(
                f"a filter has a power of two of entries up to 2**{MAX_ENTRY_BITS}, not {entries}"
            )
        if self.hashes.max() >= entries:
            raise ValueError(f"hash constant {self.hashes.max()} is not an index of {entries} entries")

    @property
    def ties(self) -> FirstOrLast:
        """The lowest class index wins."""
        return "first"

    def responses(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Firing filters of each discriminator: int64 ``[samples, classes]``."""
        cells = len(self.mapping) * (len(self.classes) + 16)
        return in_chunks(bits, self.width, cells + 4 * self.width, self._responses)

    def _responses(self, rows: NDArray[np.bool_]) -> NDArray[np.int64]:
        fires = np.ones((len(self.classes), len(self.mapping), rows.shape[1]), dtype=np.bool_)
        filters = np.arange(len(self.mapping))[:, np.newaxis]
        for constants in self.hashes:
            fires &= self.contents[:, filters, hashed(rows, self.mapping, constants)]
        return np.asarray(fires.sum(axis=1, dtype=np.int64).T)

    def to_json(self) -> dict[str, Any]:
        """The model file's object."""
        return {
            **header(self.kind),
            "encoder": self.encoder.to_json(),
            "classes": list(self.classes),
            "mapping": pack(self.mapping),
            "hashes": pack(self.hashes),
            "contents": pack(self.contents),
            "origin": dict(self.origin),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        return cls(
            encoder=encoder_from_json(data["encoder"]),  # type: ignore[arg-type]  # the schema allows no other
            classes=tuple(data["classes"]),
            mapping=unpack(data["mapping"], np.int32, 2),
            hashes=unpack(data["hashes"], np.uint32, 2),
            contents=unpack(data["contents"], np.bool_, 3),
            origin=data["origin"],
        )


def hashed(
    rows: NDArray[np.bool_], mapping: NDArray[np.int32], constants: NDArray[np.uint32]
) -> NDArray[np.uint32]:
    """One hash of every filter: bits ``[width, samples]`` give uint32 ``[filters, samples]``."""
    inputs = with_zero(rows)
    result = np.zeros((len(mapping), rows.shape[1]), dtype=np.uint32)
    for slot, constant in enumerate(constants):
        result ^= inputs[mapping[:, slot]] * constant
    return result
