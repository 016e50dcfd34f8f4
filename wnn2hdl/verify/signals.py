"""The named signals of a Verilog module, and what each computes from others.

Yosys reads the text and maps operators to gates. Look-up tables of the vendor count as they are documented
(UG953); all its other cells as Yosys models them.

In a pipeline a signal stands for its value when it arrives: a register is the signal that it stores. This
holds for outputs that all ways from inputs reach through equally many registers, and only for these.
"""

import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir import look_up, unpack_contents
from wnn2hdl.ir.wires import Bits
from wnn2hdl.tools import find_yosys
from wnn2hdl.verify.equivalence import CLOCK, Circuit, one_clock, read, read_cells

Bit = int
"""The number that Yosys gives to a bit; `ZERO` and `ONE` are the constants."""

ZERO, ONE = 0, 1

Column = NDArray[np.uint8]
"""Values 0 and 1, one for each sample."""

_SECONDS = 600.0

_GATES: Mapping[str, Callable[..., Column]] = {
    "$_NOT_": lambda a: a ^ 1,
    "$_AND_": lambda a, b: a & b,
    "$_OR_": lambda a, b: a | b,
    "$_XOR_": lambda a, b: a ^ b,
    "$_XNOR_": lambda a, b: a ^ b ^ 1,
    "$_NAND_": lambda a, b: (a & b) ^ 1,
    "$_NOR_": lambda a, b: (a | b) ^ 1,
    "$_ANDNOT_": lambda a, b: a & (b ^ 1),
    "$_ORNOT_": lambda a, b: a | (b ^ 1),
    "$_MUX_": lambda a, b, s: a ^ (s & (a ^ b)),
}
_REGISTER = "$_DFF_P_"
_TABLES = (*(f"LUT{size}" for size in range(1, 7)), "LUT6_2", "MUXF7", "MUXF8")


@dataclass(frozen=True, eq=False)
class Gate:
    """A bit that is driven: the bits it reads, and its value from theirs.

    Attributes:
        cycles: 1 for a register, otherwise 0.
    """

    reads: tuple[Bit, ...]
    compute: Callable[..., Column]
    cycles: int = 0


@dataclass(frozen=True, eq=False)
class Signals:
    """A module.

    Attributes:
        inputs: bits of each input port, without the clock.
        outputs: bits of each output port.
        gates: by the bit they drive, each after those it reads.
        named: bits that have a name in the text.
    """

    inputs: Mapping[str, tuple[Bit, ...]]
    outputs: Mapping[str, tuple[Bit, ...]]
    gates: Mapping[Bit, Gate]
    named: frozenset[Bit]

    @property
    def ports(self) -> list[tuple[str, int]]:
        """Name and width of each input port, then of each output port, in the module's order."""
        return [(port, len(bits)) for ports in (self.inputs, self.outputs) for port, bits in ports.items()]

    @cached_property
    def leaves(self) -> dict[Bit, tuple[Bit, ...]]:
        """For each named bit that is driven, the named bits and inputs that it is a function of.

        A name of another bit, of its inverse or of a register of it is not among them, that bit is.
        """
        found: dict[Bit, tuple[Bit, ...]] = {}
        below: dict[Bit, tuple[Bit, ...]] = {ZERO: (), ONE: ()}
        for bit, gate in self.gates.items():
            read = tuple(dict.fromkeys(leaf for x in gate.reads for leaf in below.get(x, (x,))))
            if bit in self.named:
                found[bit] = read
            if bit not in self.named or len(read) < 2:
                below[bit] = read
        return found

    @cached_property
    def latencies(self) -> frozenset[int]:
        """How many registers are on the ways from inputs to outputs."""
        found = {bit: frozenset({0}) for bits in self.inputs.values() for bit in bits}
        none = frozenset[int]()
        for bit, gate in self.gates.items():
            times = none.union(*(found.get(x, none) for x in gate.reads))
            found[bit] = frozenset(time + gate.cycles for time in times)
        return none.union(*(found.get(bit, none) for bits in self.outputs.values() for bit in bits))

    def evaluate(self, wanted: Sequence[Bit], known: Mapping[Bit, Column]) -> list[Column]:
        """Values of bits from those of others, on which they depend.

        Args:
            wanted: the bits.
            known: values of other bits, at least one; what they depend on in turn is not looked at.
        """
        samples = len(next(iter(known.values())))
        values = {ZERO: np.zeros(samples, np.uint8), ONE: np.ones(samples, np.uint8), **known}
        stack = list(wanted)
        while stack:
            bit = stack[-1]
            missing = [] if bit in values else [x for x in self.gates[bit].reads if x not in values]
            if missing:
                stack += missing
                continue
            if bit not in values:
                values[bit] = self.gates[bit].compute(*(values[x] for x in self.gates[bit].reads))
            stack.pop()
        return [values[bit] for bit in wanted]

    def answers(self, inputs: Mapping[str, Bits]) -> dict[str, Bits]:
        """What the module answers, of a pipeline its latency later.

        Args:
            inputs: values of its input ports, bool ``[samples, width]``.

        Returns:
            Values of its output ports.
        """
        known = {
            bit: column
            for port, bits in inputs.items()
            for bit, column in zip(self.inputs[port], bits.T.astype(np.uint8), strict=True)
        }
        return {
            port: np.stack(self.evaluate(bits, known), axis=1).astype(np.bool_)
            for port, bits in self.outputs.items()
        }


def read_signals(circuits: Sequence[Circuit]) -> list[Signals | None]:
    """The signals of circuits, None for one with registers that feed themselves.

    One process of Yosys reads all of them.

    Raises:
        CheckError: a circuit without latency has registers, or a circuit reads undefined values.
        ToolError: Yosys cannot read a circuit, or it holds a cell that is not a gate.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        script = read_cells(circuits)
        if script:
            # A table stays one gate, which is quicker to evaluate than the multiplexers that it is made of.
            script += ["design -load cells", f"blackbox {' '.join(_TABLES)}", "design -stash cells"]
        for number, (circuit, reading) in enumerate(zip(circuits, read(circuits, folder), strict=True)):
            script += [*reading, "check -assert"]
            script += ["flatten -noscopeinfo", "opt_expr", "techmap", *one_clock(circuit), "opt_clean"]
            script.append(f"write_json {number}.json")
        find_yosys().run("\n".join(script) + "\n", timeout=_SECONDS, cwd=folder)
        return [
            _signals(json.loads((folder / f"{number}.json").read_text(encoding="utf-8")), circuit)
            for number, circuit in enumerate(circuits)
        ]


def _signals(design: Mapping[str, Any], circuit: Circuit) -> Signals | None:
    module = design["modules"][circuit.top]
    ports: dict[str, dict[str, tuple[Bit, ...]]] = {"input": {}, "output": {}}
    for port, details in module["ports"].items():
        if not (circuit.latency and port == CLOCK):
            ports[details["direction"]][port] = tuple(map(_bit, details["bits"]))
    gates: dict[Bit, Gate] = {}
    for name, cell in module["cells"].items():
        gates |= _gates(name, cell, circuit)
    named = frozenset(
        _bit(bit) for net in module["netnames"].values() if not net["hide_name"] for bit in net["bits"]
    )
    ordered = _ordered(gates, {bit for bits in ports["input"].values() for bit in bits})
    return None if ordered is None else Signals(ports["input"], ports["output"], ordered, named)


def _gates(name: str, cell: Mapping[str, Any], circuit: Circuit) -> dict[Bit, Gate]:
    """What a cell drives."""
    kind, pins = cell["type"], {pin: tuple(map(_bit, bits)) for pin, bits in cell["connections"].items()}
    if kind in _GATES:
        reads = tuple(pins[pin][0] for pin in "ABS" if pin in pins)
        return {pins["Y"][0]: Gate(reads, _GATES[kind])}
    if kind == _REGISTER and circuit.latency:
        return {pins["Q"][0]: Gate(pins["D"], lambda stored: stored, cycles=1)}
    if kind.startswith("$_DFF"):
        raise CheckError("the circuit has registers, so it is not combinational", value=circuit.top)
    if kind in ("MUXF7", "MUXF8"):
        reads = tuple(pins[pin][0] for pin in ("I0", "I1", "S"))
        return {pins["O"][0]: Gate(reads, _GATES["$_MUX_"])}
    if kind.startswith("LUT") and "INIT" in cell["parameters"]:
        contents = int(cell["parameters"]["INIT"], 2)
        width = sum(pin.startswith("I") for pin in pins)
        return {
            pins[pin][0]: _table([pins[f"I{place}"][0] for place in range(size)], contents)
            for pin, size in (("O", width), ("O6", width), ("O5", width - 1))
            if pins.get(pin)
        }
    raise ToolError("a cell is not a gate", value=f"{name}, a {kind}")


def _table(reads: Sequence[Bit], contents: int) -> Gate:
    """A look-up table, without inputs that are constant or do not matter: two tables may share a cell."""
    table = unpack_contents(contents & (1 << (1 << len(reads))) - 1, len(reads)).view(np.uint8)
    left = list(reads)
    for place in reversed(range(len(reads))):
        low, high = np.moveaxis(table.reshape(-1, 2, 1 << place), 1, 0)
        if reads[place] in (ZERO, ONE) or np.array_equal(low, high):
            table = (high if reads[place] == ONE else low).reshape(-1)
            del left[place]
    if not left:
        return Gate((int(table[0]),), lambda pin: pin)
    return Gate(tuple(left), lambda *pins: look_up(table, pins))


def _ordered(gates: Mapping[Bit, Gate], inputs: set[Bit]) -> dict[Bit, Gate] | None:
    """The gates, each after those it reads; None if that cannot be, since they feed themselves."""
    done, ordered = {ZERO, ONE, *inputs}, dict[Bit, Gate]()
    entered: set[Bit] = set()
    for root in gates:
        stack = [root]
        while stack:
            bit = stack[-1]
            if bit not in done and bit not in gates:
                raise CheckError("the circuit reads an undefined value (x)", value=bit)
            waiting = [] if bit in done else [x for x in gates[bit].reads if x not in done]
            if waiting and bit in entered:
                return None
            if waiting:
                entered.add(bit)
                stack += waiting
                continue
            stack.pop()
            if bit not in done:
                done.add(bit)
                ordered[bit] = gates[bit]
    return ordered


def _bit(bit: int | str) -> Bit:
    """Yosys counts from 2, and writes constants as text."""
    if isinstance(bit, int):
        return bit
    if bit in ("0", "1"):
        return int(bit)
    raise CheckError("the circuit reads an undefined value (x)", value=bit)
