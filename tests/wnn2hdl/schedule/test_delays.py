"""The delay model: no comparison takes longer in Yosys's timing than it says."""

import random

import pytest

from wnn2hdl.schedule import XC7
from wnn2hdl.synth import synthesise


@pytest.mark.parametrize("bits", [6, 16, 63])
def test_no_comparison_takes_longer_than_the_model_says(bits: int) -> None:
    least = random.Random(bits).getrandbits(bits) | 1
    verilog = (
        f"module compare(input [{bits - 1}:0] a, output y); assign y = a >= {bits}'d{least}; endmodule\n"
    )
    delay = synthesise(verilog, "compare").resources.delay_ps
    assert delay is not None
    assert delay <= XC7.comparison(bits)
