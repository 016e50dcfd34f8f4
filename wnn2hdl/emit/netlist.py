"""A combinational module: read from the Verilog of Amaranth's back end, and written for people.

The back end writes one operator an ``assign``, in no useful order, with numbered temporaries and escaped
names; `wnn2hdl.emit.tidy` works on what is read here.
"""

import re
from collections import Counter
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass

from wnn2hdl.emit.expression import Operation, close, render, widen

NAME = r"[A-Za-z_$][\w$]*"
_REFERENCE = re.compile(rf"(?<![\w$'.]){NAME}")
_ATOM = rf"(?:{NAME}(?:\[\d+(?::\d+)?\])?|\d+'h[0-9a-f]+)"
_DECLARATION = re.compile(rf"(?:input|output|wire)(?: \[(\d+):0\])? ({NAME})\s*")
_ASSIGN = re.compile(rf"assign ({NAME}) = (.+)")
_INSTANCE = re.compile(
    rf"(?P<attribute>\(\* .* \*\) )?(?P<module>{NAME})(?: #\((?P<parameters>.*?)\s*\))? (?P<name>{NAME}) "
    rf"\( (?P<ports>\..*) \)"
)
_CONNECTION = re.compile(rf"\.({NAME})\(([^()]*)\)")
_UNARY = re.compile(rf"(~) ({_ATOM})")
_BINARY = re.compile(rf"({_ATOM}) ([&|^]) ({_ATOM})")
_MUX = re.compile(rf"({_ATOM}) (\?) ({_ATOM}) : ({_ATOM})")
_LINE_LENGTH = 110
_CELL_OUTPUTS = ("O",)

Value = Operation | str
"""What drives a wire: a one-bit operation, or an expression as text."""

Ports = Mapping[str, tuple[Mapping[str, int], Mapping[str, int]]]
"""For each module that is instantiated the widths of its inputs and of its outputs, in order of declaration.
Modules that are not named are vendor cells, whose output is ``O``."""


@dataclass
class Instance:
    """An instance of another module; ``head`` is what stands before the connections."""

    head: str
    name: str
    inputs: dict[str, str]
    outputs: dict[str, str]
    is_cell: bool


@dataclass
class Netlist:
    """A module: direction of each port in order, bits of each wire and port, and what drives them."""

    ports: dict[str, str]
    widths: dict[str, int]
    assigns: dict[str, Value]
    instances: list[Instance]

    def reads(self) -> Counter[str]:
        """How often each wire is read."""
        texts = [render(value) for value in self.assigns.values()]
        texts += [value for instance in self.instances for value in instance.inputs.values()]
        return Counter(name for text in texts for name in references(text))

    def rewrite(self, text: Callable[[str], str], spare: Iterable[str] = ()) -> None:
        """Rewrite every expression, except what drives the wires to spare."""
        kept = set(spare)
        for wire, value in self.assigns.items():
            if wire not in kept:
                self.assigns[wire] = value.map(text) if isinstance(value, Operation) else text(value)
        for instance in self.instances:
            instance.inputs = {port: text(value) for port, value in instance.inputs.items()}
            instance.outputs = {port: text(value) for port, value in instance.outputs.items()}

    def rename(self, names: Mapping[str, str]) -> None:
        """Give wires other names."""
        self.rewrite(lambda text: _REFERENCE.sub(lambda match: names.get(match[0], match[0]), text))
        self.assigns = {names.get(wire, wire): value for wire, value in self.assigns.items()}
        self.widths = {names.get(wire, wire): width for wire, width in self.widths.items()}


def references(text: str) -> list[str]:
    """Names of wires in an expression, in order."""
    return [name for name in _REFERENCE.findall(text) if name != "$signed"]


def parse(text: str, inputs: Mapping[str, int], outputs: Mapping[str, int], parts: Ports) -> Netlist:
    """Read the one module in a text of Amaranth's back end.

    Args:
        text: Verilog of a combinational component.
        inputs: width of each input, in the order wanted.
        outputs: width of each output.
        parts: ports of the modules that are instantiated.

    Raises:
        NotImplementedError: a statement that combinational components do not lead to.
    """
    directions = dict.fromkeys(inputs, "input") | dict.fromkeys(outputs, "output")
    netlist = Netlist(directions, {**inputs, **outputs}, {}, [])
    plain = re.sub(r"\\(\S+) ", r"\1", text)
    body = plain.split(");", 1)[1].rsplit("endmodule", 1)[0]
    for chunk in body.split(";\n"):
        statement = " ".join(chunk.split())
        if match := _DECLARATION.fullmatch(statement):
            netlist.widths[match[2]] = int(match[1] or 0) + 1
        elif match := _ASSIGN.fullmatch(statement):
            netlist.assigns[match[1]] = _value(close(match[2]))
        elif match := _INSTANCE.fullmatch(statement):
            netlist.instances.append(_instance(match, parts))
        elif statement:
            raise NotImplementedError(f"{statement} is not combinational")
    return netlist


def write(netlist: Netlist, name: str, last: Container[str]) -> str:
    """The module as Verilog-2001: statements level by level, each wire declared where it is driven.

    Args:
        netlist: the module.
        name: its name.
        last: wires whose statements close the module.
    """
    widths = netlist.widths
    ports = [f"    {kind:<6} wire {_range(widths[port])}{port}" for port, kind in netlist.ports.items()]
    drivers: dict[str, Value | Instance] = dict(netlist.assigns)
    for instance in netlist.instances:
        drivers |= dict.fromkeys(references(" ".join(instance.outputs.values())), instance)
    levels: dict[str, int] = {}

    def level(wire: str) -> int:
        """How many statements lie between the inputs and a wire."""
        if wire not in levels:
            driver = drivers.get(wire)
            read = driver.inputs.values() if isinstance(driver, Instance) else [render(driver or "")]
            below = [level(name) for name in references(" ".join(read))]
            levels[wire] = 0 if driver is None else 1 + max(below, default=0)
        return levels[wire]

    def statement(wire: str) -> str:
        driver = drivers[wire]
        if isinstance(driver, Instance):
            driven = references(" ".join(driver.outputs.values()))
            declared = [f"    wire {_range(widths[w])}{w};" for w in driven if w not in netlist.ports]
            pins = [f".{port}({value})" for port, value in (driver.inputs | driver.outputs).items()]
            return "\n".join([*declared, _wrapped(f"    {driver.head} (", f"{', '.join(pins)})")])
        text = render(driver) if isinstance(driver, Operation) else widen(driver, widths[wire], widths)
        start = "assign " if wire in netlist.ports else f"wire {_range(widths[wire])}"
        return _wrapped(f"    {start}{wire} = ", text)

    ordered = sorted(drivers, key=lambda wire: (wire in last, level(wire)))
    body = dict.fromkeys(statement(wire) for wire in ordered)
    return "\n".join([f"module {name} (", ",\n".join(ports), ");", *body, "endmodule"]) + "\n"


def _value(text: str) -> Value:
    if match := _UNARY.fullmatch(text) or _BINARY.fullmatch(text) or _MUX.fullmatch(text):
        groups = match.groups()
        operator = next(group for group in groups if group in "~&|^?")
        return Operation(operator, tuple(group for group in groups if group != operator))
    return text


def _instance(match: re.Match[str], parts: Ports) -> Instance:
    pins = {port: close(value) for port, value in _CONNECTION.findall(match["ports"])}
    is_cell = match["module"] not in parts
    if is_cell:
        outputs = [port for port in pins if port in _CELL_OUTPUTS]
        inputs = [port for port in pins if port not in _CELL_OUTPUTS]
    else:
        inputs, outputs = (list(ports) for ports in parts[match["module"]])
    parameters = f" #({match['parameters'].strip()})" if match["parameters"] else ""
    return Instance(
        head=f"{match['attribute'] or ''}{match['module']}{parameters} {match['name']}",
        name=match["name"],
        inputs={port: pins[port] for port in inputs},
        outputs={port: pins[port] for port in outputs},
        is_cell=is_cell,
    )


def _range(width: int) -> str:
    return f"[{width - 1}:0] " if width > 1 else ""


def _wrapped(start: str, text: str) -> str:
    """One statement, broken before operators and after commas where it is too long."""
    lines, line = [], start
    for piece in re.split(r"(?= [&|^] )|(?<=,)(?= )", text):
        if len(line) + len(piece) >= _LINE_LENGTH:
            lines.append(line.rstrip())
            line = " " * 8 + piece.lstrip()
        else:
            line += piece
    return "\n".join([*lines, f"{line};"])
