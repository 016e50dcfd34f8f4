"""What stands between the pins of an FPGA and a circuit, so that the circuit can be placed by itself."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from typing import Literal

Harness = Literal["registers", "shift registers", "none"]
"""``registers``: each port is a pin, with a register behind it. ``shift registers``: inputs come in and
answers go out bit by bit, since the FPGA has fewer pins than there are ports. ``none``: ports are pins."""

CLOCK = "clk"


@dataclass(frozen=True)
class Ports:
    """The ports of a module.

    Attributes:
        inputs: widths by name, without the clock.
        outputs: widths by name.
        clock: the port of the clock; None of a combinational module.
    """

    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
    clock: str | None = None

    @property
    def pins(self) -> int:
        """Bits of all ports, a clock among them."""
        return 1 + sum(self.inputs.values()) + sum(self.outputs.values())


@dataclass(frozen=True)
class Harnessed:
    """A harness.

    Attributes:
        kind: what it is.
        verilog: its module, which instantiates the circuit.
        pins: its ports bit by bit, as constraints name them, the clock first.
    """

    kind: Harness
    verilog: str
    pins: tuple[str, ...]


def harness(name: str, circuit: str, ports: Ports, *, pins: int, registered: bool) -> Harnessed:
    """The harness of a circuit.

    Args:
        name: of its module.
        circuit: the module that it instantiates.
        ports: the circuit's.
        pins: how many ports the FPGA has pins for.
        registered: whether every port gets a register; of a stream, whose handshake would break, none does.
    """
    if ports.pins > pins:
        serial = Ports({"shift_in": 1, "load": 1}, {"shift_out": 1})
        return Harnessed("shift registers", _shifting(name, circuit, ports), _bits(serial, CLOCK))
    if registered:
        return Harnessed("registers", _registered(name, circuit, ports), _bits(ports, CLOCK))
    clock = ports.clock or CLOCK
    lines = [_heading(name, ports, clock, "wire"), f"    {circuit} circuit ("]
    connected = [*ports.inputs, *ports.outputs, clock]
    return Harnessed(
        "none",
        "\n".join([*lines, _connections({port: port for port in connected}), "    );", "endmodule", ""]),
        _bits(ports, clock),
    )


def _registered(name: str, circuit: str, ports: Ports) -> str:
    lines = [
        "// A register behind each input and before each output, so that all paths begin and end in one.",
        _heading(name, ports, CLOCK, "reg "),
        *(f"    reg {_range(width)}taken__{port};" for port, width in ports.inputs.items()),
        *(f"    wire {_range(width)}answer__{port};" for port, width in ports.outputs.items()),
        f"    {circuit} circuit (",
        _connections(
            {port: f"taken__{port}" for port in ports.inputs}
            | {port: f"answer__{port}" for port in ports.outputs}
            | ({ports.clock: CLOCK} if ports.clock else {})
        ),
        "    );",
        f"    always @(posedge {CLOCK}) begin",
        *(f"        taken__{port} <= {port};" for port in ports.inputs),
        *(f"        {port} <= answer__{port};" for port in ports.outputs),
        "    end",
        "endmodule",
        "",
    ]
    return "\n".join(lines)


def _shifting(name: str, circuit: str, ports: Ports) -> str:
    taken, given = sum(ports.inputs.values()), sum(ports.outputs.values())
    connections = _slices("taken", ports.inputs) | _slices("answers", ports.outputs)
    if ports.clock:
        connections[ports.clock] = CLOCK
    lines = [
        f"// {taken} bits of input are shifted in, the last input port's highest bit first. {given} bits of",
        "// output go into a register in each cycle, from there into another where load is 1, and are",
        "// shifted out of that one, the first output port's lowest bit first.",
        f"module {name} (",
        f"    input  wire {CLOCK},",
        "    input  wire shift_in,",
        "    input  wire load,",
        "    output wire shift_out",
        ");",
        f"    reg [{taken - 1}:0] taken;",
        f"    wire [{given - 1}:0] answers;",
        f"    reg [{given - 1}:0] answered, going;",
        f"    {circuit} circuit (",
        _connections(connections),
        "    );",
        "    assign shift_out = going[0];",
        f"    always @(posedge {CLOCK}) begin",
        "        taken <= {taken, shift_in};",
        "        answered <= answers;",
        "        going <= load ? answered : going >> 1;",
        "    end",
        "endmodule",
        "",
    ]
    return "\n".join(lines)


def _slices(word: str, widths: Mapping[str, int]) -> dict[str, str]:
    """The bits of a word for each port, the first port in the low ones."""
    ends = list(accumulate(widths.values()))
    return {
        port: f"{word}[{end - 1}:{end - width}]"
        for (port, width), end in zip(widths.items(), ends, strict=True)
    }


def _heading(name: str, ports: Ports, clock: str, kind: str) -> str:
    declared = [
        f"    input  wire {clock}",
        *(f"    input  wire {_range(width)}{port}" for port, width in ports.inputs.items()),
        *(f"    output {kind} {_range(width)}{port}" for port, width in ports.outputs.items()),
    ]
    return "\n".join([f"module {name} (", ",\n".join(declared), ");"])


def _connections(nets: Mapping[str, str]) -> str:
    return ",\n".join(f"        .{port}({net})" for port, net in nets.items())


def _range(width: int) -> str:
    return f"[{width - 1}:0] " if width > 1 else ""


def _bits(ports: Ports, clock: str) -> tuple[str, ...]:
    widths = {**ports.inputs, **ports.outputs}
    return (
        clock,
        *(f"{port}[{bit}]" if width > 1 else port for port, width in widths.items() for bit in range(width)),
    )
