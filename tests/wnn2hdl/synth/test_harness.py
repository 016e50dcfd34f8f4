"""Harnesses, simulated around small circuits."""

from pathlib import Path

import pytest

from wnn2hdl.synth.harness import Ports, harness
from wnn2hdl.tools import run_icarus

ADDER = """\
module adder (input wire [3:0] a, input wire b, output wire [3:0] sum, output wire odd);
    assign sum = a + b;
    assign odd = sum[0];
endmodule
"""
PORTS = Ports({"a": 4, "b": 1}, {"sum": 4, "odd": 1})

REGISTERS = """\
module bench;
    reg clk = 0; reg [3:0] a = 6; reg b = 1; wire [3:0] sum; wire odd;
    top dut (.clk(clk), .a(a), .b(b), .sum(sum), .odd(odd));
    initial begin
        repeat (2) begin #1 clk = 1; #1 clk = 0; end
        if (sum !== 7 || odd !== 1) $fatal(1, "%d %b", sum, odd);
        a = 8;
        #1 clk = 1; #1 clk = 0;
        if (sum !== 7) $fatal(1, "early");
        #1 clk = 1; #1 clk = 0;
        if (sum !== 9) $fatal(1, "late");
        $finish;
    end
endmodule
"""

SHIFTED = """\
module bench;
    reg clk = 0, in = 0, load = 0; wire out; integer i; reg [4:0] word, answer;
    top dut (.clk(clk), .shift_in(in), .load(load), .shift_out(out));
    initial begin
        word = {1'b1, 4'd6};
        for (i = 4; i >= 0; i = i - 1) begin in = word[i]; #1 clk = 1; #1 clk = 0; end
        #1 clk = 1; #1 load = 1;
        #1 clk = 0;
        #1 clk = 1; #1 clk = 0; load = 0;
        for (i = 0; i < 5; i = i + 1) begin answer[i] = out; #1 clk = 1; #1 clk = 0; end
        if (answer !== {1'b1, 4'd7}) $fatal(1, "%b", answer);
        $finish;
    end
endmodule
"""


def simulate(folder: Path, *texts: str) -> None:
    sources = []
    for number, text in enumerate(texts):
        sources.append(folder / f"{number}.v")
        sources[-1].write_text(text)
    run_icarus(sources, "bench", cwd=folder, timeout=60)


@pytest.mark.simulator
def test_registers_stand_behind_inputs_and_before_outputs(tmp_path: Path) -> None:
    made = harness("top", "adder", PORTS, pins=11, registered=True)
    assert made.kind == "registers"
    simulate(tmp_path, ADDER, made.verilog, REGISTERS)


@pytest.mark.simulator
def test_inputs_and_answers_are_shifted_where_pins_are_few(tmp_path: Path) -> None:
    made = harness("top", "adder", PORTS, pins=10, registered=True)
    assert (made.kind, made.pins) == ("shift registers", ("clk", "shift_in", "load", "shift_out"))
    simulate(tmp_path, ADDER, made.verilog, SHIFTED)


def test_ports_of_a_stream_are_pins_and_the_clock_is_the_first() -> None:
    ports = Ports({"data": 2}, {"ready": 1}, clock="aclk")
    made = harness("top", "core", ports, pins=40, registered=False)
    assert (made.kind, made.pins) == ("none", ("aclk", "data[0]", "data[1]", "ready"))
    assert ".aclk(aclk)" in made.verilog
    assert "reg" not in made.verilog
