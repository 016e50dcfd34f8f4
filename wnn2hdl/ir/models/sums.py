"""Networks whose nodes are sums of tables of one word each (KANELÉ)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.encoder import encoder_from_json
from wnn2hdl.ir.features import FeatureEncoder
from wnn2hdl.ir.modelfile import header, pack, unpack
from wnn2hdl.ir.models.base import ClassifierModel, FirstOrLast, check_classes, in_chunks

MAX_WORD_BITS = 16

_MAX_LISTED = 1 << 20
"""The widest range of sums whose values are told apart; of a wider one all values count as possible."""


@dataclass(frozen=True, eq=False)
class Total:
    """The sums of a node before they saturate, as hardware counts them.

    Attributes:
        lowest: no sum is lower, whatever the input.
        highest: no sum is higher.
        offset: what is added to a sum, so that the total is not negative. The lowest ``output_bits`` bits of
            the total of a sum in the node's range are the address that the next layer reads.
        codes: bool ``[2**output_bits]``, which addresses may occur.
    """

    lowest: int
    highest: int
    offset: int
    codes: NDArray[np.bool_]

    @property
    def bits(self) -> int:
        """Bits of a total, at least 1."""
        return max((self.highest + self.offset).bit_length(), 1)


@dataclass(frozen=True, eq=False)
class SumLayer:
    """Nodes side by side: each adds up what its edges read in their tables, and saturates the sum.

    Attributes:
        nodes: how many; one without edges is 0.
        output_bits: bits of a node's value, in two's complement: a sum beyond their range takes the nearest
            value in it.
        sources: int32 ``[edges]``, the word of the layer before that an edge reads.
        targets: int32 ``[edges]``, the node that it adds to, none lower than the one before.
        values: int32 ``[edges, 2**input_bits]``, what it adds for each address. The address is the word
            itself in the first layer, whose words count from 0, and in others the value plus
            ``2**(input_bits - 1)``.
    """

    nodes: int
    output_bits: int
    sources: NDArray[np.int32]
    targets: NDArray[np.int32]
    values: NDArray[np.int32]

    def __post_init__(self) -> None:
        if self.nodes < 1 or not 1 <= self.output_bits <= MAX_WORD_BITS:
            raise ValueError(f"no layer: {self.nodes} nodes of {self.output_bits} bits")
        if (
            self.values.ndim != 2
            or self.values.shape[1] != 1 << self.input_bits
            or self.input_bits > MAX_WORD_BITS
        ):
            raise ValueError(f"the values have shape {self.values.shape}; it must be [edges, power of two]")
        if not self.sources.shape == self.targets.shape == (len(self.values),):
            raise ValueError("every edge needs a source, a target and values")
        if self.targets.size and not 0 <= self.targets.min() <= self.targets.max() < self.nodes:
            raise ValueError(f"an edge ends at a node that does not exist; there are {self.nodes}")
        if self.sources.min(initial=0) < 0:
            raise ValueError("an edge reads a word before the first")
        if (np.diff(self.targets) < 0).any():
            raise ValueError("the edges are not in the order of their targets")

    @property
    def input_bits(self) -> int:
        """Bits of a word that an edge reads."""
        return max(0, int(self.values.shape[1]) - 1).bit_length()

    @property
    def lowest(self) -> int:
        """The lowest value of a node; the highest is ``-lowest - 1``."""
        return -(1 << (self.output_bits - 1))

    def edges(self, node: int) -> slice:
        """The edges that end at a node."""
        first, last = np.searchsorted(self.targets, [node, node + 1])
        return slice(int(first), int(last))

    def evaluate(self, words: NDArray[np.int64]) -> NDArray[np.int64]:
        """Values of all nodes: addresses ``[sources, samples]`` give int64 ``[nodes, samples]``."""
        result = np.zeros((self.nodes, words.shape[1]), dtype=np.int64)
        for node in range(self.nodes):
            for edge in range(*self.edges(node).indices(len(self.values))):
                result[node] += self.values[edge][words[self.sources[edge]]]
        return np.clip(result, self.lowest, -self.lowest - 1)

    def totals(self, reachable: Sequence[NDArray[np.bool_]]) -> tuple[Total, ...]:
        """What the nodes can add up to, if words take the codes in these: bool ``[2**input_bits]`` each.

        Words count as independent of one another, so that there may be a sum that no input has.
        """
        return tuple(self._total(self.edges(node), reachable) for node in range(self.nodes))

    def _total(self, edges: slice, reachable: Sequence[NDArray[np.bool_]]) -> Total:
        added = [
            np.unique(values[reachable[source]])
            for source, values in zip(self.sources[edges], self.values[edges].astype(np.int64), strict=True)
        ]
        lowest, highest = (int(sum(values[end] for values in added)) for end in (0, -1))
        span = 1 << self.output_bits
        offset = -self.lowest + span * max(0, -(-(self.lowest - lowest) // span))
        if highest - lowest < _MAX_LISTED:
            sums = np.ones(1, dtype=np.bool_)
            for values in added:
                wider = np.zeros(len(sums) + int(values[-1] - values[0]), dtype=np.bool_)
                for step in (values - values[0]).tolist():
                    wider[step : step + len(sums)] |= sums
                sums = wider
            found = lowest + np.flatnonzero(sums)
        else:
            found = np.arange(max(lowest, self.lowest), min(highest, -self.lowest - 1) + 1)
            found = np.append(found, [lowest, highest])
        codes = np.zeros(span, dtype=np.bool_)
        codes[np.clip(found, self.lowest, -self.lowest - 1) - self.lowest] = True
        return Total(lowest, highest, offset, codes)


@dataclass(frozen=True, eq=False)
class TableSumModel(ClassifierModel):
    """Layers of sums of tables; the class of the highest value wins, the lowest class index among equals.

    Attributes:
        encoder: what turns features into the input bits; the first layer takes ``layers[0].input_bits`` of
            them as a word, the first the least significant.
        classes: class names, one per node of the last layer.
        layers: the first reads words of the input bits, each later one the nodes of the one before.
        origin: where the model comes from.
    """

    kind: ClassVar[str] = "table-sums"
    encoder: FeatureEncoder
    classes: tuple[str, ...]
    layers: tuple[SumLayer, ...]
    origin: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_classes(self.classes)
        if not self.layers or self.layers[-1].nodes != len(self.classes):
            raise ValueError("the last layer needs a node for each class")
        bits, words = self.layers[0].input_bits, 0
        if bits and self.width % bits == 0:
            words = self.width // bits
        if not words:
            raise ValueError(f"{self.width} input bits do not make words of {bits} bits")
        for layer in self.layers:
            if layer.input_bits != bits:
                raise ValueError(
                    f"a layer reads words of {layer.input_bits} bits; the one before gives {bits}"
                )
            if layer.sources.max(initial=0) >= words:
                raise ValueError(f"an edge reads word {layer.sources.max()}; there are {words}")
            bits, words = layer.output_bits, layer.nodes

    @property
    def ties(self) -> FirstOrLast:
        """The lowest class index wins."""
        return "first"

    @property
    def words(self) -> int:
        """Words of input bits."""
        return self.width // self.layers[0].input_bits

    @cached_property
    def totals(self) -> tuple[tuple[Total, ...], ...]:
        """By layer, what its nodes can add up to."""
        found: list[tuple[Total, ...]] = []
        for number, layer in enumerate(self.layers):
            occurring = [total.codes for total in found[-1]] if number else self.occurring(0)
            found.append(layer.totals(occurring))
        return tuple(found)

    def occurring(self, number: int) -> list[NDArray[np.bool_]]:
        """Which addresses may occur on each word that a layer reads, bool ``[2**input_bits]`` each."""
        if number == 0:
            return [np.ones(1 << self.layers[0].input_bits, dtype=np.bool_)] * self.words
        return [total.codes for total in self.totals[number - 1]]

    def responses(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Values of the last layer, saturated: int64 ``[samples, classes]``."""
        nodes = self.words + 3 * max(layer.nodes for layer in self.layers)
        return in_chunks(bits, self.width, 8 * nodes + 9 * self.width, self._responses)

    def _responses(self, rows: NDArray[np.bool_]) -> NDArray[np.int64]:
        digits = rows.reshape(self.words, -1, rows.shape[1]).astype(np.int64)
        words = (digits << np.arange(digits.shape[1])[:, np.newaxis]).sum(axis=1)
        for layer in self.layers:
            values = layer.evaluate(words)
            words = values - layer.lowest
        return values.T

    def to_json(self) -> dict[str, Any]:
        """The model file's object."""
        layers = [
            {
                "nodes": layer.nodes,
                "output_bits": layer.output_bits,
                "sources": pack(layer.sources),
                "targets": pack(layer.targets),
                "values": pack(layer.values),
            }
            for layer in self.layers
        ]
        return {
            **header(self.kind),
            "encoder": self.encoder.to_json(),
            "classes": list(self.classes),
            "layers": layers,
            "origin": dict(self.origin),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        layers = (
            SumLayer(
                nodes=layer["nodes"],
                output_bits=layer["output_bits"],
                sources=unpack(layer["sources"], np.int32, 1),
                targets=unpack(layer["targets"], np.int32, 1),
                values=unpack(layer["values"], np.int32, 2),
            )
            for layer in data["layers"]
        )
        return cls(
            encoder=encoder_from_json(data["encoder"]),  # type: ignore[arg-type]  # the schema allows no other
            classes=tuple(data["classes"]),
            layers=tuple(layers),
            origin=data["origin"],
        )
