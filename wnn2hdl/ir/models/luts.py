"""Networks of look-up tables whose last layer is counted class by class (DWN)."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.encoder import encoder_from_json
from wnn2hdl.ir.features import FeatureEncoder
from wnn2hdl.ir.modelfile import header, pack, unpack
from wnn2hdl.ir.models.base import (
    ClassifierModel,
    FirstOrLast,
    addresses,
    check_classes,
    check_mapping,
    in_chunks,
)

MAX_NODE_INPUTS = 16


@dataclass(frozen=True, eq=False)
class LutLayer:
    """Nodes side by side, each a table of ``n`` outputs of the layer before.

    Attributes:
        mapping: int32 ``[nodes, n]``; slot 0 is the least significant address bit. An input may repeat.
        tables: bool ``[nodes, 2**n]``, the answer at each address.
    """

    mapping: NDArray[np.int32]
    tables: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if self.mapping.ndim != 2 or not self.mapping.size or self.mapping.shape[1] > MAX_NODE_INPUTS:
            raise ValueError(
                f"the mapping has shape {self.mapping.shape}; it must be [nodes, 1 to {MAX_NODE_INPUTS}]"
            )
        nodes, inputs = self.mapping.shape
        if self.tables.shape != (nodes, 1 << inputs):
            raise ValueError(
                f"the tables have shape {self.tables.shape}; the mapping asks for {(nodes, 1 << inputs)}"
            )

    @property
    def nodes(self) -> int:
        """Nodes of the layer."""
        return len(self.mapping)

    def evaluate(self, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Answers of all nodes: bits ``[inputs, samples]`` give bool ``[nodes, samples]``."""
        return self.tables[np.arange(self.nodes)[:, np.newaxis], addresses(rows, self.mapping, np.uint16)]


@dataclass(frozen=True, eq=False)
class LutGroupModel(ClassifierModel):
    """Layers of look-up tables; each node of the last votes for one class, and the most votes win.

    The lowest class index wins ties.

    Attributes:
        encoder: what turns features into the input bits.
        classes: class names.
        layers: the first reads the input bits, each later one the nodes of the one before.
        groups: int32 ``[nodes of the last layer]``, the class index that each votes for.
        origin: where the model comes from.
    """

    kind: ClassVar[str] = "lut-groups"
    encoder: FeatureEncoder
    classes: tuple[str, ...]
    layers: tuple[LutLayer, ...]
    groups: NDArray[np.int32]
    origin: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_classes(self.classes)
        if not self.layers:
            raise ValueError("a network needs at least one layer")
        for width, layer in zip(self.widths, self.layers, strict=False):
            check_mapping(layer.mapping, width)
            if layer.mapping.min() < 0:
                raise ValueError("a node reads an input before the first")
        if self.groups.shape != (self.layers[-1].nodes,):
            raise ValueError(f"{len(self.groups)} nodes vote; the last layer has {self.layers[-1].nodes}")
        if self.groups.min() < 0 or self.groups.max() >= len(self.classes):
            raise ValueError("a node votes for a class that does not exist")

    @property
    def ties(self) -> FirstOrLast:
        """The lowest class index wins."""
        return "first"

    @property
    def widths(self) -> tuple[int, ...]:
        """Input bits, then the nodes of each layer."""
        return (self.width, *(layer.nodes for layer in self.layers))

    def node_bits(self, bits: ArrayLike) -> NDArray[np.bool_]:
        """Answers of the last layer: bits ``[samples, width]`` give bool ``[samples, nodes]``."""
        bytes_each = 2 * self.width + max(8 * after + 2 * before for before, after in pairwise(self.widths))
        return in_chunks(bits, self.width, bytes_each, self._node_bits)

    def _node_bits(self, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
        for layer in self.layers:
            rows = layer.evaluate(rows)
        return rows.T

    def responses(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Votes for each class: int64 ``[samples, classes]``."""
        nodes = self.node_bits(bits)
        votes = [
            nodes[:, self.groups == owner].sum(axis=1, dtype=np.int64) for owner in range(len(self.classes))
        ]
        return np.stack(votes, axis=1)

    def to_json(self) -> dict[str, Any]:
        """The model file's object."""
        return {
            **header(self.kind),
            "encoder": self.encoder.to_json(),
            "classes": list(self.classes),
            "layers": [
                {"mapping": pack(layer.mapping), "tables": pack(layer.tables)} for layer in self.layers
            ],
            "groups": pack(self.groups),
            "origin": dict(self.origin),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        layers = (
            LutLayer(unpack(layer["mapping"], np.int32, 2), unpack(layer["tables"], np.bool_, 2))
            for layer in data["layers"]
        )
        return cls(
            encoder=encoder_from_json(data["encoder"]),  # type: ignore[arg-type]  # the schema allows no other
            classes=tuple(data["classes"]),
            layers=tuple(layers),
            groups=unpack(data["groups"], np.int32, 1),
            origin=data["origin"],
        )
