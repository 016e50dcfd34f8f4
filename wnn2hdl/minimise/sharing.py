"""Sharing and dropping: tables lose inputs that do not matter, equal tables become one, constants go.

Inputs that cannot occur, such as a thermometer with a hole, are don't-cares here even where a circuit has to
equal its model on every input.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from wnn2hdl.ir import TruthTable
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.circuit import Circuit, Node
from wnn2hdl.ir.nodes import ArgMax, Sum, Table
from wnn2hdl.ir.wires import Slice, Word, single_bits
from wnn2hdl.minimise.support import members, minimum_supports, restrict

Bit = Slice | bool
"""What a bit turned out to be: a bit of a net, or a constant."""


@dataclass(frozen=True, eq=False)
class Shared:
    """A circuit after sharing.

    Attributes:
        circuit: reads of its one input port only what is left.
        read: which bits of the port of the circuit before these are, ascending.
        found: what became of a net of one bit that is no more: another net's bit, a bit of the port, or a
            constant.
    """

    circuit: Circuit
    read: tuple[int, ...]
    found: Mapping[str, Bit]


def share(circuit: Circuit, care: CareSet, known: dict[int, bool | int]) -> Shared:
    """Simplify a circuit of tables of one output, sums and further nodes over one input port.

    Args:
        circuit: its tables are truth tables.
        care: what can occur on the port.
        known: bits of the port that are constant, or equal to another bit of it.
    """
    (port,) = circuit.inputs
    alias: dict[Slice, Bit] = {}
    for position, value in known.items():
        alias[Slice(port.name, position)] = value if isinstance(value, bool) else Slice(port.name, value)
    seen: dict[tuple[tuple[Slice, ...], bytes], Slice] = {}
    nodes: list[Node] = []
    for node in circuit.nodes:
        if (
            isinstance(node, Table)
            and isinstance(node.function, TruthTable)
            and len(node.function.outputs) == 1
        ):
            bits = [alias.get(bit, bit) for bit in single_bits(node.word)]
            simple = _simplified(bits, node.function, port.name, care)
            if not isinstance(simple, tuple):
                alias[Slice(node.name)] = simple
            elif simple in seen:
                alias[Slice(node.name)] = seen[simple]
            else:
                seen[simple] = Slice(node.name)
                nodes.append(_table(node, *simple))
        elif isinstance(node, Sum):
            nodes += _sum(node, alias, Slice(port.name))
        elif isinstance(node, ArgMax):
            widths = {net: width for other in nodes for net, width in other.drives.items()}
            words = tuple((Slice(word[0].net, 0, widths[word[0].net]),) for word in node.words)
            nodes.append(replace(node, words=words))
        else:
            nodes.append(node)
    return _without_unread(circuit, nodes, alias)


def _simplified(
    bits: list[Bit], function: TruthTable, port: str, care: CareSet
) -> Bit | tuple[tuple[Slice, ...], bytes]:
    """A constant, a bit, or the different bits that a table reads and its contents."""
    inputs = tuple(dict.fromkeys(bit for bit in bits if isinstance(bit, Slice)))
    codes = np.arange(1 << len(inputs))
    address = np.zeros(len(codes), dtype=np.int64)
    for slot, bit in enumerate(bits):
        value = np.full(len(codes), int(bit)) if isinstance(bit, bool) else codes >> inputs.index(bit) & 1
        address |= value << slot
    values = function.values[address, 0]
    cared = function.care[address]
    from_port = tuple(i for i, bit in enumerate(inputs) if bit.net == port)
    allowed = care.project(tuple(inputs[i].low for i in from_port))
    part = np.zeros(len(codes), dtype=np.int64)
    for slot, i in enumerate(from_port):
        part |= (codes >> i & 1) << slot
    cared = cared & allowed[part]
    on, off = values & cared, ~values & cared
    if not off.any():
        return True
    if not on.any():
        return False
    support = minimum_supports(on, off)[0]
    kept = tuple(inputs[position] for position in members(support))
    on, off = restrict(on, support), restrict(off, support)
    if len(kept) == 1 and on.tolist() == [False, True]:
        return kept[0]
    return kept, np.packbits(np.stack([on, off])).tobytes()


def _table(node: Table, inputs: tuple[Slice, ...], packed: bytes) -> Table:
    size = 1 << len(inputs)
    flags = np.unpackbits(np.frombuffer(packed, np.uint8), count=2 * size).astype(np.bool_).reshape(2, size)
    names = tuple(f"i{position}" for position in range(len(inputs)))
    function = TruthTable(names, ("fires",), flags[0][:, np.newaxis], flags[0] | flags[1])
    return Table(node.name, inputs, function)


def _sum(node: Sum, alias: dict[Slice, Bit], any_bit: Slice) -> list[Node]:
    """Constants become an offset, and a bit that is added twice weighs twice.

    Of a sum of constants alone the last one stays a bit: a table that does not read its one input,
    ``any_bit``.
    """
    constants = [alias.get(bit, bit) for bit in single_bits(node.word)]
    if all(isinstance(found, bool) for found in constants):
        function = TruthTable.exact(("any",), ("fires",), np.full((2, 1), constants[-1]))
        last = Table(f"{node.name}_last", (any_bit,), function)
        alias[single_bits(node.word)[-1]] = Slice(last.name)
        return [last, *_sum(node, alias, any_bit)]
    weights: Counter[Slice] = Counter()
    offset = node.offset
    for bit, weight in zip(single_bits(node.word), node.weights, strict=True):
        found = alias.get(bit, bit)
        if isinstance(found, bool):
            offset += weight * found
        else:
            weights[found] += weight
    return [replace(node, word=tuple(weights), weights=tuple(weights.values()), offset=offset)]


def _without_unread(circuit: Circuit, nodes: list[Node], alias: Mapping[Slice, Bit]) -> Shared:
    """Nodes that lead to an output, the bits of the port that they read, and what the others became."""
    (port,) = circuit.inputs
    needed = {bit.net for word in circuit.drivers.values() for bit in word}
    kept: list[Node] = []
    for node in reversed(nodes):
        if needed & node.drives.keys():
            kept.append(node)
            needed |= {bit.net for word in node.reads for bit in word}
    kept.reverse()
    read = sorted(
        {bit.low for node in kept for word in node.reads for bit in single_bits(word) if bit.net == port.name}
    )
    place = {position: i for i, position in enumerate(read)}

    def placed(bit: Slice) -> Slice:
        return Slice(bit.net, place[bit.low]) if bit.net == port.name else bit

    def moved(word: Word) -> Word:
        return tuple(map(placed, single_bits(word)))

    moved_nodes = [
        replace(node, word=moved(node.word)) if isinstance(node, Table | Sum) else node for node in kept
    ]
    result = replace(
        circuit, inputs=(replace(port, width=max(len(read), 1)),), nodes=tuple(moved_nodes), care=()
    )
    driven = {net for node in kept for net in node.drives}
    found: dict[str, Bit] = {
        gone.net: bit if isinstance(bit, bool) else placed(bit)
        for gone, bit in alias.items()
        if gone.net != port.name
        and (isinstance(bit, bool) or bit.net in driven or (bit.net == port.name and bit.low in place))
    }
    return Shared(result, tuple(read), found)
