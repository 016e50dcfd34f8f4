"""Circuits as gates between wires with names, which is where a proof by arithmetic cuts."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.verify.equivalence import TO_GATES, Circuit, one_clock, structure

Wire = int | str
"""A bit of a module in Yosys's JSON: a number, or a constant ``0`` or ``1``."""

CONSTANTS = ("0", "1")

MAX_READ = 10
"""Wires that a cut may depend on: its table has a row for each of their values."""

_REGISTER = "$_DFF_P_"
_SECONDS = 600.0
_CIRCLE = frozenset({-(1 << 30)})


class Gates:
    """A module of inverters, ANDs and registers.

    Args:
        module: of Yosys's JSON.

    Attributes:
        ports: the wires of each port, the least significant first.
        cut: wires that have a name in the circuit's own text, and registers; inputs are not among them.
    """

    def __init__(self, module: Mapping[str, Any]) -> None:
        self.ports: dict[str, list[Wire]] = {name: port["bits"] for name, port in module["ports"].items()}
        self._gates: dict[Wire, tuple[str, tuple[Wire, ...]]] = {}
        for cell in module["cells"].values():
            pins = cell["connections"]
            output = pins["Q" if "Q" in pins else "Y"][0]
            self._gates[output] = cell["type"], tuple(pins[pin][0] for pin in "ABD" if pin in pins)
        # A name with a dot is that of a wire inside a cell that was flattened.
        named = {
            wire
            for name, net in module["netnames"].items()
            if not net["hide_name"] and "." not in name
            for wire in net["bits"]
        }
        self._registers = {wire for wire, (kind, _) in self._gates.items() if kind == _REGISTER}
        self.cut = {wire for wire in self._gates if wire in named or wire in self._registers}
        self._reads: dict[Wire, tuple[Wire, ...]] = {}
        self._arrivals: dict[Wire, frozenset[int]] = {}
        self._levels: dict[Wire, int] = {}

    @classmethod
    def read(cls, circuit: Circuit) -> Self:
        """The gates of a circuit, flattened; raises ToolError if Yosys cannot read it."""
        commands = ["check -assert", *TO_GATES, "opt_clean", "flatten -noscopeinfo"]
        commands += [*one_clock(circuit), "opt_clean"]
        return cls(structure(circuit, commands, timeout=_SECONDS))

    def reads(self, wire: Wire) -> tuple[Wire, ...]:
        """The cuts and inputs that the wire at a cut depends on.

        Two tables in one cell share its pins and need not depend on all of them.
        """
        if wire not in self._reads:
            found = self._reached(wire)
            if len(found) <= MAX_READ:
                values = self.table(wire, all_values(found)).reshape((2,) * len(found))
                # The first wire is the least significant bit of an address, so it is the last axis.
                axes = range(len(found) - 1, -1, -1)
                found = [x for x, axis in zip(found, axes, strict=True) if np.diff(values, axis=axis).any()]
            self._reads[wire] = tuple(found)
        return self._reads[wire]

    def _reached(self, wire: Wire) -> list[Wire]:
        """The cuts and inputs at which the ways back from a wire end."""
        found: dict[Wire, None] = {}
        waiting = list(self._gates[wire][1])
        for reached in waiting:
            if reached in self.cut or reached not in self._gates:
                found[reached] = None
            else:
                waiting += self._gates[reached][1]
        return [reached for reached in found if reached not in CONSTANTS]

    def table(self, wire: Wire, values: Mapping[Wire, NDArray[np.bool_]]) -> NDArray[np.bool_]:
        """The values of a wire at a cut for values of all wires that it reads, of equal length.

        A register has the value of what it stores.
        """
        size = len(next(iter(values.values()))) if values else 1
        # What the wire does not depend on may have any value.
        known = {reached: np.zeros(size, np.bool_) for reached in (*self._reached(wire), CONSTANTS[0])}
        known |= {CONSTANTS[1]: np.ones(size, np.bool_), **values}

        def value(reached: Wire) -> NDArray[np.bool_]:
            if reached not in known:
                kind, pins = self._gates[reached]
                first, *others = map(value, pins)
                known[reached] = ~first if kind == "$_NOT_" else first & others[0] if others else first
            return known[reached]

        return value(wire)

    def level(self, wire: Wire) -> int:
        """How many cuts are on the longest way from an input to the wire at a cut, which is one of them."""
        if wire not in self._levels:
            below = [self.level(reached) for reached in self.reads(wire) if reached in self.cut]
            self._levels[wire] = 1 + max(below, default=0)
        return self._levels[wire]

    def arrivals(self, wire: Wire) -> frozenset[int]:
        """How many registers are on the ways from inputs to a cut; below 0 for a way in a circle."""
        if wire not in self.cut:
            return frozenset() if wire in CONSTANTS else frozenset({0})
        if wire not in self._arrivals:
            self._arrivals[wire] = _CIRCLE
            times = frozenset[int]().union(*map(self.arrivals, self.reads(wire)))
            self._arrivals[wire] = frozenset(time + (wire in self._registers) for time in times)
        return self._arrivals[wire]


def all_values(wires: Sequence[Wire]) -> dict[Wire, NDArray[np.bool_]]:
    """Every combination of values: bool ``[2**n]`` for each of ``n`` wires; the first changes fastest."""
    codes = np.arange(1 << len(wires))
    return {wire: (codes >> place & 1).astype(np.bool_) for place, wire in enumerate(wires)}
