"""Small functions as equations."""

from amaranth.hdl import Module, Signal
from amaranth.sim import Simulator
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates.boolean import Equation, equation, irredundant_cover


def table_of(terms: tuple[tuple[int, int], ...], width: int) -> int:
    return sum(any(a & mask == value for mask, value in terms) << a for a in range(1 << width))


@given(st.integers(1, 6), st.data())
def test_a_cover_lies_between_its_bounds_and_has_no_superfluous_term(width: int, data: st.DataObject) -> None:
    everything = (1 << (1 << width)) - 1
    lower = data.draw(st.integers(0, everything))
    upper = lower | data.draw(st.integers(0, everything))
    terms = irredundant_cover(lower, upper, width)
    covered = table_of(terms, width)
    assert covered & lower == lower
    assert covered | upper == upper
    for i in range(len(terms)):
        rest = table_of((*terms[:i], *terms[i + 1 :]), width)
        assert rest & lower != lower


def test_the_shortest_writing_is_chosen() -> None:
    assert equation(0b0110, 2) == Equation("parity", ((0b11, 0),))
    assert equation(0b1001, 2) == Equation("parity", ((0b11, 1),))
    assert equation(0b1000, 2) == Equation("sum", ((0b11, 0b11),))
    assert equation(0b1111_1110, 3).literals == 3
    almost_all = equation((1 << 64) - 1 - (1 << 63), 6)
    assert (almost_all.kind, almost_all.literals) == ("sum", 6)
    of_three_clauses = equation(sum(1 << a for a in range(64) if a & 3 and a & 12 and a & 48), 6)
    assert (of_three_clauses.kind, of_three_clauses.literals) == ("product", 6)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 5), st.data())
def test_the_expression_computes_the_table(width: int, data: st.DataObject) -> None:
    contents = data.draw(st.integers(0, (1 << (1 << width)) - 1))
    code, output = Signal(width), Signal()
    m = Module()
    m.d.comb += output.eq(equation(contents, width).expression(list(code)))
    answers: list[int] = []

    async def bench(ctx: object) -> None:
        for a in range(1 << width):
            ctx.set(code, a)  # type: ignore[attr-defined]
            answers.append(ctx.get(output))  # type: ignore[attr-defined]

    simulator = Simulator(m)
    simulator.add_testbench(bench)
    simulator.run()
    assert answers == [contents >> a & 1 for a in range(1 << width)]
