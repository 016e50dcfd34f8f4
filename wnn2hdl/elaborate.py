# amaranth: UnusedElaboratable=no
"""From a circuit to an Amaranth component: each kind of node has its hardware here."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.compressor import Columns, add_columns
from hdl_templates.hierarchy import Part, place
from hdl_templates.lookup import draw_network, unread_inputs
from hdl_templates.matcher import draw_match
from hdl_templates.ports import named, tie_off
from hdl_templates.winner import draw_winner
from wnn2hdl.ir import LutNetwork, Style
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Slice, Word


def component(circuit: Circuit, *, style: Style) -> "CircuitComponent":
    """The hardware of a circuit whose tables are mapped to LUTs.

    Args:
        circuit: the circuit.
        style: how its LUT networks are written.

    Raises:
        ValueError: words of different latencies meet; or, when it is elaborated, a table is no LUT network.
    """
    return CircuitComponent(circuit=circuit, style=style)


class CircuitComponent(Part):
    """A circuit; its ports are those of the circuit, its latency is `Circuit.latency`.

    Args:
        circuit: the circuit.
        style: how its LUT networks are written.
    """

    def __init__(self, *, circuit: Circuit, style: Style) -> None:
        self.circuit = circuit
        self.style = style
        self.latency = circuit.latency
        self.module_name = circuit.name
        self.clocked = any(
            isinstance(node, Register)
            for definition in circuit.definitions().values()
            for node in definition.nodes
        )
        inputs = {port.name: In(port.width) for port in circuit.inputs}
        super().__init__(inputs | {port.name: Out(port.width) for port in circuit.outputs})

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        cycles = "1 cycle" if self.latency == 1 else f"{self.latency} cycles"
        return f"{self.circuit.summary} {f'Latency {cycles}' if self.latency else 'Combinational'}."

    def elaborate(self, platform: object) -> Module:
        """Draws the nodes one after the other."""
        m = Module()
        scope = _Scope(
            m, self, platform, {port.name: getattr(self, port.name) for port in self.circuit.inputs}
        )
        for node in self.circuit.nodes:
            _HARDWARE[type(node)](scope, node)
        m.d.comb += [getattr(self, port).eq(scope.read(word)) for port, word in self.circuit.drivers.items()]
        tie_off(m, scope.unread_bits(), platform)
        return m


@dataclass
class _Scope:
    """A module under construction.

    Attributes:
        m: the module.
        part: the component that it belongs to.
        platform: what it is elaborated for.
        nets: the value of each net that is driven so far.
    """

    m: Module
    part: CircuitComponent
    platform: object
    nets: dict[str, Value]

    def read(self, word: Word) -> Value:
        """The value of a word."""
        parts = [self.nets[part.net][part.low : part.low + part.width] for part in word]
        return parts[0] if len(parts) == 1 else Cat(*parts)

    def unread_bits(self) -> list[Value]:
        """Bits of nets that no node and no output reads."""
        circuit = self.part.circuit
        read: dict[str, set[int]] = {net: set() for net in self.nets}
        words = [word for node in circuit.nodes for word in _read_words(node)]
        for part in (part for word in [*words, *circuit.drivers.values()] for part in word):
            read[part.net].update(range(part.low, part.low + part.width))
        return [
            value[bit]
            for net, value in self.nets.items()
            for bit in range(len(value))
            if bit not in read[net]
        ]


def _read_words(node: Node) -> tuple[Word, ...]:
    """The words whose bits the hardware of a node reads; a function may ignore some of its inputs."""
    if isinstance(node, Table) and isinstance(node.function, LutNetwork):
        bits = [Slice(part.net, part.low + i) for part in node.word for i in range(part.width)]
        unread = set(unread_inputs(node.function))
        return (tuple(bit for position, bit in enumerate(bits) if position not in unread),)
    if isinstance(node, Threshold) and node.constant is not None:
        return ()
    return node.reads


def _table(scope: _Scope, node: Table) -> None:
    network = node.function
    if not isinstance(network, LutNetwork):
        raise ValueError(f"{node.name} is not mapped to LUTs")
    circuit = scope.part.circuit
    ports = {port.name: port for port in circuit.inputs}
    alone = sum(isinstance(other, Table) for other in circuit.nodes) == 1
    prefix = "" if alone else f"{node.name}_"
    bits = list(scope.read(node.word))
    # Chosen bits of a port go by the names that the model has for them; a whole port has a name already.
    if not any(node.word == port.word for port in circuit.inputs):
        places = [part.net for part in node.word for _ in range(part.width)]
        unread = set(unread_inputs(network))
        for position, (name, net) in enumerate(zip(network.inputs, places, strict=True)):
            if net in ports and position not in unread:
                bits[position] = named(scope.m, f"{prefix}{name}", bits[position], scope.platform)
    outputs = draw_network(
        scope.m, network, bits, style=scope.part.style, prefix=prefix, platform=scope.platform
    )
    scope.nets[node.name] = Cat(*outputs)


def _threshold(scope: _Scope, node: Threshold) -> None:
    word = scope.read(node.word)
    value = word >= node.at_least if node.constant is None else Const(node.constant, 1)
    scope.nets[node.name] = named(scope.m, node.name, value, scope.platform)


def _sum(scope: _Scope, node: Sum) -> None:
    columns: Columns = {}
    for bit, weight in zip(scope.read(node.word), node.weights, strict=True):
        for power in range(weight.bit_length()):
            if weight >> power & 1:
                columns.setdefault(power, []).append(bit)
    for power in range(node.offset.bit_length()):
        if node.offset >> power & 1:
            columns.setdefault(power, []).append(Const(1, 1))
    total = add_columns(scope.m, columns, node.drives[node.name], name=node.name, platform=scope.platform)
    scope.nets[node.name] = Cat(*total)


def _match(scope: _Scope, node: Match) -> None:
    word, other = scope.read(node.word), scope.read(node.other)
    scope.nets[node.name] = draw_match(scope.m, word, other, name=node.name, platform=scope.platform)


def _argmax(scope: _Scope, node: ArgMax) -> None:
    words = [scope.read(word) for word in node.words]
    scope.nets[node.name] = draw_winner(scope.m, words, tie=node.tie, name=node.name)


def _register(scope: _Scope, node: Register) -> None:
    value = scope.read(node.word)
    for cycle in range(1, node.cycles + 1):
        name = node.name if cycle == node.cycles else f"{node.name}_{cycle}"
        stage = Signal(len(value), name=name, reset_less=True)
        scope.m.d.sync += stage.eq(value)
        value = stage
    scope.nets[node.name] = value


def _instance(scope: _Scope, node: Instance) -> None:
    part = component(node.circuit, style=scope.part.style)
    place(scope.m, node.name, part, scope.platform)
    scope.m.d.comb += [getattr(part, port).eq(scope.read(word)) for port, word in node.inputs.items()]
    for port in node.circuit.outputs:
        scope.nets[f"{node.name}.{port.name}"] = getattr(part, port.name)


_HARDWARE: Mapping[type[Node], Callable[[_Scope, Any], None]] = {
    Table: _table,
    Threshold: _threshold,
    Sum: _sum,
    Match: _match,
    ArgMax: _argmax,
    Register: _register,
    Instance: _instance,
}
