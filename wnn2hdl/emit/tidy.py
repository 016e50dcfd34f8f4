"""Making a module that Amaranth's back end wrote readable; what it computes does not change."""

import re

from wnn2hdl.emit.expression import Operation
from wnn2hdl.emit.netlist import NAME, Netlist

_BIT = re.compile(rf"({NAME})\[\d+\]")

UNUSED = "unused"
"""The wire that gathers what nothing reads; it stays although nothing reads it either."""


def tidy(netlist: Netlist) -> None:
    """In place: names given to bits come back, temporaries go where they are used, names become plain."""
    _restore_aliases(netlist)
    _drop_unread(netlist)
    _inline(netlist)
    _drop_unread(netlist)
    netlist.rename(_plain_names(netlist))


def _restore_aliases(netlist: Netlist) -> None:
    """Amaranth looks through names given to bits of a port, and through outputs put together: use them."""
    reads, kept = netlist.reads(), {*netlist.ports, UNUSED}
    bits: dict[str, str] = {}
    joined: dict[str, str] = {}
    for wire, value in netlist.assigns.items():
        if not isinstance(value, str):
            continue
        bit = _BIT.fullmatch(value)
        if bit and bit[1] in netlist.ports and wire not in kept and "$" not in wire and not reads[wire]:
            bits[value] = wire
        elif value.startswith("{") and wire in netlist.ports:
            joined[value] = wire
    netlist.rewrite(
        lambda text: _BIT.sub(lambda match: bits.get(match[0], match[0]), text), spare=bits.values()
    )
    netlist.rewrite(lambda text: joined.get(text, text), spare=joined.values())


def _drop_unread(netlist: Netlist) -> None:
    kept = {*netlist.ports, UNUSED}
    while True:
        reads = netlist.reads()
        unread = [wire for wire in netlist.assigns if wire not in kept and not reads[wire]]
        if not unread:
            return
        for wire in unread:
            del netlist.assigns[wire]


def _inline(netlist: Netlist) -> None:
    """Put temporaries that are read once, and inverters, where they are read.

    Only operations of one bit go into operations of one bit: there a Verilog expression means the same in any
    context.
    """
    reads = netlist.reads()

    def expand(value: Operation) -> Operation:
        operands: list[Operation | str] = []
        for operand in value.operands:
            name = operand if isinstance(operand, str) else ""
            inner = netlist.assigns.get(name) if name.startswith("$") else None
            if isinstance(inner, Operation) and (reads[name] == 1 or inner.operator == "~"):
                operands.append(expand(inner))
            else:
                operands.append(operand)
        return Operation(value.operator, tuple(operands)).flat()

    for wire, value in list(netlist.assigns.items()):
        if isinstance(value, Operation) and netlist.widths[wire] == 1:
            netlist.assigns[wire] = expand(value)


def _plain_names(netlist: Netlist) -> dict[str, str]:
    """Wires between parts take the name of what drives them; numbers after a ``$`` go."""
    wanted: dict[str, str] = {}
    for instance in netlist.instances:
        for port, wire in instance.outputs.items():
            wanted[wire] = wire if instance.is_cell else f"{instance.name}_{port}"
    for wire in netlist.assigns:
        wanted[wire] = f"term_{wire[1:]}" if wire.startswith("$") else wire
    names: dict[str, str] = {}
    used = set(netlist.ports)
    for wire, name in wanted.items():
        if wire in netlist.ports:
            continue
        plain = base = name.replace("$", "_")
        number = 0
        while plain in used:
            number += 1
            plain = f"{base}_{number}"
        used.add(plain)
        names[wire] = plain
    return names
