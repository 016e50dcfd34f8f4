"""The trimmed run counts what the whole `synth_xilinx` counts, and finds the same delay."""

import json
import random
import re
from pathlib import Path

import pytest

from wnn2hdl.synth import OPTIONS, Synthesis, cache, count_cells, synthesise
from wnn2hdl.tools import find_yosys

pytestmark = pytest.mark.slow

WHOLE = f"""\
read_verilog design.v
{OPTIONS} -top {{top}}
tee -q -o stat.json stat -json
setattr -mod -unset keep_hierarchy *
flatten
read_verilog -lib -specify +/xilinx/cells_sim.v
sta
"""


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "cache"))


def require_equal(verilog: str, top: str, folder: Path) -> Synthesis:
    """Synthesise a module both ways and compare cells and delay."""
    folder.mkdir()
    (folder / "design.v").write_text(verilog)
    log = find_yosys().run(WHOLE.format(top=top), cwd=folder, timeout=300)
    statistics = json.loads((folder / "stat.json").read_text())
    inside = {name.removeprefix("\\") for name in statistics["modules"]}
    cells = {
        cell: number
        for cell, number in statistics["design"]["num_cells_by_type"].items()
        if cell not in inside
    }
    latest = re.search(r"^Latest arrival time in '.*' is (\d+):", log, re.MULTILINE)
    trimmed = synthesise(verilog, top)
    delay = int(latest[1]) if latest else None
    if "has no timing arcs!" in log:
        # The whole command leaves nothing to time behind flip-flops; the trimmed run reads their arcs again.
        delay = trimmed.resources.delay_ps
        assert delay is not None
    assert trimmed.resources == count_cells(cells, delay_ps=delay)
    return trimmed


def table(inputs: int) -> str:
    """A random truth table as a `case`, as other tools write them."""
    draw = random.Random(inputs)
    rows = "".join(f"{row}: y = {draw.getrandbits(1)};\n" for row in range(2**inputs))
    return f"""
module design(input [{inputs - 1}:0] x, output reg y);
  always @* case (x)
{rows} endcase
endmodule
"""


def explicit_cells(number: int, *, registers: bool = False) -> str:
    """LUT6 cells of random tables, each fed by inputs and earlier cells; every third with a register."""
    draw = random.Random(number)
    names = [f"x[{place}]" for place in range(64)]
    lines = []
    for cell in range(number):
        pins = ", ".join(f".I{pin}({name})" for pin, name in enumerate(draw.sample(names[-400:], 6)))
        lines.append(
            f'wire t{cell}; (* DONT_TOUCH = "yes" *) LUT6 #(.INIT(64\'h{draw.getrandbits(64):x})) '
            f"c{cell}({pins}, .O(t{cell}));"
        )
        registered = registers and cell % 3 == 0
        if registered:
            lines.append(f"reg r{cell}; always @(posedge clk) r{cell} <= t{cell};")
        names.append(f"r{cell}" if registered else f"t{cell}")
    body = "\n".join(lines)
    outputs = ", ".join(names[-64:])
    return f"""
module design(input clk, input [63:0] x, output [63:0] y);
{body}
  assign y = {{{outputs}}};
endmodule
"""


LOGIC = {
    "wide matcher": """
module design(input [63:0] a, b, input [6:0] least, output y);
  wire [63:0] same = a ~^ b;
  reg [6:0] total; integer place;
  always @* begin total = 0; for (place = 0; place < 64; place = place + 1) total = total + same[place]; end
  assign y = total >= least;
endmodule
""",
    "gradient": """
module design(input [71:0] w, output y);
  wire signed [10:0] gx = w[7:0] + 2 * w[31:24] + w[55:48] - w[23:16] - 2 * w[47:40] - w[71:64];
  wire signed [10:0] gy = w[7:0] + 2 * w[15:8] + w[23:16] - w[55:48] - 2 * w[63:56] - w[71:64];
  assign y = (gx < 0 ? -gx : gx) + (gy < 0 ? -gy : gy) > 128;
endmodule
""",
    "kept hierarchy": """
(* keep_hierarchy = "yes" *)
module same(input [2:0] a, b, output [1:0] n);
  wire [2:0] e = a ~^ b;
  assign n = e[0] + e[1] + e[2];
endmodule
module design(input [8:0] a, b, output [3:0] n);
  wire [1:0] p, q, r;
  same s0(a[2:0], b[2:0], p); same s1(a[5:3], b[5:3], q); same s2(a[8:6], b[8:6], r);
  assign n = p + q + r;
endmodule
""",
    "cells": explicit_cells(60),
}

SEQUENTIAL = {
    "counter": """
module design(input clk, reset, enable, output reg [31:0] n, output y);
  always @(posedge clk) if (reset) n <= 0; else if (enable) n <= n + 1;
  assign y = n == 32'd123456;
endmodule
""",
    "registered cells": explicit_cells(60, registers=True),
}

DELAY_LINE = """
module design(input clk, input [7:0] d, output [7:0] q);
  reg [7:0] m[0:19]; integer place;
  always @(posedge clk) begin
    m[0] <= d;
    for (place = 1; place < 20; place = place + 1) m[place] <= m[place - 1];
  end
  assign q = m[19];
endmodule
"""

MEMORY = """
module design(input clk, write, input [9:0] a, input [15:0] d, output reg [15:0] q);
  reg [15:0] m[0:1023];
  always @(posedge clk) begin if (write) m[a] <= d; q <= m[a]; end
endmodule
"""

MULTIPLIER = """
module design(input clk, input signed [15:0] a, b, output reg signed [31:0] q);
  always @(posedge clk) q <= a * b;
endmodule
"""


@pytest.mark.parametrize("name", LOGIC)
def test_combinational_logic(name: str, tmp_path: Path) -> None:
    assert require_equal(LOGIC[name], "design", tmp_path / "whole").resources.luts > 0


def test_wide_multiplexers_and_a_table_that_becomes_a_memory_first(tmp_path: Path) -> None:
    assert require_equal(table(7), "design", tmp_path / "7").resources.muxf7 > 0
    # Yosys takes such a `case` for a ROM, so that the run with memories is needed.
    assert require_equal(table(10), "design", tmp_path / "10").resources.muxf8 > 0


@pytest.mark.parametrize("name", SEQUENTIAL)
def test_registers(name: str, tmp_path: Path) -> None:
    assert require_equal(SEQUENTIAL[name], "design", tmp_path / "whole").resources.ffs > 0


def test_shift_registers_memories_and_multipliers(tmp_path: Path) -> None:
    assert require_equal(DELAY_LINE, "design", tmp_path / "srl").resources.srl == 8
    assert require_equal(MEMORY, "design", tmp_path / "bram").resources.bram36 == 0.5
    assert require_equal(MULTIPLIER, "design", tmp_path / "dsp").resources.dsp == 1


def test_every_circuit_of_a_build(build: Path, tmp_path: Path) -> None:
    counted = 0
    for verilog in (path.read_text() for path in sorted(build.glob("*.v"))):
        for top in re.findall(r"^module ([a-z]\w*)", verilog, re.MULTILINE):
            if "$finish" not in verilog:
                counted += require_equal(verilog, top, tmp_path / top).resources.luts
    assert counted > 100


def test_two_thousand_cells() -> None:
    resources = synthesise(explicit_cells(2000, registers=True), "design").resources
    assert resources.luts > 1900
    assert resources.ffs > 600
    assert resources.delay_ps is not None
