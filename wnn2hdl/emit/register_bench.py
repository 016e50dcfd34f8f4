"""The part of a testbench that reads and writes the registers of a core, in plain Verilog-2001.

It belongs into a module that has the task ``step``, a cycle of the clock in which the streams go on, so that
registers are used while frames run.
"""

from wnn2hdl.ir.registers import RegisterMap

_PATIENCE = 64
"""Cycles without an answer that show a bus that is stuck."""

_SIGNALS = """\
    reg [11:0] address = 12'd0;
    reg [31:0] value = 32'd0;
    reg awvalid = 1'b0, wvalid = 1'b0, bready = 1'b0, arvalid = 1'b0, rready = 1'b0;
    wire awready, wready, bvalid, arready, rvalid, irq;
    wire [1:0] bresp, rresp;
    wire [31:0] rdata;
    integer patience;
    reg denied = 1'b0;
"""

_TASKS = """\
    // Writes a register; what the bus has to answer is 0, or 2 for an error.
    task write(input [11:0] at, input [31:0] word, input [1:0] answer);
        begin
            address = at;
            value = word;
            awvalid = 1'b1;
            step;
            wvalid = 1'b1;
            for (patience = 0; awready !== 1'b1 && patience < {patience}; patience = patience + 1) step;
            step;
            awvalid = 1'b0;
            wvalid = 1'b0;
            for (patience = 0; bvalid !== 1'b1 && patience < {patience}; patience = patience + 1) step;
            if (bvalid !== 1'b1 || bresp !== answer) refuse;
            bready = 1'b1;
            step;
            bready = 1'b0;
        end
    endtask

    // Reads a register and compares it; what is read with an error does not matter.
    task read(input [11:0] at, input [31:0] word, input [1:0] answer);
        begin
            address = at;
            arvalid = 1'b1;
            for (patience = 0; arready !== 1'b1 && patience < {patience}; patience = patience + 1) step;
            step;
            arvalid = 1'b0;
            for (patience = 0; rvalid !== 1'b1 && patience < {patience}; patience = patience + 1) step;
            if (rvalid !== 1'b1 || rresp !== answer || (answer == 2'd0 && rdata !== word)) refuse;
            rready = 1'b1;
            step;
            rready = 1'b0;
        end
    endtask

    task refuse;
        begin
            if (!denied) begin
                $display("FAIL: {name}, register %h", address);
                $display("  read %h, responses %0d and %0d", rdata, bresp, rresp);
            end
            denied = 1'b1;
        end
    endtask
"""


def bus_signals() -> str:
    """Declarations of the bus, of the interrupt ``irq``, and of ``denied``: whether a register was wrong."""
    return _SIGNALS


def bus_tasks(name: str) -> str:
    """The tasks ``write`` and ``read`` for the core of a name."""
    return _TASKS.format(name=name, patience=_PATIENCE)


def bus_ports() -> list[str]:
    """The connections of the core's ports."""
    wires = {"awaddr": "address", "wdata": "value", "wstrb": "4'hf", "araddr": "address"}
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


def offset(registers: RegisterMap, name: str) -> str:
    """The address of a register, as a constant."""
    return f"12'h{registers.register(name).offset:03x}"


def identified(registers: RegisterMap) -> str:
    """Statements that read the constants of a core, and try what is not allowed."""
    lines = []
    for register in registers.registers:
        if all(field.access == "constant" for field in register.fields):
            word = sum(field.value << field.low for field in register.fields)
            lines.append(f"read(12'h{register.offset:03x}, 32'h{word:08x}, 2'd0);")
            lines.append(f"write(12'h{register.offset:03x}, 32'hffffffff, 2'd2);")
    beyond = registers.registers[-1].offset + 4
    lines += [f"read(12'h{at:03x}, 32'h0, 2'd2);" for at in (beyond, 0xFFC)]
    lines += [f"write(12'h{at:03x}, 32'hffffffff, 2'd2);" for at in (beyond, 0xFFC)]
    return "".join(f"        {line}\n" for line in lines)
