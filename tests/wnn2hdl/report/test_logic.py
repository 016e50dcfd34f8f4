"""What a LUT says of itself is its table."""

from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import LUT_INPUTS, Lut
from wnn2hdl.report.logic import contents, expression, grid


@st.composite
def luts(draw: st.DrawFn) -> Lut:
    count = draw(st.integers(1, LUT_INPUTS))
    return Lut("t0", tuple("abcdef"[:count]), draw(st.integers(0, (1 << (1 << count)) - 1)))


@given(luts())
def test_the_expression_computes_the_table(lut: Lut) -> None:
    text = expression(lut)
    for address in range(1 << len(lut.inputs)):
        values = {name: address >> i & 1 for i, name in enumerate(lut.inputs)}
        assert eval(text, {"__builtins__": {}}, values) & 1 == lut.init >> address & 1


@given(luts())
def test_the_grid_holds_every_row_of_the_table_once(lut: Lut) -> None:
    folded = grid(lut)
    found = {}
    for down, values in folded.rows:
        for across, value in zip(folded.columns, values, strict=True):
            bits = dict(zip((*folded.down, *folded.across), down + across, strict=True))
            found[sum(int(bits[name]) << i for i, name in enumerate(lut.inputs))] = value
    assert found == {a: lut.init >> a & 1 for a in range(1 << len(lut.inputs))}
    assert len(folded.rows) <= len(folded.columns) <= 8


def test_contents_are_written_as_verilog_does() -> None:
    assert contents(Lut("t0", ("a",), 0b01)) == "2'h1"
    assert contents(Lut("t0", tuple("abcdef"), 1)) == "64'h0000000000000001"
