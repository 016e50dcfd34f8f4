"""Putting registers into a circuit where a schedule says so."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import islice

from wnn2hdl.ir import CONSTANTS, LutNetwork
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.nodes import Register, Table, Threshold
from wnn2hdl.ir.wires import Slice, Word, width_of
from wnn2hdl.schedule.logic import WHOLE, Logic, Source
from wnn2hdl.schedule.stages import Stages

_CONSTANT_NAMES = dict(zip(CONSTANTS, ("zero", "one"), strict=True))


def pipelined(circuit: Circuit, stages: Stages) -> Circuit:
    """The circuit with registers: equal to it, its latency later.

    Sums, winners and matches that stand in a definition with registers become the tables that they are made
    of, those of each stage by themselves. All bits that pass from one stage to the next go through one
    register. Care sets are not passed on: they are about bits that may now be of different stages.

    Args:
        circuit: its tables are mapped to LUTs.
        stages: where registers are.

    Raises:
        KeyError: a cell has no stage, or something is needed before it is there.
    """

    def change(definition: Circuit) -> Circuit:
        latency = stages.latencies[definition.name]
        definition = replace(definition, care=())
        return _Staged(definition, stages, latency).circuit() if latency else definition

    return circuit.rebuilt(change)


class _Staged:
    """A definition under construction, stage after stage.

    Args:
        definition: the definition; the circuits of its instances have their registers already.
        stages: where registers are.
        latency: of the definition, at least 1.
    """

    def __init__(self, definition: Circuit, stages: Stages, latency: int) -> None:
        self._definition, self._latency = definition, latency
        self._logic = logic = Logic(definition)
        self._stage = {key: stages.places[definition.name, key] for key in logic.reads}
        # For each bit the last stage that it is needed in, and whether anything but its own table needs it.
        self._last: dict[Source, int] = {}
        self._shared: set[Source] = set()
        for key, reads in logic.reads.items():
            for source in reads:
                self._last[source] = max(self._last.get(source, 0), self._stage[key])
                driver = logic.driver(source)
                if driver is None or (driver[0], self._stage[driver]) != (key[0], self._stage[key]):
                    self._shared.add(source)
        for bits in logic.outputs.values():
            self._last |= dict.fromkeys(bits, latency)
            self._shared.update(bits)
        self._names = {node.name for node in definition.nodes} | {port.name for port in definition.inputs}
        self._nodes: list[Node] = []
        # Where each bit is in the stage under construction, and what leaves instances in later ones.
        self._bits: dict[Source, Slice] = {
            (port.name, bit): Slice(port.name, bit) for port in definition.inputs for bit in range(port.width)
        }
        self._later: defaultdict[int, dict[Source, Slice]] = defaultdict(dict)

    def circuit(self) -> Circuit:
        """The definition with its registers; raises KeyError where something is needed before it is there."""
        cells: defaultdict[int, defaultdict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
        for (owner, cell), stage in self._stage.items():
            cells[stage][owner].append(cell)
        for stage in range(self._latency + 1):
            if stage:
                self._register(stage)
            self._bits |= self._later[stage]
            for name, names in cells[stage].items():
                node = self._logic.nodes[name]
                if names == [WHOLE]:
                    self._keep(node, stage)
                else:
                    self._split(node, names, stage)
        drivers = {port: self._word(bits) for port, bits in self._logic.outputs.items()}
        return replace(self._definition, nodes=tuple(self._nodes), drivers=drivers)

    def _register(self, stage: int) -> None:
        """Bring what is needed from a stage on into it."""
        passed = [source for source in self._bits if self._last.get(source, 0) >= stage]
        if passed:
            name = self._name(f"stage_{stage}")
            self._nodes.append(Register(name, self._word(passed)))
            self._bits = {source: Slice(name, position) for position, source in enumerate(passed)}

    def _keep(self, node: Node, stage: int) -> None:
        """Add a node that is not taken apart."""
        bits = iter(self._logic.reads[node.name, WHOLE])
        words = [self._word(islice(bits, width_of(word))) for word in node.reads]
        match node:
            case Instance(circuit=circuit):
                ports = (port.name for port in circuit.inputs)
                node = replace(node, inputs=dict(zip(ports, words, strict=True)))
            case Threshold():
                node = replace(node, word=words[0])
        self._nodes.append(node)
        driven: dict[Source, Slice] = {
            (net, bit): Slice(net, bit) for net, width in node.drives.items() for bit in range(width)
        }
        self._later[stage + node.latency] |= driven
        if not node.latency:
            self._bits |= driven

    def _split(self, node: Node, names: Sequence[str], stage: int) -> None:
        """Add those cells of a node that are in a stage, as a table."""
        network, own = self._logic.networks[node.name], set(names)
        reads: dict[str, Source] = {}
        for name in names:
            cell = self._logic.cells.get((node.name, name))
            signals = network.inputs[:1] if cell is None else cell.reads
            reads |= dict(zip(signals, self._logic.reads[node.name, name], strict=True))
        inputs = {signal: source for signal, source in reads.items() if signal not in own}
        outputs = [name for name in names if (node.name, name) in self._shared]
        part = LutNetwork(
            tuple(inputs),
            tuple(cell for cell in network.cells if cell.name in own),
            tuple((_CONSTANT_NAMES.get(name, name), name) for name in outputs),
        )
        is_whole = all(self._stage[node.name, name] == stage for name in self._logic.names_of(node))
        net = node.name if is_whole else self._name(f"{node.name}_{stage}")
        self._nodes.append(Table(net, self._word(inputs.values()), part))
        self._bits |= {(node.name, name): Slice(net, position) for position, name in enumerate(outputs)}

    def _name(self, wanted: str) -> str:
        """A name that nothing else has."""
        while wanted in self._names:
            wanted += "x"
        self._names.add(wanted)
        return wanted

    def _word(self, sources: Iterable[Source]) -> Word:
        """Bits side by side, as few slices as can be."""
        word: list[Slice] = []
        for source in sources:
            bit = self._bits[source]
            last = word[-1] if word else None
            if last is not None and (last.net, last.low + last.width) == (bit.net, bit.low):
                word[-1] = replace(last, width=last.width + 1)
            else:
                word.append(bit)
        return tuple(word)
