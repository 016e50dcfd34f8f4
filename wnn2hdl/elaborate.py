# amaranth: UnusedElaboratable=no
"""From a circuit to an Amaranth component: each kind of node has its hardware here."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.adder import sum_network
from hdl_templates.counting import Counting
from hdl_templates.engine import MatchEngine
from hdl_templates.hierarchy import Part, place
from hdl_templates.ip import EngineIp, VideoIp
from hdl_templates.lookup import draw_network, unread_inputs
from hdl_templates.matcher import draw_match
from hdl_templates.ports import named, tie_off
from hdl_templates.video import Neighbours, VideoCore
from hdl_templates.winner import winner_network
from wnn2hdl.ir import Context, LutNetwork, Neighbourhood, Style, VideoFormat
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.registers import RegisterMap
from wnn2hdl.ir.wires import Word, single_bits, width_of

_FLIP_FLOPS = {"keep": "true", "shreg_extract": "no"}
"""Attributes that keep Yosys and Vivado (UG901) from making shift registers in LUTs of long delays: their
outputs stand 1.2 ns later after the clock's edge than those of flip-flops, which no schedule allows for."""


def component(circuit: Circuit, *, style: Style) -> "CircuitComponent":
    """The hardware of a circuit whose tables are mapped to LUTs.

    Args:
        circuit: the circuit.
        style: how its LUT networks are written.

    Raises:
        ValueError: words of different latencies meet; or, when it is elaborated, a table is not a LUT
            network.
    """
    return CircuitComponent(circuit=circuit, style=style)


def video_core(
    circuit: Circuit,
    video: VideoFormat,
    surroundings: Neighbourhood | Context | None,
    *,
    classes: int,
    style: Style,
) -> VideoCore:
    """The hardware of a video core.

    Args:
        circuit: the circuits of the core, see `wnn2hdl.lower.deforestation.video`.
        video: its streams.
        surroundings: what its model looks at around a pixel; None of a model of single pixels.
        classes: how many classes there are.
        style: how its LUT networks are written.
    """
    pixels, decisions, windows = (
        [
            component(node.circuit, style=style)
            for node in circuit.nodes
            if isinstance(node, Instance) and node.name == name
            for _ in range(video.pixels_per_clock)
        ]
        for name in ("classifier", "decision", "window")
    )
    neighbours: Neighbours | Counting | None = None
    if isinstance(surroundings, Neighbourhood):
        places = zip(surroundings.sources, surroundings.taps, strict=True)
        taps = [(source, tap.row, tap.column) for source, tap in places]
        neighbours = Neighbours(surroundings.size, taps, decisions)
    elif surroundings is not None:
        sums = [(surroundings.planes.index(plane), size) for plane, size in surroundings.sums]
        own, squares = ([one for one in sums if (one[1] > 1) == wide] for wide in (False, True))
        neighbours = Counting([bit for bit, _ in own], squares, decisions)
    return VideoCore(video=video, pixels=pixels, windows=windows, neighbours=neighbours, classes=classes)


def match_engine(circuit: Circuit, engine: EngineFormat, *, style: Style) -> MatchEngine:
    """The hardware of a match engine.

    Args:
        circuit: the circuit of a lane with its registers, see `wnn2hdl.lower.deforestation.engine`.
        engine: its sizes.
        style: how its LUT networks are written.
    """
    (lane,) = (node.circuit for node in circuit.nodes if isinstance(node, Instance))
    return MatchEngine(engine=engine, lane=lambda: component(lane, style=style))


def with_registers(core: Part, registers: RegisterMap) -> Part:
    """A video core or a match engine with its registers around it."""
    if isinstance(core, VideoCore):
        return VideoIp(core=core, registers=registers)
    assert isinstance(core, MatchEngine)
    return EngineIp(core=core, registers=registers)


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
        nets: dict[str, Value | list[Value]] = {
            port.name: getattr(self, port.name) for port in self.circuit.inputs
        }
        tables = sum(isinstance(node, Table) for node in self.circuit.nodes)
        scope = _Scope(m, self, platform, nets, tables == 1)
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
        nets: the value of each net that is driven so far, or those of its bits.
        has_one_table: whether the circuit has one table; its cells then go by short names.
    """

    m: Module
    part: CircuitComponent
    platform: object
    nets: dict[str, Value | list[Value]]
    has_one_table: bool

    def read(self, word: Word) -> Value:
        """The value of a word."""
        parts = [
            net[part.low : part.low + part.width] if isinstance(net, Value) else Cat(*self.bits((part,)))
            for part in word
            for net in [self.nets[part.net]]
        ]
        return parts[0] if len(parts) == 1 else Cat(*parts)

    def bits(self, word: Word) -> list[Value]:
        """The values of a word's bits; a slice of a `Cat` would take time with all that the `Cat` holds."""
        return [
            self.nets[part.net][place] for part in word for place in range(part.low, part.low + part.width)
        ]

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
        bits = single_bits(node.word)
        unread = set(unread_inputs(node.function))
        return (tuple(bit for position, bit in enumerate(bits) if position not in unread),)
    if isinstance(node, Threshold) and node.constant is not None:
        return ()
    return node.reads


def _table(scope: _Scope, node: Table) -> None:
    network = node.function
    if not isinstance(network, LutNetwork):
        raise ValueError(f"{node.name} is not mapped to LUTs")
    prefix = "" if scope.has_one_table else f"{node.name}_"
    bits = scope.bits(node.word)
    # Chosen bits of a port go by the names that the model has for them; a whole port has a name already.
    ports = scope.part.circuit.inputs
    if scope.has_one_table and not any(node.word == port.word for port in ports):
        places = [part.net for part in node.word for _ in range(part.width)]
        unread = set(unread_inputs(network))
        for position, (name, net) in enumerate(zip(network.inputs, places, strict=True)):
            if position not in unread and any(net == port.name for port in ports):
                bits[position] = named(scope.m, name, bits[position], scope.platform)
    outputs = draw_network(
        scope.m, network, bits, style=scope.part.style, prefix=prefix, platform=scope.platform
    )
    scope.nets[node.name] = outputs


def _threshold(scope: _Scope, node: Threshold) -> None:
    word = scope.read(node.word)
    value = word >= node.at_least if node.constant is None else Const(node.constant, 1)
    scope.nets[node.name] = named(scope.m, node.name, value, scope.platform)


def _sum(scope: _Scope, node: Sum) -> None:
    _draw(scope, node.name, sum_network(node.weights, node.offset, node.width), scope.bits(node.word))


def _match(scope: _Scope, node: Match) -> None:
    word, other = scope.read(node.word), scope.read(node.other)
    scope.nets[node.name] = draw_match(scope.m, word, other, name=node.name, platform=scope.platform)


def _argmax(scope: _Scope, node: ArgMax) -> None:
    network = winner_network(tuple(map(width_of, node.words)), tie=node.tie)
    _draw(scope, node.name, network, [bit for word in node.words for bit in scope.bits(word)])


def _draw(scope: _Scope, name: str, network: LutNetwork, bits: list[Value]) -> None:
    outputs = draw_network(
        scope.m, network, bits, style=scope.part.style, prefix=f"{name}_", platform=scope.platform
    )
    scope.nets[name] = outputs


def _register(scope: _Scope, node: Register) -> None:
    value = scope.read(node.word)
    for cycle in range(1, node.cycles + 1):
        name = node.name if cycle == node.cycles else f"{node.name}_{cycle}"
        stage = Signal(len(value), name=name, reset_less=True, attrs=_FLIP_FLOPS)
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
