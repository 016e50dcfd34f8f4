"""Pieces of a circuit, and the wiring that makes it of them.

A circuit that is too large to be compared with its model at once is cut at the ports of the modules inside
it. Each piece has a claim of its own, and what is left is wiring: which bit of a piece reads which bit of
another.

Why it is sound. The claim of a piece holds for every input that it is stated for, in whatever circuit it
stands. The wiring of the emitted Verilog is read with the pieces as closed boxes, and every bit that a box
reads and every output of the circuit is followed back to the box or port that drives it; only registers may
be on the way. If it is the wiring that the model's side states, the circuit is the composition of its
pieces, and hence of what the pieces are claimed to be. That this composition is the model is for whoever
states it to argue.

Latencies meet if all bits that a box reads are equally late: the box or port that drives each, and the
registers on the way, add up to one number of cycles. A box answers its latency later.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from wnn2hdl.verify.addition import Sums
from wnn2hdl.verify.equivalence import CLOCK, Circuit, one_clock, structure

_SECONDS = 600.0
_FRAME = "proof__frame"


@dataclass(frozen=True, eq=False)
class Piece:
    """The claim that a module inside a circuit equals a module of the reference.

    Attributes:
        statement: the claim in words.
        module: of the reference; None of a sum that is beyond SAT.
        inputs: width of each input port of the comparison.
        outputs: width of each output port.
        lines: statements of a frame around the circuit, where it is not compared port by port.
        connections: in the frame, what each port of the circuit is connected to.
        sums: what it adds, if that is what it does; it is then proved by substitution.
    """

    statement: str
    module: str | None
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
    lines: tuple[str, ...] = ()
    connections: Mapping[str, str] = field(default_factory=dict)
    sums: Sums | None = None

    def framed(self, circuit: Circuit, reference: str) -> Circuit:
        """A circuit with the ports of the comparison."""
        if not self.connections:
            return circuit
        clock = {CLOCK: CLOCK} if circuit.latency else {}
        header = [f"input {port}" for port in clock]
        header += [f"input [{width - 1}:0] {port}" for port, width in self.inputs.items()]
        header += [f"output [{width - 1}:0] {port}" for port, width in self.outputs.items()]
        pins = ", ".join(f".{port}({net})" for port, net in {**self.connections, **clock}.items())
        lines = [*self.lines, f"  {circuit.top} circuit ({pins});", "endmodule", ""]
        text = "\n".join([f"module {_FRAME}({', '.join(header)});", *lines])
        return Circuit((text, reference, *circuit.sources), _FRAME, circuit.latency)


@dataclass(frozen=True)
class Box:
    """An instance of a piece.

    Attributes:
        part: the piece.
        inputs: for each input port the bit that drives each of its bits: ``port[3]`` of the circuit, or
            ``box.port[3]`` of another box.
    """

    part: str
    inputs: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Composition:
    """A circuit as a composition of pieces.

    Attributes:
        part: the circuit.
        pieces: what is claimed of each module by its part.
        boxes: the instances by their place in the hierarchy, each after those that it reads.
        outputs: for each output port of the circuit the bit that drives each of its bits.
        reference: Verilog of the modules that the pieces name, and of no other: Yosys takes long to read that
            of a large network.
    """

    part: str
    pieces: Mapping[str, Piece]
    boxes: Mapping[str, Box]
    outputs: Mapping[str, tuple[str, ...]]
    reference: str


def bits(name: str, width: int) -> tuple[str, ...]:
    """The bits of a port, the least significant first."""
    return tuple(f"{name}[{place}]" for place in range(width))


def wrong_wire(composition: Composition, circuit: Circuit, parts: Mapping[str, Circuit]) -> str | None:
    """What of the wiring of a circuit is not that of the composition, in words; None if it all is.

    Args:
        composition: the pieces and how they are wired.
        circuit: the emitted circuit.
        parts: the emitted pieces.

    Raises:
        ToolError: Yosys cannot read the circuit.
    """
    modules = {parts[part].top: part for part in composition.pieces}
    wires = _Wires(_wiring(circuit, list(modules)), modules)
    wanted = {name: box.part for name, box in composition.boxes.items()}
    if wires.boxes != wanted:
        return f"it holds {_named(wires.boxes)}, not {_named(wanted)}"
    late = dict.fromkeys(("", *composition.boxes), 0)
    for name, box in composition.boxes.items():
        found = wires.inputs[name]
        if found.keys() != box.inputs.keys():
            return f"{name} reads {', '.join(found)}"
        times: set[int] = set()
        for port, drivers in box.inputs.items():
            fault = wires.fault(f"{name}.{port}", found[port], drivers, late, times)
            if fault:
                return fault
        if len(times) > 1:
            return f"what {name} reads is {_cycles(times)} cycles late"
        late[name] = max(times, default=0) + parts[box.part].latency
    times = set()
    for port, drivers in composition.outputs.items():
        fault = wires.fault(port, wires.ports[port], drivers, late, times)
        if fault:
            return fault
    if times != {circuit.latency}:
        return f"the outputs are {_cycles(times)} cycles late, not {circuit.latency}"
    return None


def _wiring(circuit: Circuit, modules: Sequence[str]) -> dict[str, Any]:
    """The top module in Yosys's JSON, flattened down to these modules."""
    commands = [f"blackbox {' '.join(modules)}", "flatten -noscopeinfo", "simplemap"]
    return structure(circuit, [*commands, *one_clock(circuit), "opt_clean"], timeout=_SECONDS)


class _Wires:
    """A flattened module whose cells are boxes and registers.

    Args:
        module: of Yosys's JSON.
        parts: the part of each module that is a box.

    Attributes:
        boxes: the part of each box by its name.
        inputs: for each box and each of its input ports the wires that it reads.
        ports: the wires of each port of the module.
    """

    def __init__(self, module: Mapping[str, Any], parts: Mapping[str, str]) -> None:
        self.ports = {name: port["bits"] for name, port in module["ports"].items()}
        self.boxes: dict[str, str] = {}
        self.inputs: dict[str, dict[str, list[int | str]]] = {}
        self._drivers: dict[int | str, str] = {"0": "0", "1": "1"}
        self._registers: dict[int | str, int | str] = {}
        clock = self.ports.get(CLOCK)
        for name, port in module["ports"].items():
            if port["direction"] == "input":
                self._drives(name, port["bits"])
        for name, cell in module["cells"].items():
            pins, ways = cell["connections"], cell["port_directions"]
            if cell["type"] in parts:
                self.boxes[name] = parts[cell["type"]]
                self.inputs[name] = {
                    pin: wires
                    for pin, wires in pins.items()
                    if ways[pin] == "input" and not (pin == CLOCK and wires == clock)
                }
                for pin, wires in pins.items():
                    if ways[pin] == "output":
                        self._drives(f"{name}.{pin}", wires)
            elif cell["type"] == "$_DFF_P_":
                self._registers[pins["Q"][0]] = pins["D"][0]

    def fault(
        self,
        reader: str,
        wires: Sequence[int | str],
        drivers: Sequence[str],
        late: Mapping[str, int],
        times: set[int],
    ) -> str | None:
        """The first wire of a port that another bit drives, in words.

        Args:
            reader: the port.
            wires: its wires.
            drivers: what has to drive them.
            late: by how many cycles the outputs of each box are late, ``""`` for the ports of the circuit.
            times: gets by how many cycles the wires are late.
        """
        if len(wires) != len(drivers):
            return f"{reader} has {len(wires)} bits, not {len(drivers)}"
        for place, (wire, wanted) in enumerate(zip(wires, drivers, strict=True)):
            cycles, passed = 0, wire
            while passed in self._registers and cycles <= len(self._registers):
                passed, cycles = self._registers[passed], cycles + 1
            found = self._drivers.get(passed, "logic")
            if found != wanted:
                return f"{reader}[{place}] is driven by {found}, not by {wanted}"
            times.add(late[wanted.rpartition(".")[0]] + cycles)
        return None

    def _drives(self, name: str, wires: Sequence[int | str]) -> None:
        self._drivers |= dict(zip(wires, bits(name, len(wires)), strict=True))


def _named(boxes: Mapping[str, str]) -> str:
    return ", ".join(f"{name} ({part})" for name, part in sorted(boxes.items()))


def _cycles(times: set[int]) -> str:
    return " or ".join(map(str, sorted(times)))
