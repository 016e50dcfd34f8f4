"""Which stage each cell is in: an integer program, solved by HiGHS.

Variables are the stages of cells and instances, counted from those of their definition's inputs; the latency
of each definition; and for each bit the last stage in which it is needed. A cell is in no earlier stage than
what it reads. Two cells of a path that is longer than a stage are in different ones. The multiplexers of a
slice are in the stage of their LUTs. What is minimised is the latency, or the bits of all registers.

Where each definition occurs once, all constraints are on differences of two stages of the circuit, and the
vertices of the linear program are integers by themselves. Integrality is asked for because of those that
occur more often, such as nine pixels, whose cells have one schedule for all.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array

from wnn2hdl.ir import CONSTANTS
from wnn2hdl.ir.circuit import Instance
from wnn2hdl.ir.network import Mux
from wnn2hdl.schedule.logic import Logic, Source
from wnn2hdl.schedule.stages import Place, Stages
from wnn2hdl.schedule.timing import Paths


@dataclass(frozen=True)
class _Stage:
    """The stage of a cell or an instance."""

    place: Place


@dataclass(frozen=True)
class _Last:
    """The last stage in which a bit of a definition is needed."""

    definition: str
    source: Source


@dataclass(frozen=True)
class _Latency:
    """The latency of a definition."""

    definition: str


_Variable = _Stage | _Last | _Latency


@dataclass(frozen=True)
class _Row:
    """A constraint: ``later`` is the sum ``earlier`` and ``gap`` at least."""

    later: tuple[_Variable, ...]
    earlier: tuple[_Variable, ...]
    gap: int = 0


class Program:
    """The program of a circuit, for any period.

    Args:
        paths: of the circuit.
    """

    def __init__(self, paths: Paths) -> None:
        self._paths = paths
        self._top = _Latency(paths.circuit.name)
        # What leaves the circuit comes out of registers.
        self._rows = [_Row((self._top,), (), 1)]
        self._rows += [_Row((self._top,), _stages(paths.cells[end].places), 1) for end in paths.ends]
        self._costs: Counter[_Variable] = Counter()
        for name, logic in paths.logics.items():
            self._constrain(name, logic)

    def least_latency(self, period: int) -> int | None:
        """The fewest cycles that a period in picoseconds allows; None if it is too short for any number."""
        found = self._solve(period, {self._top: 1})
        return None if found is None else found.latencies[self._top.definition]

    def fewest_registers(self, period: int, latency: int) -> Stages:
        """The stages whose registers have the fewest bits.

        Args:
            period: in picoseconds.
            latency: of the circuit; at least `least_latency` of the period.
        """
        exactly = _Row((self._top,), (), latency), _Row((), (self._top,), -latency)
        found = self._solve(period, self._costs, *exactly)
        assert found is not None
        return found

    def _constrain(self, name: str, logic: Logic) -> None:
        """Add what holds inside a definition."""
        latency = _Latency(name)
        for key, reads in logic.reads.items():
            stage = _Stage((name, key))
            for source in dict.fromkeys(reads):
                self._needed(name, logic, source, stage)
            node = logic.nodes[key[0]]
            if isinstance(node, Instance):
                # Also of one that nothing reads.
                self._rows.append(_Row((latency,), (stage, _Latency(node.circuit.name))))
            match logic.cells.get(key):
                case Mux(low=low, high=high):
                    self._rows += [_Row((_Stage((name, (key[0], x))),), (stage,)) for x in (low, high)]
        for source in dict.fromkeys(source for bits in logic.outputs.values() for source in bits):
            self._needed(name, logic, source, latency)

    def _needed(self, name: str, logic: Logic, source: Source, when: _Variable) -> None:
        """Add that a bit is needed at a time."""
        ready, last = self._ready(name, logic, source), _Last(name, source)
        self._rows += [_Row((when,), ready), _Row((last,), (when,))]
        if last not in self._costs and not (isinstance(source[1], str) and source[1] in CONSTANTS):
            self._costs[last] = self._paths.uses[name]
            self._costs.subtract(dict.fromkeys(ready, self._paths.uses[name]))

    def _ready(self, name: str, logic: Logic, source: Source) -> tuple[_Variable, ...]:
        """The stage in which a bit is driven, as a sum."""
        key = logic.driver(source)
        if key is None:
            return ()
        node, stage = logic.nodes[key[0]], _Stage((name, key))
        return (stage, _Latency(node.circuit.name)) if isinstance(node, Instance) else (stage,)

    def _solve(self, period: int, costs: Mapping[_Variable, int], *more: _Row) -> Stages | None:
        """The cheapest solution; None if there is none."""
        apart = (
            _Row(_stages(later.places), _stages(first.places), 1)
            for first, later in self._paths.too_far(period)
        )
        # Rows that say the same, such as those of nine pixels, are one: the highest bound for these terms.
        bounds: dict[frozenset[tuple[_Variable, int]], int] = {}
        for row in (*self._rows, *apart, *more):
            terms = Counter(row.later)
            terms.subtract(row.earlier)
            key = frozenset((variable, factor) for variable, factor in terms.items() if factor)
            bounds[key] = max(bounds.get(key, row.gap), row.gap)
        index = {x: i for i, x in enumerate(dict.fromkeys([*self._variables(), *costs]))}
        entries = [
            (row, index[variable], factor) for row, terms in enumerate(bounds) for variable, factor in terms
        ]
        rows, columns, factors = np.array(entries).T
        matrix = csr_array((factors, (rows, columns)), shape=(len(bounds), len(index)))
        objective = np.zeros(len(index))
        for variable, cost in costs.items():
            objective[index[variable]] = cost
        result = milp(
            objective,
            constraints=LinearConstraint(matrix, lb=np.array(list(bounds.values()))),
            integrality=np.ones(len(index), dtype=np.uint8),
            bounds=Bounds(0, np.inf),
        )
        if result.x is None:
            return None
        values = {x: round(float(result.x[i])) for x, i in index.items()}
        places = {x.place: value for x, value in values.items() if isinstance(x, _Stage)}
        latencies = {x.definition: value for x, value in values.items() if isinstance(x, _Latency)}
        return Stages(places, latencies, self._paths.slowest(places))

    def _variables(self) -> Iterator[_Variable]:
        for row in self._rows:
            yield from (*row.later, *row.earlier)


def _stages(places: Iterable[Place]) -> tuple[_Variable, ...]:
    return tuple(map(_Stage, places))
