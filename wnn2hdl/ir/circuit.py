"""The circuit: the one value between a model and its hardware.

A circuit has ports, nodes that are connected by words of bits, and care sets. A target is a function of
`wnn2hdl.lower` that returns one; every later stage loops over its nodes and knows no target.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.nodes import Leaf, Table
from wnn2hdl.ir.verilog_text import check_comment, check_identifier
from wnn2hdl.ir.wires import Bits, Port, Slice, Word, read_word, width_of


@dataclass(frozen=True)
class Care:
    """A word of a circuit and the values of it that matter."""

    word: Word
    allowed: CareSet


@dataclass(frozen=True, eq=False)
class Circuit:
    """Nodes between ports.

    Names can stand in Verilog as they are, and the summary as a comment; ValueError is raised for others.

    Attributes:
        name: of the circuit; in emitted Verilog its module is called ``PREFIX_name``.
        summary: one line that says what it computes.
        inputs: the input ports; the name of a port is the name of its net.
        nodes: in topological order.
        outputs: the output ports and the words that drive them.
        care: the values of words that matter; a word that is not named here is cared for altogether.
        carries: for signals of the model by number, the output bit or the constant that they are here: for
            bits of the encoder, or for tables of the last layer; the number of an exclusive or of the
            encoder's bits is their mask. To a proof this is a hint, which it proves.
    """

    name: str
    summary: str
    inputs: tuple[Port, ...]
    nodes: "tuple[Node, ...]"
    drivers: Mapping[str, Word]
    care: tuple[Care, ...] = ()
    carries: Mapping[int, Slice | bool] = field(default_factory=dict)

    def __post_init__(self) -> None:
        # Behind a prefix, a reserved word is an ordinary name.
        check_identifier(f"x_{self.name}")
        check_comment(self.summary)
        widths = {port.name: port.width for port in self.inputs}
        if len(widths) != len(self.inputs):
            raise ValueError(f"two inputs of {self.name} have one name")
        for node in self.nodes:
            check_identifier(node.name)
            for word in node.reads:
                self._check(word, widths, node.name)
            for net, width in node.drives.items():
                if net in widths:
                    raise ValueError(f"two drivers of {net} in {self.name}")
                widths[net] = width
        for port, word in self.drivers.items():
            self._check(word, widths, port)
            if port in widths:
                raise ValueError(f"{port} in {self.name} is an output and a net")
            Port(port, width_of(word))
        for care in self.care:
            self._check(care.word, widths, "the care set")
            if width_of(care.word) != care.allowed.width:
                raise ValueError(f"a care set of {care.allowed.width} bits is put on {care.word}")
        outputs = {port.name: port.width for port in self.outputs}
        for number, bit in self.carries.items():
            if isinstance(bit, Slice) and not 0 <= bit.low < bit.low + bit.width <= outputs.get(bit.net, 0):
                raise ValueError(f"{self.name} carries signal {number} in {bit}, which is not an output")

    def _check(self, word: Word, widths: Mapping[str, int], reader: str) -> None:
        if not word:
            raise ValueError(f"{reader} in {self.name} reads no bits")
        for part in word:
            if part.net not in widths:
                raise ValueError(f"{reader} in {self.name} reads {part.net} before it is driven")
            if part.width < 1 or part.low < 0 or part.low + part.width > widths[part.net]:
                raise ValueError(f"{reader} in {self.name} reads {part} of {widths[part.net]} bits")

    @cached_property
    def outputs(self) -> tuple[Port, ...]:
        """The output ports."""
        return tuple(Port(name, width_of(word)) for name, word in self.drivers.items())

    @property
    def widths(self) -> tuple[dict[str, int], dict[str, int]]:
        """Bits of each input port and of each output port, by name."""
        return {port.name: port.width for port in self.inputs}, {
            port.name: port.width for port in self.outputs
        }

    @cached_property
    def latency(self) -> int:
        """Cycles from inputs to outputs; 0 if the circuit is combinational.

        Raises:
            ValueError: the words that meet in a node, or the outputs, have different latencies.
        """
        arrival = {port.name: 0 for port in self.inputs}

        def common(words: tuple[Word, ...], reader: str) -> int:
            times = {arrival[part.net] for word in words for part in word}
            if len(times) > 1:
                raise ValueError(f"{reader} in {self.name} joins words of the latencies {sorted(times)}")
            return times.pop() if times else 0

        for node in self.nodes:
            time = common(node.reads, node.name) + node.latency
            arrival |= dict.fromkeys(node.drives, time)
        return common(tuple(self.drivers.values()), "an output")

    def evaluate(self, inputs: Mapping[str, Bits]) -> dict[str, Bits]:
        """The golden model: the outputs on every input, cared for or not.

        Args:
            inputs: for each input port its values, bool ``[samples, width]``.

        Returns:
            For each output port its values, bool ``[samples, width]``; of a pipeline those that leave it
            `latency` cycles later.
        """
        nets = {port.name: inputs[port.name] for port in self.inputs}
        for node in self.nodes:
            nets |= node.evaluate(tuple(read_word(nets, word) for word in node.reads))
        return {port: read_word(nets, word) for port, word in self.drivers.items()}

    def definitions(self) -> dict[str, "Circuit"]:
        """The circuit and all circuits inside it by name, each after those that it instantiates.

        Raises:
            ValueError: two different circuits have the same name.
        """
        found: dict[str, Circuit] = {}
        for node in self.nodes:
            if isinstance(node, Instance):
                for name, circuit in node.circuit.definitions().items():
                    if found.setdefault(name, circuit) is not circuit:
                        raise ValueError(f"two circuits are called {name}")
        if self.name in found:
            raise ValueError(f"{self.name} is inside itself")
        return found | {self.name: self}

    def tables(self) -> dict[str, Table]:
        """Every table of every definition by a name that is unique among them.

        A table that is alone in its circuit goes by the name of the circuit, all others by their own, or by
        both where two would be called alike.
        """
        tables = []
        for name, circuit in self.definitions().items():
            own = [node for node in circuit.nodes if isinstance(node, Table)]
            tables += [(name, node, len(own) == 1) for node in own]
        short = Counter(name if alone else node.name for name, node, alone in tables)
        return {
            (plain if short[plain] == 1 else f"{name}_{node.name}"): node
            for name, node, alone in tables
            for plain in [name if alone else node.name]
        }

    def rebuilt(self, change: Callable[["Circuit"], "Circuit"]) -> "Circuit":
        """The circuit with ``change`` applied to each definition once, innermost first."""
        done: dict[str, Circuit] = {}
        for name, circuit in self.definitions().items():
            nodes = tuple(
                replace(node, circuit=done[node.circuit.name]) if isinstance(node, Instance) else node
                for node in circuit.nodes
            )
            done[name] = change(replace(circuit, nodes=nodes))
        return done[self.name]


@dataclass(frozen=True, eq=False)
class Instance:
    """A circuit inside a circuit.

    Attributes:
        name: of the node; it drives the net ``name.port`` for each output port of the circuit.
        circuit: the circuit.
        inputs: the word that each input port of the circuit reads.
    """

    kind: ClassVar[str] = "instance"
    name: str
    circuit: Circuit
    inputs: Mapping[str, Word]

    def __post_init__(self) -> None:
        wanted = {port.name: port.width for port in self.circuit.inputs}
        given = {port: width_of(word) for port, word in self.inputs.items()}
        if wanted != given:
            raise ValueError(f"{self.name} connects {given}; {self.circuit.name} has the inputs {wanted}")

    @property
    def reads(self) -> tuple[Word, ...]:
        """See `Table.reads`; in the order of the circuit's input ports."""
        return tuple(self.inputs[port.name] for port in self.circuit.inputs)

    @property
    def drives(self) -> Mapping[str, int]:
        """See `Table.drives`."""
        return {f"{self.name}.{port.name}": port.width for port in self.circuit.outputs}

    @property
    def latency(self) -> int:
        """See `Table.latency`."""
        return self.circuit.latency

    def evaluate(self, values: tuple[Bits, ...]) -> dict[str, Bits]:
        """See `Table.evaluate`."""
        ports = (port.name for port in self.circuit.inputs)
        answers = self.circuit.evaluate(dict(zip(ports, values, strict=True)))
        return {f"{self.name}.{port}": bits for port, bits in answers.items()}


Node = Leaf | Instance
