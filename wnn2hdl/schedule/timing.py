"""The paths of a circuit, through all of its instances."""

import heapq
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from wnn2hdl.ir import CONSTANTS
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.network import Mux
from wnn2hdl.ir.wires import width_of
from wnn2hdl.schedule.delays import Delays
from wnn2hdl.schedule.logic import WHOLE, Key, Logic, Source
from wnn2hdl.schedule.stages import Place

Origin = int | None
"""The number of the cell that drives a bit; None of an input."""


@dataclass(frozen=True)
class Cell:
    """A cell of an instance.

    Attributes:
        places: the instances that it is in, outermost first, and itself. Its stage is the sum of theirs.
        start: from the clock's edge until its output stands if it is the first in its stage, in picoseconds.
        reads: the cells that it reads by number, each with the picoseconds from their output to its own.
    """

    places: tuple[Place, ...]
    start: int
    reads: tuple[tuple[int, int], ...]


class Paths:
    """All cells of a circuit and the ways between them.

    Attributes:
        circuit: the circuit.
        delays: of its cells.
        logics: its definitions by name, innermost first.
        cells: those of all instances, in topological order.
        ends: numbers of the cells that drive the circuit's outputs.
        uses: how often each definition occurs.
    """

    def __init__(self, circuit: Circuit, delays: Delays) -> None:
        self.circuit, self.delays = circuit, delays
        self.logics = {name: Logic(definition) for name, definition in circuit.definitions().items()}
        self.cells: list[Cell] = []
        self.uses = dict.fromkeys(self.logics, 0)
        inputs: dict[str, list[Origin]] = {port.name: [None] * port.width for port in circuit.inputs}
        outputs = self._add(circuit.name, (), inputs)
        self.ends = frozenset(cell for bits in outputs.values() for cell in bits if cell is not None)

    def periods(self) -> list[int]:
        """Every length that a path from edge to edge can have, ascending, in picoseconds."""
        found: list[frozenset[int]] = []
        for cell in self.cells:
            through = (length + delay for other, delay in cell.reads for length in found[other])
            found.append(frozenset((cell.start, *through)))
        lengths = {length for at_cell in found for length in at_cell} or {self.delays.register}
        return sorted(length + self.delays.setup for length in lengths)

    def too_far(self, period: int) -> Iterator[tuple[Cell, Cell]]:
        """Pairs of a cell and a later one that cannot be in the same stage of a period in picoseconds.

        What reads the later one is in no earlier stage, so that it is not listed too.
        """
        limit = period - self.delays.setup
        readers: list[list[tuple[int, int]]] = [[] for _ in self.cells]
        for number, cell in enumerate(self.cells):
            for other, delay in cell.reads:
                readers[other].append((number, delay))
        for first, cell in enumerate(self.cells):
            arrival, waiting = {first: cell.start}, [first]
            while waiting:
                number = heapq.heappop(waiting)
                if arrival[number] > limit:
                    yield cell, self.cells[number]
                    continue
                for reader, delay in readers[number]:
                    if reader not in arrival:
                        heapq.heappush(waiting, reader)
                    arrival[reader] = max(arrival.get(reader, 0), arrival[number] + delay)

    def slowest(self, stages: Mapping[Place, int]) -> int:
        """The longest path from edge to edge, in picoseconds, of cells in given stages."""
        own = [sum(stages[place] for place in cell.places) for cell in self.cells]
        arrival: list[int] = []
        for cell, stage in zip(self.cells, own, strict=True):
            through = (arrival[x] + delay for x, delay in cell.reads if own[x] == stage)
            arrival.append(max(cell.start, *through, 0))
        return max(arrival, default=self.delays.register) + self.delays.setup

    def _add(
        self, name: str, above: tuple[Place, ...], inputs: Mapping[str, Sequence[Origin]]
    ) -> dict[str, list[Origin]]:
        """Add the cells of an instance of a definition; return what drives its outputs."""
        logic = self.logics[name]
        self.uses[name] += 1
        origins: dict[Source, Origin] = {
            (port, bit): origin for port, bits in inputs.items() for bit, origin in enumerate(bits)
        }
        for key, reads in logic.reads.items():
            node, places = logic.nodes[key[0]], (*above, (name, key))
            known = [origins[source] for source in reads]
            if isinstance(node, Instance):
                starts = dict(
                    zip((port.name for port in node.circuit.inputs), _parted(known, node), strict=True)
                )
                for port, bits in self._add(node.circuit.name, places, starts).items():
                    origins |= {(f"{node.name}.{port}", bit): cell for bit, cell in enumerate(bits)}
            else:
                source: Source = (node.name, 0) if key[1] == WHOLE else key
                origins[source] = len(self.cells)
                self.cells.append(self._cell(logic, key, places, known))
        return {port: [origins[source] for source in bits] for port, bits in logic.outputs.items()}

    def _cell(self, logic: Logic, key: Key, places: tuple[Place, ...], known: Sequence[Origin]) -> Cell:
        delays, name = self.delays, key[1]
        if name in CONSTANTS:
            return Cell(places, 0, ())
        if name == WHOLE:
            through = [delays.net + delays.comparison(len(known))] * len(known)
        elif isinstance(logic.cells[key], Mux):
            through = [delays.mux_data, delays.mux_data, delays.net + delays.mux_select]
        else:
            through = [delays.net + delays.lut] * len(known)
        reads = {(origin, delay) for origin, delay in zip(known, through, strict=True) if origin is not None}
        return Cell(places, delays.register + through[-1], tuple(sorted(reads)))


def _parted(bits: Sequence[Origin], node: Instance) -> Iterator[Sequence[Origin]]:
    """The bits that an instance reads, port by port."""
    start = 0
    for word in node.reads:
        yield bits[start : start + width_of(word)]
        start += width_of(word)
