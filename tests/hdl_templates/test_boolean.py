"""Equations as Amaranth expressions."""

from typing import Any

from amaranth.hdl import Module, Signal
from amaranth.sim import Simulator
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates.boolean import expression
from wnn2hdl.ir import equation


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 5), st.data())
def test_the_expression_computes_the_table(width: int, data: st.DataObject) -> None:
    contents = data.draw(st.integers(0, (1 << (1 << width)) - 1))
    code, output = Signal(width), Signal()
    m = Module()
    m.d.comb += output.eq(expression(equation(contents, width), list(code)))
    answers: list[int] = []

    async def bench(ctx: Any) -> None:
        for a in range(1 << width):
            ctx.set(code, a)
            answers.append(ctx.get(output))

    simulator = Simulator(m)
    simulator.add_testbench(bench)
    simulator.run()
    assert answers == [contents >> a & 1 for a in range(1 << width)]
