"""Match-and-count and Sobel in LUTs, against plain writings through the same Yosys in the same run.

``python benchmarks/matchers.py``: 9, 220 and 484 bits, ours as compressors and the plain sum of equal bits;
our Sobel and one written from its definition.
"""

from hdl_templates import sobel
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Match
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.markdown import head, row
from wnn2hdl.synth import Job, synthesise_all

WIDTHS = (9, 220, 484)

PLAIN_SOBEL = """
module plain(input [71:0] window, output edge_bit);
  wire signed [11:0] p0 = window[7:0], p1 = window[15:8], p2 = window[23:16], p3 = window[31:24],
                     p5 = window[47:40], p6 = window[55:48], p7 = window[63:56], p8 = window[71:64];
  wire signed [11:0] gx = (p2 + 2 * p5 + p8) - (p0 + 2 * p3 + p6);
  wire signed [11:0] gy = (p6 + 2 * p7 + p8) - (p0 + 2 * p1 + p2);
  wire [11:0] ax = gx < 0 ? -gx : gx, ay = gy < 0 ? -gy : gy;
  assign edge_bit = ax + ay >= 128;
endmodule
"""


def matcher(width: int) -> Circuit:
    """A circuit that counts in how many places two words agree."""
    bits, reference = Port("bits", width), Port("reference_bits", width)
    match = Match("agreement", bits.word, reference.word)
    count = (Slice(match.name, 0, width.bit_length()),)
    return Circuit("match", "Match and count.", (bits, reference), (match,), {"match_count": count})


def plain_matcher(width: int) -> str:
    """The sum of all equal bits, as one would write it first."""
    count = width.bit_length()
    total = " + ".join(f"{{{count - 1}'d0, same[{i}]}}" for i in range(width))
    return (
        f"module plain(input [{width - 1}:0] bits, input [{width - 1}:0] reference_bits, "
        f"output [{count - 1}:0] match_count);\n"
        f"  wire [{width - 1}:0] same = ~(bits ^ reference_bits);\n"
        f"  assign match_count = {total};\nendmodule\n"
    )


def main() -> None:
    """Print the table."""
    jobs = {}
    for width in WIDTHS:
        ours = verilog(component(matcher(width), style="cells"), prefix="our_", header=())
        jobs[f"match {width}, ours"] = Job(ours, "our_match")
        jobs[f"match {width}, plain sum"] = Job(plain_matcher(width), "plain")
    text = verilog(sobel.Parameters().create(), prefix="our_", header=())
    jobs["Sobel, ours"] = Job(text, "our_sobel", baseline=True)
    jobs["Sobel, from the definition"] = Job(PLAIN_SOBEL, "plain", baseline=True)
    print(head(["circuit", "LUTs", "CARRY4", "LUTs per bit", "delay ps"]))
    for name, result in synthesise_all(jobs).items():
        resources = result.resources
        bits = next((width for width in WIDTHS if name.startswith(f"match {width},")), None)
        rate = "" if bits is None else f"{resources.luts / bits:.2f}"
        print(row([name, resources.luts, resources.carry4, rate, resources.delay_ps]))


if __name__ == "__main__":
    main()
