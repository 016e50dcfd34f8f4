"""Registers behind AXI4-Lite (Arm IHI 0022), made from their description in `wnn2hdl.ir.registers`."""

from collections.abc import Mapping
from itertools import zip_longest
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, ResetInserter, Signal, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part
from hdl_templates.ports import tie_off
from wnn2hdl.ir.registers import ADDRESS_BITS, DATA_BITS, Field, Register, RegisterMap

BUS = "s_axi_control"
"""What the names of the bus's ports begin with."""

_OKAY, _SLVERR = 0, 2
_BYTE_BITS = (DATA_BITS // 8 - 1).bit_length()
"""Bits of an address that say which byte of a register is meant; they are ignored."""

_ZERO = Const(0, DATA_BITS)

_FROM_CORE = ("status", "event")


def bus_members() -> dict[str, Any]:
    """The ports of the bus, by name."""
    strobes = DATA_BITS // 8
    return {
        f"{BUS}_awaddr": In(ADDRESS_BITS),
        f"{BUS}_awvalid": In(1),
        f"{BUS}_awready": Out(1),
        f"{BUS}_wdata": In(DATA_BITS),
        f"{BUS}_wstrb": In(strobes),
        f"{BUS}_wvalid": In(1),
        f"{BUS}_wready": Out(1),
        f"{BUS}_bresp": Out(2),
        f"{BUS}_bvalid": Out(1),
        f"{BUS}_bready": In(1),
        f"{BUS}_araddr": In(ADDRESS_BITS),
        f"{BUS}_arvalid": In(1),
        f"{BUS}_arready": Out(1),
        f"{BUS}_rdata": Out(DATA_BITS),
        f"{BUS}_rresp": Out(2),
        f"{BUS}_rvalid": Out(1),
        f"{BUS}_rready": In(1),
    }


class AxiLiteRegisters(Part):
    """Registers behind AXI4-Lite, with an interrupt.

    A write is taken in one cycle, once its address and its data have both come, in whatever order, and the
    answer to the one before was taken. Nothing depends on the bus without a register in between. Addresses
    without a register, and writes to registers that can only be read, are answered with SLVERR.

    Args:
        registers: their description; ``interrupt`` and ``interrupt_enable`` are among them.

    Members:
        aresetn: In, synchronous reset, active low.
        s_axi_control_*: the bus.
        irq: Out, whether an event has happened that is enabled, and was not cleared.
        REGISTER_FIELD: In for a status; In for an event that happens now, which its own clearing does not
            make undone; Out for a setting, and for one cycle for an action.
        REGISTER_FIELD_waits: Out, whether an event was not cleared yet.
    """

    clocked = True
    clock = "aclk"
    module_name = "control"

    def __init__(self, *, registers: RegisterMap) -> None:
        self.registers = registers
        members: dict[str, Any] = {"aresetn": In(1), **bus_members(), "irq": Out(1)}
        for register, field in registers:
            signal = register.signal(field)
            if field.access != "constant":
                members[signal] = (In if field.access in _FROM_CORE else Out)(field.width)
            if field.access == "event":
                members[f"{signal}_waits"] = Out(field.width)
        super().__init__(members)

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        lines = [f"Registers of a {self.registers.core}, behind AXI4-Lite:"]
        lines += [f"  0x{register.offset:02x} {register.name}" for register in self.registers.registers]
        return "\n".join(lines)

    def elaborate(self, platform: object) -> Any:
        """Both channels, and the fields that can be written."""
        m = Module()
        reset = Signal()
        m.d.comb += reset.eq(~self.aresetn)
        written = self._writes(m)
        self._reads(m)
        for register, field in self.registers:
            if field.access in ("setting", "event", "action"):
                self._field(m, register.signal(field), field, written[register.name])
        waits = self.registers.register("interrupt")
        enabled = self.registers.register("interrupt_enable")
        m.d.comb += self.irq.eq(
            Cat(
                getattr(self, f"{waits.signal(event)}_waits") & getattr(self, enabled.signal(setting))
                for event, setting in zip(waits.fields, enabled.fields, strict=True)
            ).any()
        )
        tie_off(m, [self._bus(name)[:_BYTE_BITS] for name in ("awaddr", "araddr")], platform)
        return ResetInserter(reset)(m)

    def _bus(self, name: str) -> Signal:
        signal: Signal = getattr(self, f"{BUS}_{name}")
        return signal

    def _writes(self, m: Module) -> Mapping[str, Value]:
        """The channels of writes; for each register that can be written whether it is."""
        takes = Signal(name="takes_write")
        answers, response = self._bus("bvalid"), self._bus("bresp")
        m.d.comb += [self._bus("awready").eq(takes), self._bus("wready").eq(takes)]
        m.d.sync += takes.eq(
            self._bus("awvalid") & self._bus("wvalid") & ~takes & (~answers | self._bus("bready"))
        )
        writable = [register for register in self.registers.registers if register.writable]
        hits = {register.name: Signal(name=f"writes_{register.name}") for register in writable}
        for register in writable:
            m.d.comb += hits[register.name].eq(takes & _addressed(self._bus("awaddr"), register))
        with m.If(self._bus("bready")):
            m.d.sync += answers.eq(0)
        with m.If(takes):
            m.d.sync += [answers.eq(1), response.eq(Mux(Cat(*hits.values()).any(), _OKAY, _SLVERR))]
        return hits

    def _reads(self, m: Module) -> None:
        """The channels of reads."""
        takes = Signal(name="takes_read")
        answers = self._bus("rvalid")
        m.d.comb += self._bus("arready").eq(takes)
        m.d.sync += takes.eq(self._bus("arvalid") & ~takes & (~answers | self._bus("rready")))
        place = self._bus("araddr")[_BYTE_BITS:]
        words = [self._word(register) for register in self.registers.registers]
        count = len(words)
        # A tree by the bits of the address takes fewer LUTs than a choice by what is addressed.
        for bit in range((count - 1).bit_length()):
            words = [
                Mux(place[bit], high, low)
                for low, high in zip_longest(words[::2], words[1::2], fillvalue=_ZERO)
            ]
        with m.If(self._bus("rready")):
            m.d.sync += answers.eq(0)
        with m.If(takes):
            m.d.sync += [
                answers.eq(1),
                self._bus("rdata").eq(words[0]),
                self._bus("rresp").eq(Mux(place < count, _OKAY, _SLVERR)),
            ]

    def _word(self, register: Register) -> Value:
        """What is read from a register."""
        parts: list[Value] = []
        for field in register.fields:
            parts.append(Const(0, field.low - sum(map(len, parts))))
            if field.access in ("constant", "action"):
                value: Value = Const(field.value, field.width)
            else:
                name = register.signal(field)
                value = getattr(self, f"{name}_waits" if field.access == "event" else name)
            parts.append(value)
        return Cat(*parts, Const(0, DATA_BITS - sum(map(len, parts))))

    def _field(self, m: Module, name: str, field: Field, written: Value) -> None:
        """What a write does to a field; each byte has its strobe."""
        places = slice(field.low, field.low + field.width)
        data = self._bus("wdata")[places]
        strobes = Cat(strobe.replicate(8) for strobe in self._bus("wstrb"))[places]
        kept: Signal = getattr(self, name)
        ones = data & strobes & written.replicate(field.width)
        if field.access == "setting":
            with m.If(written):
                m.d.sync += kept.eq((data & strobes) | (kept & ~strobes))
        elif field.access == "action":
            m.d.sync += kept.eq(ones)
        else:
            waits: Signal = getattr(self, f"{name}_waits")
            m.d.sync += waits.eq((waits & ~ones) | kept)


def _addressed(address: Value, register: Register) -> Value:
    """Whether an address is that of a register."""
    return address[_BYTE_BITS:] == register.offset >> _BYTE_BITS
