"""Layers of sums of tables: what a node's edges add is parted into weighted bits, and one sum adds these.

Each layer is two circuits. The first adds; its totals are those of `wnn2hdl.ir.models.sums.Total`. The second
saturates them to the words that the next layer reads. The winner is a circuit, too; what is between these is
wiring.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS, TruthTable
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.models import SumLayer, TableSumModel
from wnn2hdl.ir.models.sums import Total
from wnn2hdl.ir.nodes import ArgMax, Sum, Table, Threshold
from wnn2hdl.ir.wires import Port, Slice, Word
from wnn2hdl.lower.addends import addends
from wnn2hdl.lower.pieces import WINNER, winner
from wnn2hdl.minimise.support import members, minimum_supports, restrict

NETWORK = "network"


def network(model: TableSumModel) -> Circuit:
    """The whole network: ``features`` to ``class_bits``, the index of the class in binary."""
    features = Port("features", model.width)
    nodes: list[Node] = []
    word = features.word
    for number, layer in enumerate(model.layers):
        adding = _adding(model, number)
        adds = Instance(f"adds_{number}", adding, {"words": word})
        totals = {port.name: (Slice(f"{adds.name}.{port.name}", 0, port.width),) for port in adding.outputs}
        saturating = _saturating(layer, number, model.totals[number])
        saturates = Instance(f"saturates_{number}", saturating, totals)
        nodes += [adds, saturates]
        ((net, width),) = saturates.drives.items()
        word = (Slice(net, 0, width),)
    size = model.layers[-1].output_bits
    words = (Slice(word[0].net, place * size, size) for place in range(len(model.classes)))
    responses = {f"response_{number}": (word,) for number, word in enumerate(words)}
    decides = Instance(WINNER, winner(ArgMax("largest", tuple(responses.values()), model.ties)), responses)
    summary = f"Network of {len(model.classes)} classes."
    ((net, width),) = decides.drives.items()
    drivers = {"class_bits": (Slice(net, 0, width),)}
    return Circuit(NETWORK, summary, (features,), (*nodes, decides), drivers)


def _adding(model: TableSumModel, number: int) -> Circuit:
    """The circuit ``layer_N``: the ``words`` of the layer before to the total of each node."""
    layer, occurring = model.layers[number], model.occurring(number)
    words = Port("words", len(occurring) * layer.input_bits)
    found = _Bits(layer.input_bits, occurring)
    sums = [found.sum(layer, node, total) for node, total in enumerate(model.totals[number])]
    edges = "1 edge" if len(layer.values) == 1 else f"{len(layer.values)} edges"
    drivers = {f"total_{node}": (Slice(each.name, 0, each.width),) for node, each in enumerate(sums)}
    summary = f"Sums of {layer.nodes} nodes with {edges}."
    return Circuit(f"layer_{number}", summary, (words,), (*found.tables, *sums), drivers)


@dataclass(eq=False)
class _Bits:
    """Bits that are added in a layer, each made once.

    Attributes:
        size: bits of a word.
        occurring: which codes of each word occur.
        tables: the tables made so far.
    """

    size: int
    occurring: Sequence[NDArray[np.bool_]]
    tables: list[Table] = field(default_factory=list)
    _known: dict[tuple[Word, bytes], tuple[Slice, bool]] = field(default_factory=dict)

    def sum(self, layer: SumLayer, node: int, total: Total) -> Sum:
        """The node that adds what all edges of a node give, and the offset of its total."""
        edges = range(*layer.edges(node).indices(len(layer.values)))
        sources = sorted(set(layer.sources[edges.start : edges.stop].tolist()))
        weights: Counter[Slice] = Counter()
        offset = total.offset
        # A node of few inputs is one table.
        joined = [sources] if len(sources) * self.size <= LUT_INPUTS else [[source] for source in sources]
        for group in filter(None, joined):
            word, care = self._word(group)
            values = np.zeros(len(care), dtype=np.int64)
            codes = np.arange(len(care))
            for edge in edges:
                if layer.sources[edge] in group:
                    place = self.size * group.index(layer.sources[edge])
                    values += layer.values[edge][codes >> place & (1 << self.size) - 1]
            parts = addends(values, care)
            offset += parts.constant
            for own, weight in zip(word, parts.weights, strict=True):
                weights[own] += weight
            for place, column in enumerate(parts.columns.T):
                bit, is_inverted = self._bit(word, column & care, ~column & care)
                # The inverse of a bit is 1 less the bit, and a set constant is the inverse of no bit.
                offset += is_inverted << place
                if bit is not None:
                    weights[bit] += -(1 << place) if is_inverted else 1 << place
        added = {bit: weight for bit, weight in weights.items() if weight}
        # A sum adds at least one bit, if only one that weighs nothing modulo its width.
        added = added or {Slice("words"): 1 << total.bits}
        return Sum(f"sum_{node}", tuple(added), tuple(added.values()), offset, total.bits)

    def _word(self, sources: Sequence[int]) -> tuple[Word, NDArray[np.bool_]]:
        """The bits of some words of the layer before side by side, and which of their codes occur."""
        care = np.ones(1, dtype=np.bool_)
        for source in sources:
            care = (self.occurring[source][:, np.newaxis] & care).reshape(-1)
        bits = [
            Slice("words", source * self.size + place) for source in sources for place in range(self.size)
        ]
        return tuple(bits), care

    def _bit(self, word: Word, on: NDArray[np.bool_], off: NDArray[np.bool_]) -> tuple[Slice | None, bool]:
        """The bit of a function of a word, None for a constant, and whether the function is its inverse."""
        if not on.any() or not off.any():
            return None, bool(on.any())
        support = minimum_supports(on, off)[0]
        read = tuple(word[position] for position in members(support))
        on, off = restrict(on, support), restrict(off, support)
        if len(read) == 1:
            return read[0], bool(on[0])
        key = np.packbits(np.stack([on, off])).tobytes()
        if (read, key) not in self._known:
            names = tuple(f"i{position}" for position in range(len(read)))
            function = TruthTable(names, ("o",), on[:, np.newaxis], on | off)
            self.tables.append(Table(f"bit_{len(self.tables)}", read, function))
            bit = Slice(self.tables[-1].name)
            inverse = np.packbits(np.stack([off, on])).tobytes()
            self._known[read, key] = bit, False
            self._known[read, inverse] = bit, True
        return self._known[read, key]


_MAX_TOP = 3
"""Bits of a total above its word that the table of each bit of the word reads itself."""


def _saturating(layer: SumLayer, number: int, totals: Sequence[Total]) -> Circuit:
    """The circuit ``saturation_N``: totals to the ``words`` that the next layer reads."""
    ports = tuple(Port(f"total_{node}", total.bits) for node, total in enumerate(totals))
    nodes: list[Node] = []
    word: list[Slice] = []
    for node, (port, total) in enumerate(zip(ports, totals, strict=True)):
        made, bits = _saturated(port, total, layer.output_bits, f"word_{node}")
        nodes += made
        word += bits
    summary = f"Words of {layer.output_bits} bits from {layer.nodes} totals."
    return Circuit(f"saturation_{number}", summary, ports, tuple(nodes), {"words": tuple(word)})


def _saturated(port: Port, total: Total, size: int, name: str) -> tuple[list[Node], list[Slice]]:
    """The nodes that saturate a total, and the bits of its word."""
    # Totals from `within` times 2**size to below the next multiple are those of sums in range.
    within = total.offset >> size
    top = Slice(port.name, size, port.width - size) if port.width > size else None
    nodes: list[Node] = []
    if top is None:
        select: Word = ()
    elif top.width <= _MAX_TOP:
        select = tuple(Slice(top.net, top.low + place) for place in range(top.width))
    else:
        nodes = [Threshold(f"{name}_least", (top,), within), Threshold(f"{name}_above", (top,), within + 1)]
        select, within = (Slice(f"{name}_least"), Slice(f"{name}_above")), 1
    bits: list[Slice] = []
    for place in range(size):
        own = (Slice(port.name, place),) if place < port.width else ()
        if own and not select and within == 0:
            bits += own
            continue
        read = (*own, *select) or (Slice(port.name),)
        codes = np.arange(1 << len(read))
        reads_own = codes & 1 if own else np.zeros_like(codes)
        level = codes >> len(own) if select else np.zeros_like(codes)
        values = np.where(level == within, reads_own == 1, level > within)
        names = tuple(f"i{position}" for position in range(len(read)))
        function = TruthTable.exact(names, ("o",), values[:, np.newaxis])
        nodes.append(Table(f"{name}_{place}", read, function))
        bits.append(Slice(nodes[-1].name))
    return nodes, bits
