"""A circuit taken apart into the cells between which registers can stand."""

from collections.abc import Iterator, Sequence

from hdl_templates.adder import sum_network
from hdl_templates.matcher import match_network
from hdl_templates.winner import winner_network
from wnn2hdl.ir import CONSTANTS, Lut, LutNetwork, Mux
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table
from wnn2hdl.ir.wires import Word, single_bits, width_of

WHOLE = ""
"""Stands for the name of a cell where a node is not taken apart."""

Key = tuple[str, str]
"""A node and one of its cells: the name of a LUT or multiplexer, one of `CONSTANTS`, or `WHOLE`."""

Source = tuple[str, str | int]
"""What drives a bit: the key of a cell; or a net that a whole node or a port drives, and the bit of it."""


def network_of(node: Node) -> LutNetwork | None:
    """The LUTs that a node becomes; None of a node that stays whole.

    Raises:
        ValueError: a table is not mapped to LUTs, or the node is a register.
    """
    match node:
        case Table(function=LutNetwork() as network):
            return network
        case Table():
            raise ValueError(f"{node.name} is not mapped to LUTs")
        case Register():
            raise ValueError(f"{node.name} is a register already")
        case Sum(weights=weights, offset=offset, width=width):
            return sum_network(weights, offset, width)
        case ArgMax(words=words, tie=tie):
            return winner_network(tuple(map(width_of, words)), tie=tie)
        case Match(word=word):
            return match_network(width_of(word))
        case _:
            return None


class Logic:
    """The cells of one definition and what they read; cells on which no output depends are left out.

    Attributes:
        circuit: the definition.
        nodes: by name.
        networks: the LUT networks of the nodes that have one.
        cells: the look-up tables and multiplexers among the cells, by key.
        reads: for each cell what it reads, in topological order; of an instance all of its input ports.
        outputs: for each output port what drives its bits.
    """

    def __init__(self, circuit: Circuit) -> None:
        self.circuit = circuit
        self.nodes = {node.name: node for node in circuit.nodes}
        self.networks = {
            node.name: network for node in circuit.nodes if (network := network_of(node)) is not None
        }
        self._roots: dict[str, list[Source]] = {
            port.name: [(port.name, bit) for bit in range(port.width)] for port in circuit.inputs
        }
        self._owners = {net: node.name for node in circuit.nodes for net in node.drives}
        self.cells: dict[Key, Lut | Mux] = {}
        self.reads: dict[Key, tuple[Source, ...]] = {}
        for node in circuit.nodes:
            self._add(node)
        self.outputs = {port: self.sources(word) for port, word in circuit.drivers.items()}
        self._drop_unread()

    def sources(self, word: Word) -> tuple[Source, ...]:
        """What drives the bits of a word."""
        return tuple(self._roots[bit.net][bit.low] for bit in single_bits(word))

    def driver(self, source: Source) -> Key | None:
        """The cell that drives a bit; None of a bit of an input port."""
        owner, part = source
        if isinstance(part, str):
            return owner, part
        return (self._owners[owner], WHOLE) if owner in self._owners else None

    def names_of(self, node: Node) -> list[str]:
        """The names of a node's cells."""
        return [cell for owner, cell in self.reads if owner == node.name]

    def inputs_of(self, node: Node) -> tuple[Source, ...]:
        """What drives the bits that a node reads, word after word."""
        return tuple(source for word in node.reads for source in self.sources(word))

    def _add(self, node: Node) -> None:
        bits = self.inputs_of(node)
        network = self.networks.get(node.name)
        if network is None:
            self.reads[node.name, WHOLE] = bits
            self._roots |= {net: [(net, bit) for bit in range(n)] for net, n in node.drives.items()}
            return
        self.cells |= {(node.name, cell.name): cell for cell in network.cells}
        signals: dict[str, Source] = dict(zip(network.inputs, bits, strict=True))
        for name, reads in _reads(network):
            # A constant is as good in any stage, but a table reads something.
            self.reads[node.name, name] = tuple(signals[x] for x in reads) or bits[:1]
            signals[name] = (node.name, name)
        self._roots[node.name] = [signals[signal] for _, signal in network.outputs]

    def _drop_unread(self) -> None:
        needed = {self.driver(source) for word in self.outputs.values() for source in word}
        for key, reads in reversed(self.reads.items()):
            if key in needed or isinstance(self.nodes[key[0]], Instance):
                needed |= {key, *map(self.driver, reads)}
        self.reads = {key: reads for key, reads in self.reads.items() if key in needed}


def _reads(network: LutNetwork) -> Iterator[tuple[str, Sequence[str]]]:
    """The cells of a network and what they read; a constant output is a cell that reads nothing."""
    yield from ((constant, ()) for constant in CONSTANTS if constant in dict(network.outputs).values())
    yield from ((cell.name, cell.reads) for cell in network.cells)
