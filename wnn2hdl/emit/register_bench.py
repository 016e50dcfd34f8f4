"""The part of a testbench that reads and writes the registers of a core, in plain Verilog-2001.

It belongs into a module that has the task ``step``, a cycle of the clock in which the streams go on, so that
registers are used while frames run. Accesses are kept in a memory, since Verilator makes a copy of a task
wherever it is called.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from wnn2hdl.ir.registers import RegisterMap

_PATIENCE = 256
"""Cycles without an answer that show a bus that is stuck."""

OKAY, SLVERR = 0, 2


@dataclass(frozen=True)
class Access:
    """An access to a register.

    Attributes:
        writes: whether it is written.
        offset: its address in bytes.
        value: what is written, or has to be read.
        answer: what the bus has to say: `OKAY` or `SLVERR`, with which what is read does not matter.
    """

    writes: bool
    offset: int
    value: int
    answer: int = OKAY

    def statement(self, number: int) -> str:
        """The statement that puts it into the memory."""
        word = ((self.writes << 2 | self.answer) << 12 | self.offset) << 32 | self.value
        return f"        script[{number}] = 47'h{word:012x};\n"


_SIGNALS = """\
    // Accesses to registers: whether it is a write, the answer of the bus, address and value.
    reg [46:0] script [0:{last}];
    reg [11:0] address = 12'd0;
    reg [31:0] value = 32'd0;
    reg [1:0] answer = 2'd0;
    reg writes = 1'b0, awvalid = 1'b0, wvalid = 1'b0, arvalid = 1'b0, takes_answer = 1'b0;
    reg busy = 1'b0, denied = 1'b0;
    reg written, asked, answered;
    wire awready, wready, bvalid, arready, rvalid, irq;
    wire [1:0] bresp, rresp;
    wire [31:0] rdata;
    integer access, patience;
"""

_TASKS = """\
    // One access, while the streams go on.
    task use_register;
        begin
            busy = 1'b1;
            awvalid = writes;
            wvalid = writes;
            arvalid = !writes;
            for (patience = 0; busy && patience < {patience}; patience = patience + 1) step;
            if (busy) refuse;
        end
    endtask

    task refuse;
        begin
            if (!denied) begin
                $display("FAIL: {name}, register %h", address);
                $display("  read %h, responses %0d and %0d, expected %h and %0d",
                    rdata, bresp, rresp, value, answer);
            end
            denied = 1'b1;
        end
    endtask
"""

SAMPLED = """\
            written = awvalid && awready;
            asked = arvalid && arready;
            answered = takes_answer && (writes ? bvalid : rvalid);
            if (answered && (writes ? bresp !== answer
                : rresp !== answer || (answer == 2'd0 && rdata !== value))) refuse;
"""
"""Statements of ``step`` before the edge of the clock."""

CLOCKED = """\
            if (written) awvalid = 1'b0;
            if (written) wvalid = 1'b0;
            if (asked) arvalid = 1'b0;
            if (answered) busy = 1'b0;
            takes_answer = random[12];
"""
"""Statements of ``step`` behind the edge of the clock."""


PAUSES = """\
            // Xorshift: pauses of no pattern. A beat that is offered stays until it is taken.
            random = random ^ (random << 13);
            random = random ^ (random >> 17);
            random = random ^ (random << 5);
"""
"""Statements of ``step`` that draw the bits by which streams and bus pause."""

RESET = """\
        repeat (4) begin
            #1 aclk = 1'b1;
            #1 aclk = 1'b0;
        end
        aresetn = 1'b1;
"""
"""Statements that reset the core."""


def bus_signals(count: int) -> str:
    """Declarations of the bus, of ``irq``, of so many accesses, and of ``denied``: whether one was wrong."""
    return _SIGNALS.format(last=count - 1)


def bus_tasks(name: str) -> str:
    """The task ``use_register``, which makes the access of ``writes, answer, address, value``."""
    return _TASKS.format(name=name, patience=_PATIENCE)


def filled(script: Sequence[Access]) -> str:
    """Statements that fill the memory of accesses."""
    return "".join(access.statement(number) for number, access in enumerate(script))


def used(first: int, last: int, before_each: str = "") -> str:
    """Statements that make the accesses from one to before another, with statements before each."""
    return f"""\
        for (access = {first}; access < {last}; access = access + 1) begin
{before_each}            {{writes, answer, address, value}} = script[access];
            use_register;
        end
"""


def bus_ports() -> list[str]:
    """The connections of the core's ports."""
    wires = {
        "awaddr": "address",
        "wdata": "value",
        "wstrb": "4'hf",
        "araddr": "address",
        "bready": "takes_answer",
        "rready": "takes_answer",
    }
    channels = (
        ("aw", ("addr", "valid", "ready")),
        ("w", ("data", "strb", "valid", "ready")),
        ("b", ("resp", "valid", "ready")),
        ("ar", ("addr", "valid", "ready")),
        ("r", ("data", "resp", "valid", "ready")),
    )
    ports = [f"{channel}{signal}" for channel, signals in channels for signal in signals]
    return [f"        .s_axi_control_{port}({wires.get(port, port)})" for port in ports] + [
        "        .irq(irq)"
    ]


def write(registers: RegisterMap, name: str, value: int) -> Access:
    """A write to a register."""
    return Access(True, registers.register(name).offset, value)


def read(registers: RegisterMap, name: str, value: int) -> Access:
    """A read from a register, and what it has to hold."""
    return Access(False, registers.register(name).offset, value)


def identified(registers: RegisterMap) -> list[Access]:
    """Reads of the constants of a core, and tries of what is not allowed."""
    accesses = []
    for register in registers.registers:
        if all(field.access == "constant" for field in register.fields):
            word = sum(field.value << field.low for field in register.fields)
            accesses.append(Access(False, register.offset, word))
            accesses.append(Access(True, register.offset, 0xFFFFFFFF, SLVERR))
    beyond = registers.registers[-1].offset + 4
    return accesses + [Access(writes, at, 0, SLVERR) for at in (beyond, 0xFFC) for writes in (False, True)]
