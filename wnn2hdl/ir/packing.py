"""Which look-up tables share a LUT6_2: two that read at most five different signals between them."""

from collections.abc import Container, Hashable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from wnn2hdl.ir.network import Lut, LutNetwork

SHARED_INPUTS = 5
"""Signals that the two functions of a LUT6_2 may read between them (Xilinx UG953)."""


_MANY = 5_000
"""Tables above which only those of one level are paired: of two such none leads to the other, so that no
graph is searched."""

_LOOKED_AT = 16
"""Readers of a signal, and tables of a size, that a table of so many looks at."""


@dataclass(frozen=True)
class Gate:
    """A cell as far as packing is concerned.

    Attributes:
        reads: the signals that it reads; constants are none.
        drives: the signals that it drives.
        is_lut: whether it is a look-up table of one output, which may be packed.
    """

    reads: frozenset[Hashable]
    drives: tuple[Hashable, ...]
    is_lut: bool


def pairs(gates: Sequence[Gate]) -> list[tuple[int, int]]:
    """Pairs of look-up tables that can share a LUT6_2, each table in at most one pair.

    A greedy matching: tables with the fewest partners choose first, or of very many the first of each level,
    which find fewer partners. No pair closes a loop through a cell, not
    even one that no signal takes, since tools that do not look inside a cell would see it.

    Args:
        gates: all cells of a module; a signal that none of them drives comes from outside.

    Returns:
        Indices into ``gates``, the lower one first, ascending. They depend on the arguments only.
    """
    small = [i for i, gate in enumerate(gates) if gate.is_lut and 0 < len(gate.reads) <= SHARED_INPUTS]
    if len(small) > _MANY:
        return sorted(_pairs_by_level(gates, small))
    partners = _partners(gates, small)
    graph = _Graph(gates)
    free = set(partners)
    chosen: list[tuple[int, int]] = []
    for gate in sorted(partners, key=lambda x: (len(partners[x]), x)):
        if gate not in free:
            continue
        found = [x for x in partners[gate] if x in free]
        # A shared signal is one wire less to route.
        found.sort(key=lambda x: (len(partners[x]), -len(gates[x].reads & gates[gate].reads), x))
        partner = next((x for x in found if graph.join(gate, x)), None)
        if partner is not None:
            free -= {gate, partner}
            chosen.append((min(gate, partner), max(gate, partner)))
    return sorted(chosen)


def packed_luts(network: LutNetwork) -> int:
    """LUTs of a network once its look-up tables share LUT6_2 where they can."""
    joined = {x for mux in network.muxes for x in (mux.low, mux.high)}
    gates = [
        Gate(frozenset(cell.reads), (cell.name,), isinstance(cell, Lut) and cell.name not in joined)
        for cell in network.cells
    ]
    return len(network.luts) - len(pairs(gates))


def _pairs_by_level(gates: Sequence[Gate], small: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Pairs of tables of one level; each takes the partner that reads most of what it reads itself."""
    by_level: dict[int, list[int]] = {}
    levels = _levels(gates)
    for i in small:
        by_level.setdefault(levels[i], []).append(i)
    for level in by_level.values():
        free = dict.fromkeys(level)
        by_signal: dict[Hashable, list[int]] = {}
        by_size: dict[int, list[int]] = {}
        # Backwards, so that the last ones are the nearest.
        for i in reversed(level):
            by_size.setdefault(len(gates[i].reads), []).append(i)
            for signal in gates[i].reads:
                by_signal.setdefault(signal, []).append(i)
        for i in level:
            if i not in free:
                continue
            del free[i]
            reads = gates[i].reads
            lists = [by_signal[signal] for signal in reads]
            lists += [by_size.get(size, []) for size in range(SHARED_INPUTS - len(reads), 0, -1)]
            found = [x for others in lists for x in _nearest(others, free)]
            fitting = [x for x in found if len(gates[x].reads | reads) <= SHARED_INPUTS]
            if fitting:
                # Large tables have fewer partners to choose from.
                partner = max(fitting, key=lambda x: (len(gates[x].reads), len(gates[x].reads & reads), -x))
                del free[partner]
                yield i, partner


def _nearest(tables: list[int], free: Container[int]) -> list[int]:
    """The last free ones of a list, from whose end those that are not free are dropped."""
    while tables and tables[-1] not in free:
        tables.pop()
    return [x for x in tables[-_LOOKED_AT:] if x in free]


def _levels(gates: Sequence[Gate]) -> list[int]:
    """Cells on the longest way to each cell, which is one of them."""
    drivers = {signal: i for i, gate in enumerate(gates) for signal in gate.drives}
    levels = [0] * len(gates)
    for root in range(len(gates)):
        stack = [] if levels[root] else [root]
        while stack:
            read = [drivers[x] for x in gates[stack[-1]].reads if x in drivers]
            waiting = [x for x in read if not levels[x]]
            if not waiting:
                levels[stack.pop()] = 1 + max((levels[x] for x in read), default=0)
            stack += waiting
    return levels


def _partners(gates: Sequence[Gate], small: Sequence[int]) -> dict[int, list[int]]:
    """For each table the tables that read few enough other signals, ascending."""
    partners: dict[int, set[int]] = {i: set() for i in small}
    by_signal: dict[Hashable, list[int]] = {}
    for i in small:
        for signal in gates[i].reads:
            by_signal.setdefault(signal, []).append(i)

    def offer(one: int, other: int) -> None:
        if len(gates[one].reads | gates[other].reads) <= SHARED_INPUTS:
            partners[one].add(other)
            partners[other].add(one)

    for readers in by_signal.values():
        for one, other in combinations(readers, 2):
            offer(one, other)
    # Tables so small that they need not share a signal.
    tiny = [i for i in small if len(gates[i].reads) < SHARED_INPUTS - 1]
    for one, other in combinations(tiny, 2):
        offer(one, other)
    return {i: sorted(others) for i, others in partners.items()}


class _Graph:
    """What reads what, of cells that are joined one pair after the other."""

    def __init__(self, gates: Sequence[Gate]) -> None:
        drivers = {signal: i for i, gate in enumerate(gates) for signal in gate.drives}
        self.readers: list[set[int]] = [set() for _ in gates]
        for i, gate in enumerate(gates):
            for signal in gate.reads:
                if signal in drivers:
                    self.readers[drivers[signal]].add(i)
        self.partner: dict[int, int] = {}

    def join(self, one: int, other: int) -> bool:
        """Join two cells; False, and nothing is joined, if one of them leads to the other."""
        if self._leads(one, other) or self._leads(other, one):
            return False
        self.partner[one], self.partner[other] = other, one
        return True

    def _leads(self, start: int, end: int) -> bool:
        seen: set[int] = set()
        stack = [start]
        while stack:
            for reader in self.readers[stack.pop()]:
                if reader == end:
                    return True
                if reader not in seen:
                    seen.add(reader)
                    stack.append(reader)
                    if reader in self.partner:
                        stack.append(self.partner[reader])
        return False
