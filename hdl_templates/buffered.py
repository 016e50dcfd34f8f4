"""Pictures of one bit per pixel in block RAM: one half is read while the other one is filled."""

from dataclasses import dataclass

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib.memory import Memory

READ_CYCLES = 2
"""From an address to its bit: the memory, and a register behind the multiplexer between block RAMs."""


@dataclass(frozen=True)
class Buffer:
    """Two halves of a memory.

    Attributes:
        ends: whether the pixel that is put is the last one of the half.
        full: whether the half that is filled is complete.
        base: address of the first bit of the half that is read.
        address: to be driven: of the bit that is read.
        bit: the bit, `READ_CYCLES` later.
    """

    ends: Value
    full: Signal
    base: Value
    address: Signal
    bit: Signal


def buffered(
    m: Module,
    name: str,
    size: int,
    *,
    puts: Value,
    pixel: Value,
    first: Value,
    completes: Value,
    swaps: Value,
) -> Buffer:
    """A buffer for pictures of ``size`` pixels.

    Args:
        m: the module under construction.
        name: what the names of its signals begin with.
        size: pixels of a picture.
        puts: whether a pixel is put in.
        pixel: the pixel.
        first: whether it is the first one of a picture; it may be so at any time.
        completes: whether the picture is complete with it.
        swaps: whether the halves change places in this cycle, if the one that is filled is complete.
    """
    memory = Memory(shape=1, depth=2 * size, init=[], attrs={"ram_style": "block"})
    m.submodules[f"{name}_memory"] = memory
    write, read = memory.write_port(), memory.read_port()
    upper, full = Signal(name=f"{name}_upper"), Signal(name=f"{name}_full")
    place = Signal(range(2 * size), name=f"{name}_put_at", reset_less=True)
    address = Signal(range(2 * size), name=f"{name}_read_at", reset_less=True)
    bit = Signal(name=f"{name}_bit", reset_less=True)
    at = Signal(range(2 * size), name=f"{name}_at")
    m.d.comb += [
        at.eq(Mux(first, Mux(upper, size, 0), place)),
        write.addr.eq(at),
        write.data.eq(pixel),
        write.en.eq(puts),
        read.addr.eq(address),
    ]
    m.d.sync += bit.eq(read.data)
    with m.If(puts):
        m.d.sync += place.eq(at + 1)
    with m.If(completes):
        m.d.sync += full.eq(1)
    with m.If(swaps & full):
        m.d.sync += [full.eq(0), upper.eq(~upper)]
    ends = at == Mux(upper, 2 * size - 1, size - 1)
    return Buffer(ends, full, Mux(upper, 0, size), address, bit)
