"""Amaranth components as one readable Verilog-2001 file."""

from collections.abc import Container, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Fragment

from hdl_templates.hierarchy import Emission, Part
from wnn2hdl.emit.expression import constant, range_of
from wnn2hdl.emit.netlist import Module, read_modules, trimmed
from wnn2hdl.emit.packing import packed
from wnn2hdl.emit.statements import UNUSED, Statement, statements

LINT = """\
// Several modules share this file.
/* verilator lint_off DECLFILENAME */
"""

_LINE_LENGTH = 110


def verilog(part: Part, *, prefix: str, header: Sequence[str], pairs: bool = True) -> str:
    """The Verilog of a component and of the parts inside it.

    Args:
        part: what to write.
        prefix: what the names of all modules begin with.
        header: lines of the comment at the top of the file. The text depends on the arguments only.
        pairs: whether two LUTs may share a LUT6_2, a cell of the 7 series.

    Returns:
        Verilog-2001: the parts first, each once, the component last; ports in the order of declaration. A
        component with registers has the clock ``clk``, without a reset.

    Raises:
        NotImplementedError: the component holds a cell for which there is no Verilog, such as a memory.
        ToolError: Yosys is missing or failed.
    """
    emission = Emission(prefix)
    Fragment.get(part, emission)
    parts = {**emission.parts, emission.module(part): part}
    modules = read_modules(
        # Each knows all parts, so that none is elaborated once more for an instance of it.
        [_rtlil(inner, name, Emission(prefix, dict(parts))) for name, inner in parts.items()],
        {name: list(inner.signature.members) for name, inner in parts.items()},
    )
    if foreign := modules.keys() - parts.keys():
        raise NotImplementedError(
            f"{part.module_name} holds {sorted(foreign)}, for which there is no Verilog"
        )
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header)
    return "\n".join(
        [
            comment + LINT,
            *(
                _module(inner, packed(module) if pairs else module)
                for inner, module in ((inner, trimmed(modules[name])) for name, inner in parts.items())
            ),
        ]
    )


def _rtlil(part: Part, name: str, emission: Emission) -> str:
    def missing(domain: str) -> ClockDomain:
        made = ClockDomain(domain, reset_less=True)
        made.clk.name = part.clock
        return made

    text: str = rtlil.convert(part, name=name, platform=emission, emit_src=False, missing_domain=missing)
    return text


def _module(part: Part, module: Module) -> str:
    comment = "".join(f"// {line}\n" for line in part.summary.splitlines())
    attribute = '(* keep_hierarchy = "yes" *)\n' if part.keep_hierarchy else ""
    return comment + attribute + _text(module, part.port_attributes)


def _text(module: Module, attributes: Mapping[str, Mapping[str, str]]) -> str:
    """The module: statements level by level, each wire declared where it is driven, registers first."""
    found, widths = statements(module)
    registers = {statement.drives[0]: statement for statement in found if statement.clock}
    ports = [
        f"{_marks(attributes, port)}    input  wire {range_of(len(bits))}{port}"
        for port, bits in module.inputs.items()
    ]
    ports += [
        f"{_marks(attributes, port)}    {registers[port].marks}output reg  {range_of(len(bits))}{port}"
        if port in registers
        else f"{_marks(attributes, port)}    output wire {range_of(len(bits))}{port}"
        for port, bits in module.outputs.items()
    ]
    # Instances that answer each other have no order: their outputs are declared ahead, and they stand last.
    around = _has_circle(found)
    levels = _levels(found, instances_last=around)
    ordered = sorted(
        (statement for statement in found if not statement.clock),
        key=lambda statement: (
            UNUSED in statement.drives,
            around and bool(statement.head),
            levels[statement.drives[0]],
        ),
    )
    declared = dict.fromkeys(
        [*module.outputs, *(net for x in found if around and x.head for net in x.drives)]
    )
    lines = [_register(registers[net], net, widths) for net in registers if net not in module.outputs]
    lines += [_wire(net, widths) for net in declared if net not in module.outputs]
    lines += [_line(statement, widths, module, declared) for statement in ordered]
    for net, register in registers.items():
        if register.initial is not None:
            lines += _initial(register, net, widths)
        lines.append(_wrapped(f"    always @({register.clock}) ", register.text))
    return "\n".join([f"module {module.name} (", ",\n".join(ports), ");", *lines, "endmodule"]) + "\n"


def _marks(attributes: Mapping[str, Mapping[str, str]], port: str) -> str:
    """The attributes of a port, on a line of their own."""
    texts = [f'{name} = "{value}"' for name, value in attributes.get(port, {}).items()]
    return f"    (* {', '.join(texts)} *)\n" if texts else ""


def _register(register: Statement, net: str, widths: Mapping[str, int]) -> str:
    words = f" [0:{register.words - 1}]" if register.words else ""
    return f"    {register.marks}reg {range_of(widths[net])}{net}{words};"


def _initial(register: Statement, net: str, widths: Mapping[str, int]) -> list[str]:
    assert register.initial is not None
    value = constant(register.initial, widths[net])
    if not register.words:
        return [f"    initial {net} = {value};"]
    count = f"{net}_word"
    loop = f"for ({count} = 0; {count} < {register.words}; {count} = {count} + 1)"
    return [f"    integer {count};", f"    initial {loop} {net}[{count}] = {value};"]


def _wire(net: str, widths: Mapping[str, int]) -> str:
    return f"    wire {range_of(widths[net])}{net};"


def _line(statement: Statement, widths: Mapping[str, int], module: Module, declared: Container[str]) -> str:
    if statement.head:
        wires = [_wire(net, widths) for net in statement.drives if net not in declared]
        return "\n".join([*wires, _wrapped(f"    {statement.head} (", f"{statement.text});")])
    (net,) = statement.drives
    start = "assign " if net in module.outputs else f"wire {range_of(widths[net])}"
    return _wrapped(f"    {start}{net} = ", f"{statement.text};")


def _has_circle(found: Sequence[Statement]) -> bool:
    """Whether statements depend on each other in a circle, which leads through instances."""
    drivers = {net: statement for statement in found for net in statement.drives if not statement.clock}
    graph = {
        id(statement): [id(drivers[net]) for net in statement.reads if net in drivers]
        for statement in drivers.values()
    }
    try:
        TopologicalSorter(graph).prepare()
    except CycleError:
        return True
    return False


def _levels(found: Sequence[Statement], *, instances_last: bool) -> dict[str, int]:
    """How many statements lie between the inputs or registers and each net.

    Args:
        found: the statements.
        instances_last: take what instances drive as inputs.
    """
    drivers = {net: statement for statement in found for net in statement.drives}
    levels: dict[str, int] = {}
    stack = list(drivers)
    while stack:
        net = stack[-1]
        statement = drivers[net]
        first = bool(statement.clock) or (instances_last and bool(statement.head))
        missing = [x for x in statement.reads if x in drivers and x not in levels]
        if first or not missing:
            below = () if first else (levels[x] for x in statement.reads if x in drivers)
            levels |= dict.fromkeys(statement.drives, 1 + max(below, default=0))
            stack.pop()
        else:
            stack += missing
    return levels


def _wrapped(start: str, rest: str) -> str:
    """A statement, broken before operators and after commas where it is too long."""
    chunks: list[str] = []
    for word in rest.split(" "):
        if chunks and chunks[-1] in ("&", "|", "^", "?", ":"):
            chunks[-1] += f" {word}"
        else:
            chunks.append(word)
    lines, line = [], start + chunks[0]
    for chunk in chunks[1:]:
        if len(line) + 1 + len(chunk) >= _LINE_LENGTH:
            lines.append(line)
            line = " " * 8 + chunk
        else:
            line += f" {chunk}"
    return "\n".join([*lines, line])
