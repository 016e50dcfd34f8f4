"""The named signals of a combinational Verilog module, and what each computes from others.

Yosys reads the text and maps operators to gates. Look-up tables of the vendor count as they are documented
(UG953).
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

from wnn2hdl.errors import ToolError
from wnn2hdl.ir import look_up, unpack_contents
from wnn2hdl.tools import find_yosys
from wnn2hdl.verify.equivalence import Circuit

Bit = int
"""The number that Yosys gives to a bit; `ZERO` and `ONE` are the constants."""

ZERO, ONE = 0, 1

Column = NDArray[np.uint8]
"""Values 0 and 1, one for each sample."""

_SECONDS = 300.0

_GATES: Mapping[str, Callable[..., Column]] = {
    "$_NOT_": lambda a: a ^ 1,
    "$_AND_": lambda a, b: a & b,
    "$_OR_": lambda a, b: a | b,
    "$_XOR_": lambda a, b: a ^ b,
    "$_XNOR_": lambda a, b: a ^ b ^ 1,
    "$_NAND_": lambda a, b: (a & b) ^ 1,
    "$_NOR_": lambda a, b: (a | b) ^ 1,
    "$_MUX_": lambda a, b, s: a ^ (s & (a ^ b)),
}


@dataclass(frozen=True, eq=False)
class Gate:
    """A bit that is driven: the bits it reads, and its value from theirs."""

    reads: tuple[Bit, ...]
    compute: Callable[..., Column]


@dataclass(frozen=True, eq=False)
class Signals:
    """A module.

    Attributes:
        inputs: bits of each input port.
        outputs: bits of each output port.
        gates: by the bit they drive, each after those it reads.
        named: bits that have a name in the text.
    """

    inputs: Mapping[str, tuple[Bit, ...]]
    outputs: Mapping[str, tuple[Bit, ...]]
    gates: Mapping[Bit, Gate]
    named: frozenset[Bit]

    @cached_property
    def leaves(self) -> dict[Bit, tuple[Bit, ...]]:
        """For each named bit that is driven, the named bits and inputs that it is a function of.

        A name of another bit or of its inverse is not among them, that bit is.
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


def read_signals(circuit: Circuit) -> Signals:
    """The signals of a circuit without registers.

    Raises:
        ToolError: Yosys cannot read it, or it holds a cell that is not a gate, or a loop.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        names = [f"{number}.v" for number in range(len(circuit.sources))]
        for name, text in zip(names, circuit.sources, strict=True):
            (folder / name).write_text(text, encoding="utf-8")
        script = [f"read_verilog -nooverwrite {name}" for name in names]
        script += [f"hierarchy -top {circuit.top}", "flatten", "proc", "simplemap", "write_json design.json"]
        log = find_yosys().run("\n".join(script) + "\n", timeout=_SECONDS, cwd=folder)
        try:
            data = json.loads((folder / "design.json").read_text(encoding="utf-8"))["modules"][circuit.top]
        except (OSError, ValueError, LookupError) as error:
            raise ToolError("Yosys wrote no netlist that can be read", value=error, output=log) from error
    ports: dict[str, dict[str, tuple[Bit, ...]]] = {"input": {}, "output": {}}
    for port, details in data["ports"].items():
        ports[details["direction"]][port] = tuple(map(_bit, details["bits"]))
    gates: dict[Bit, Gate] = {}
    for name, cell in data["cells"].items():
        gates |= _gates(name, cell)
    named = frozenset(
        _bit(bit) for net in data["netnames"].values() if not net["hide_name"] for bit in net["bits"]
    )
    inputs = {bit for bits in ports["input"].values() for bit in bits}
    return Signals(ports["input"], ports["output"], _ordered(gates, inputs, circuit.top), named)


def _gates(name: str, cell: Mapping[str, Any]) -> dict[Bit, Gate]:
    """What a cell drives."""
    kind, pins = cell["type"], {pin: tuple(map(_bit, bits)) for pin, bits in cell["connections"].items()}
    if kind in _GATES:
        reads = tuple(pins[pin][0] for pin in "ABS" if pin in pins)
        return {pins["Y"][0]: Gate(reads, _GATES[kind])}
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


def _ordered(gates: Mapping[Bit, Gate], inputs: set[Bit], top: str) -> dict[Bit, Gate]:
    done, ordered = {ZERO, ONE, *inputs}, dict[Bit, Gate]()
    entered: set[Bit] = set()
    for root in gates:
        stack = [root]
        while stack:
            bit = stack[-1]
            if bit not in done and bit not in gates:
                raise ToolError("nothing drives a signal of the circuit", value=top)
            waiting = [] if bit in done else [x for x in gates[bit].reads if x not in done]
            if waiting and bit in entered:
                raise ToolError("signals of the circuit depend on themselves", value=top)
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
    raise ToolError("the circuit reads an undefined value", value=bit)
