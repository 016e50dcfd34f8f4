"""A testbench that checks itself against the model's answers, in plain Verilog-2001."""

from collections.abc import Mapping, Sequence

import numpy as np
from amaranth.lib.wiring import Component
from numpy.typing import NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.vectors import pack, port_widths
from wnn2hdl.emit.expression import range_of

Arrays = Mapping[str, NDArray[np.bool_]]
"""Values of ports by name: bool ``[vectors, width]``, the least significant bit first."""


def vectors(component: Component, inputs: Arrays, expected: Arrays) -> str:
    """The vectors of a testbench, in the format of ``$readmemh``: one hexadecimal number per line.

    Args:
        component: the circuit under test.
        inputs: for each input port its values.
        expected: for each output port the model's answers.

    Returns:
        Lines with the ports side by side in the order of declaration, the first in the highest bits.

    Raises:
        ValueError: the arrays do not fit the ports.
    """
    packed_inputs, packed_outputs = pack(component, inputs, expected)
    widths = {name: width for ports in port_widths(component) for name, width in ports.items()}
    columns = [(widths[name], values) for name, values in (packed_inputs | packed_outputs).items()]
    digits = -(-sum(widths.values()) // 4)
    lines = []
    for row in zip(*(values for _, values in columns), strict=True):
        word = 0
        for (width, _), value in zip(columns, row, strict=True):
            word = word << width | value
        lines.append(f"{word:0{digits}x}\n")
    return "".join(lines)


def testbench(part: Part, *, name: str, count: int, vectors_file: str, sources: Sequence[str]) -> str:
    """A self-checking testbench ``NAME_tb`` for the module ``NAME``.

    It applies a vector in each cycle and compares the outputs `Part.latency` cycles later. It reads its
    vectors from the folder it is started in, prints ``PASS`` and their number, or ``FAIL`` with the inputs,
    the actual and the expected outputs of the first mismatch (unknown bits are one) and stops. A failing run
    ends with ``$stop``: a status other than 0 from Verilator's program and from ``vvp -N``; plain ``vvp``
    asks what to do. ``$fatal`` would need SystemVerilog.

    Args:
        part: the circuit under test, for its ports and its latency.
        name: its module.
        count: how many vectors the file holds.
        vectors_file: name of the file with the `vectors`, without a folder.
        sources: names of the Verilog files of the circuit, for the comment that says how to run it.
    """
    inputs, outputs = port_widths(part)
    latency = part.latency
    # What is compared lags behind what is applied; they are one vector where there is no latency.
    applied, words, checked, apply, ready = "vector", "vector", "i", "", ""
    if latency:
        applied, words, checked = "applied", "applied, vector", f"i < {latency} ? 0 : i - {latency}"
        apply = f"            applied = vectors[i < {count} ? i : {count - 1}];\n"
        ready = f"i >= {latency} && "
    total = sum(inputs.values()) + sum(outputs.values())
    fields = _fields(inputs | outputs, total)
    clock = ["clk"] if part.clocked else []
    connections = ",\n".join(f"        .{port}({port})" for port in (*clock, *inputs, *outputs))
    wires = "\n".join(
        ["    reg clk = 1'b0;" for _ in clock]
        + [f"    wire {range_of(width)}{port} = {applied}[{fields[port]}];" for port, width in inputs.items()]
        + [f"    wire {range_of(width)}{port};" for port, width in outputs.items()]
        + [
            f"    wire {range_of(width)}{port}_expected = vector[{fields[port]}];"
            for port, width in outputs.items()
        ]
    )
    differs = "\n                || ".join(f"{port} !== {port}_expected" for port in outputs)
    shown = "\n".join(
        [f'                $display("  {port} = %h", vector[{fields[port]}]);' for port in inputs]
        + [
            f'                $display("  {port} = %h, expected %h", {port}, {port}_expected);'
            for port in outputs
        ]
    )
    edges = "            clk = 1'b1;\n            #1 clk = 1'b0;\n" if part.clocked else ""
    files = " ".join([*sources, f"{name}_tb.v"])
    return f"""\
// Checks {name} against {count} answers of the model; run it in this folder,
// with Icarus:    iverilog -o {name}_tb {files} && vvp -N {name}_tb
// with Verilator: verilator --binary --top-module {name}_tb {files} && obj_dir/V{name}_tb
module {name}_tb;
    reg [{total - 1}:0] vectors [0:{count - 1}];
    reg [{total - 1}:0] {words};
    integer i;
{wires}

    {name} dut (
{connections}
    );

    initial begin
        $readmemh("{vectors_file}", vectors);
        for (i = 0; i < {count + latency}; i = i + 1) begin
{apply}            vector = vectors[{checked}];
            #1;
            // A vector with unknown bits was not read: the file is missing or too short.
            if ({ready}(^{{{words}}} === 1'bx
                || {differs})) begin
                $display("FAIL: {name}, vector %0d of {count}", {checked});
{shown}
                $stop;
                $finish;
            end
{edges}        end
        $display("PASS: {name}, {count} vectors");
        $finish;
    end
endmodule
"""


def _fields(widths: Mapping[str, int], total: int) -> dict[str, str]:
    fields, top = {}, total
    for port, width in widths.items():
        fields[port] = f"{top - 1}:{top - width}" if width > 1 else str(top - 1)
        top -= width
    return fields
