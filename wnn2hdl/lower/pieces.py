"""Pieces of a network: tables, sums and winner become circuits of their own; a proof cuts at their ports.

Sums of equal weights are one circuit. What is between the pieces is wiring.
"""

from collections.abc import Mapping

from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.nodes import ArgMax, Sum, Table
from wnn2hdl.ir.wires import Port, Slice, single_bits, width_of

TABLES = "tables"
WINNER = "winner"


def divided(circuit: Circuit, carried: Mapping[int, Slice | bool]) -> Circuit:
    """A circuit of tables, of sums of their outputs, and of one winner, as a circuit of pieces.

    Args:
        circuit: has one input port and one output port, which the winner drives.
        carried: which net's bit, or which constant, is the output of which table of the model's last layer.
    """
    (port,) = circuit.inputs
    tables = [node for node in circuit.nodes if isinstance(node, Table)]
    sums = [node for node in circuit.nodes if isinstance(node, Sum)]
    (largest,) = (node for node in circuit.nodes if isinstance(node, ArgMax))
    read = list(dict.fromkeys(bit for node in sums for bit in single_bits(node.word)))
    votes = {bit: Slice("votes", place) for place, bit in enumerate(read)}
    carries = {
        number: bit if isinstance(bit, bool) else votes[bit]
        for number, bit in carried.items()
        if isinstance(bit, bool) or bit in votes
    }
    summary = f"{len(tables)} tables."
    first = Circuit(TABLES, summary, (port,), tuple(tables), {"votes": tuple(read)}, carries=carries)
    nodes: list[Node] = [Instance(TABLES, first, {port.name: port.word})]
    known: dict[tuple[tuple[int, ...], int], Circuit] = {}
    for node in sums:
        key = node.weights, node.offset
        if key not in known:
            known[key] = _sum(node, len(known))
        word = tuple(Slice(f"{TABLES}.votes", votes[bit].low) for bit in single_bits(node.word))
        nodes.append(Instance(node.name, known[key], {"bits": word}))
    widths = {net: width for node in nodes for net, width in node.drives.items()}
    words = {
        f"response_{number}": (Slice(f"{word[0].net}.total", 0, widths[f"{word[0].net}.total"]),)
        for number, word in enumerate(largest.words)
    }
    nodes.append(Instance(WINNER, winner(largest), words))
    ((output, word),) = circuit.drivers.items()
    drivers = {output: (Slice(f"{WINNER}.class_bits", 0, width_of(word)),)}
    return Circuit(circuit.name, circuit.summary, circuit.inputs, tuple(nodes), drivers)


def _sum(node: Sum, number: int) -> Circuit:
    bits = Port("bits", width_of(node.word))
    summary = f"Sum of {bits.width} bits"
    if set(node.weights) != {1}:
        summary += f" of the weights {min(node.weights)} to {max(node.weights)}"
    if node.offset:
        summary += f" and {node.offset}"
    added = Sum("sum", bits.word, node.weights, node.offset)
    total = (Slice("sum", 0, added.drives["sum"]),)
    return Circuit(f"sum_{number}", f"{summary}.", (bits,), (added,), {"total": total})


def winner(node: ArgMax) -> Circuit:
    """The circuit ``winner``: ``response_0`` and so on, as wide as the words of a node, to ``class_bits``."""
    ports = tuple(Port(f"response_{number}", width_of(word)) for number, word in enumerate(node.words))
    largest = ArgMax("largest", tuple(port.word for port in ports), node.tie)
    index = (Slice("largest", 0, largest.drives["largest"]),)
    summary = f"Index of the largest of {len(ports)} numbers."
    return Circuit(WINNER, summary, ports, (largest,), {"class_bits": index})
