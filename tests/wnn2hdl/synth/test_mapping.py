"""Mapping to other FPGAs: counted, and the same logic as before."""

import pytest

from wnn2hdl.errors import CheckError
from wnn2hdl.synth.fabrics import FABRICS
from wnn2hdl.synth.mapping import map_to
from wnn2hdl.verify.equivalence import Circuit, find_differences

pytestmark = pytest.mark.slow

# Two parities in LUTs that a synthesiser would make of one another if it might, a comparison, and cells that
# other families do not have.
DESIGN = """\
module design (input wire [6:0] a, output wire [4:0] y);
    LUT3 #(.INIT(8'h96)) first (.I0(a[0]), .I1(a[1]), .I2(a[2]), .O(y[0]));
    LUT2 #(.INIT(4'h6)) second (.I0(y[0]), .I1(a[2]), .O(y[1]));
    assign y[2] = a > 7'd77;
    LUT6 #(.INIT(64'h8000000000000001)) third (
        .I0(a[0]), .I1(a[1]), .I2(a[2]), .I3(a[3]), .I4(a[4]), .I5(a[5]), .O(y[3]));
    MUXF7 fourth (.I0(y[0]), .I1(y[3]), .S(a[6]), .O(y[4]));
endmodule
"""

SAME = """\
module design (input wire [6:0] a, output wire [4:0] y);
    wire same = &a[5:0] | ~|a[5:0];
    assign y = {a[6] ? same : ^a[2:0], same, a > 7'd77, a[0] ^ a[1], ^a[2:0]};
endmodule
"""


@pytest.mark.parametrize("device", FABRICS)
def test_the_netlist_is_the_verilog_and_its_luts_stay(device: str) -> None:
    mapped = map_to(FABRICS[device], DESIGN, "design")
    assert 5 <= mapped.cells.luts <= 40
    assert mapped.cells.ffs == 0
    netlist = Circuit((mapped.logic,), "design")
    other = Circuit((SAME.replace("77", "78"),), "design")
    same, different = find_differences([(Circuit((SAME,), "design"), netlist), (other, netlist)], timeout=60)
    assert same is None
    assert isinstance(different, dict)
    assert different["a"] == 78


def test_a_cell_that_is_not_counted_is_an_error() -> None:
    multiplied = "module big (input wire [17:0] a, b, output wire [35:0] p); assign p = a * b; endmodule\n"
    with pytest.raises(CheckError, match="not counted: MULT18X18D"):
        map_to(FABRICS["ecp5-25k"], multiplied, "big")
