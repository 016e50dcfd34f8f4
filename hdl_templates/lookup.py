"""LUT networks in hardware: as vendor cells, or as equations that a synthesiser may restructure."""

from collections import Counter
from collections.abc import Sequence

from amaranth.hdl import Cat, Const, Instance, Module, Mux, Signal, Value

from hdl_templates.boolean import expression
from hdl_templates.hierarchy import Emission
from wnn2hdl.ir import CONSTANTS, Lut, LutNetwork, Style
from wnn2hdl.ir import Mux as MuxCell
from wnn2hdl.ir.equation import equation

KEEP = {"a_DONT_TOUCH": "yes"}
"""Attribute that keeps Vivado from merging or restructuring a cell (Xilinx UG901)."""


def draw_network(
    m: Module,
    network: LutNetwork,
    bits: Sequence[Value],
    *,
    style: Style,
    prefix: str,
    platform: object,
) -> list[Value]:
    """Draw a network; combinational, latency 0 cycles.

    Args:
        m: the module under construction.
        network: the network.
        bits: a value of one bit for each of its inputs.
        style: how it is written.
        prefix: what the names of its signals begin with.
        platform: the platform of ``m``.

    Returns:
        A value of one bit for each output.
    """
    signals: dict[str, Value] = dict(zip(network.inputs, bits, strict=True))
    signals |= {name: Const(value, 1) for value, name in enumerate(CONSTANTS)}
    muxes = {cell.name for cell in network.muxes}
    reads, outputs = _reads(network), {signal for _, signal in network.outputs}
    for cell in network.cells:
        if cell.name not in reads:
            continue
        pins = [signals[name] for name in cell.reads]
        if not isinstance(platform, Emission):
            value = _simulated(cell, pins)
            # A signal costs Amaranth's simulator more than a look-up; but others may read an output often.
            if reads[cell.name] == 1 and cell.name not in outputs:
                signals[cell.name] = value
                continue
            signals[cell.name] = shared = Signal(name=f"{prefix}{cell.name}")
            m.d.comb += shared.eq(value)
            continue
        signals[cell.name] = output = Signal(name=f"{prefix}{cell.name}")
        if style == "cells":
            m.submodules[f"{prefix}{cell.name}_cell"] = _instance(cell, pins, output, muxes)
        elif isinstance(cell, Lut):
            m.d.comb += output.eq(expression(equation(cell.init, len(pins)), pins))
        else:
            low, high, select = pins
            m.d.comb += output.eq(Mux(select, high, low))
    return [signals[signal] for _, signal in network.outputs]


def unread_inputs(network: LutNetwork) -> list[int]:
    """Positions of the inputs that nothing reads."""
    reads = _reads(network)
    return [position for position, name in enumerate(network.inputs) if name not in reads]


def _reads(network: LutNetwork) -> Counter[str]:
    """How often each signal is read on the way to an output."""
    counts = Counter(signal for _, signal in network.outputs)
    for cell in reversed(network.cells):
        if cell.name in counts:
            counts.update(cell.reads)
    return counts


def _simulated(cell: Lut | MuxCell, pins: Sequence[Value]) -> Value:
    if isinstance(cell, Lut):
        return Const(cell.init, 1 << len(pins)).bit_select(Cat(*pins), 1)
    low, high, select = pins
    return Mux(select, high, low)


def _instance(cell: Lut | MuxCell, pins: Sequence[Value], output: Signal, muxes: set[str]) -> Instance:
    if isinstance(cell, Lut):
        width = len(pins)
        inputs = {f"i_I{i}": pin for i, pin in enumerate(pins)}
        return Instance(f"LUT{width}", p_INIT=Const(cell.init, 1 << width), **inputs, o_O=output, **KEEP)
    low, high, select = pins
    kind = "MUXF8" if cell.low in muxes else "MUXF7"
    return Instance(kind, i_I0=low, i_I1=high, i_S=select, o_O=output, **KEEP)
