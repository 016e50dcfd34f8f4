"""Groups of ports: what they are to Vivado's IP Integrator (AMD UG1118), and how parts pass them on."""

from collections.abc import Iterable, Sequence

from amaranth.hdl import Module
from amaranth.lib.wiring import In

from hdl_templates.hierarchy import Part

_AXIS, _AXI_LITE = "xilinx.com:interface:axis:1.0", "xilinx.com:interface:aximm:1.0"
_RESET, _INTERRUPT = "aresetn", "irq"


def vivado_interfaces(
    part: Part, *, streams: Sequence[str], bus: str | None = None
) -> dict[str, dict[str, str]]:
    """The attributes of a part's ports, see `Part.port_attributes`.

    Args:
        part: with the reset ``aresetn`` and, where it has a bus, the interrupt ``irq``.
        streams: AXI4-Streams, by what the names of their ports begin with.
        bus: AXI4-Lite, likewise.
    """
    groups = {**dict.fromkeys(streams, _AXIS), **({} if bus is None else {bus: _AXI_LITE})}
    attributes = {
        part.clock: {
            "X_INTERFACE_INFO": f"xilinx.com:signal:clock:1.0 {part.clock} CLK",
            "X_INTERFACE_PARAMETER": f"ASSOCIATED_BUSIF {':'.join(groups)}, ASSOCIATED_RESET {_RESET}",
        },
        _RESET: {
            "X_INTERFACE_INFO": f"xilinx.com:signal:reset:1.0 {_RESET} RST",
            "X_INTERFACE_PARAMETER": "POLARITY ACTIVE_LOW",
        },
    }
    for group, kind in groups.items():
        for port in ports_of(part, group):
            attributes[port] = {
                "X_INTERFACE_INFO": f"{kind} {group} {port.removeprefix(f'{group}_').upper()}"
            }
    if bus is not None:
        # Of one port for all.
        attributes[ports_of(part, bus)[0]]["X_INTERFACE_PARAMETER"] = "PROTOCOL AXI4LITE"
        attributes[_INTERRUPT] = {
            "X_INTERFACE_INFO": f"xilinx.com:signal:interrupt:1.0 {_INTERRUPT} INTERRUPT",
            "X_INTERFACE_PARAMETER": "SENSITIVITY LEVEL_HIGH",
        }
    return attributes


def ports_of(part: Part, group: str) -> list[str]:
    """The ports of a group."""
    return [port for port in part.signature.members if port.startswith(f"{group}_")]


def pass_on(m: Module, outer: Part, inner: Part, ports: Iterable[str]) -> None:
    """Connect ports of a part with those of the same names of one inside it."""
    for port in ports:
        outside, inside = getattr(outer, port), getattr(inner, port)
        is_input = inner.signature.members[port].flow == In
        m.d.comb += inside.eq(outside) if is_input else outside.eq(inside)
