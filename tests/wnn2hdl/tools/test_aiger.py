"""And-inverter graphs in files, and unrolled."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.aiger import Aiger


def evaluate(graph: Aiger, inputs: list[bool]) -> list[bool]:
    """The outputs of a graph without latches."""
    assert not graph.latches
    values = [False, *inputs]

    def value(literal: int) -> bool:
        return values[literal >> 1] ^ bool(literal & 1)

    for left, right in graph.ands:
        values.append(value(left) and value(right))
    return [value(output) for output in graph.outputs]


@st.composite
def graphs(draw: st.DrawFn, latches: int) -> Aiger:
    inputs, gates = draw(st.integers(1, 4)), draw(st.integers(0, 8))
    ands = []
    for gate in range(gates):
        below = st.integers(0, 2 * (inputs + latches + gate) + 1)
        ands.append((draw(below), draw(below)))
    literals = st.integers(0, 2 * (inputs + latches + gates) + 1)
    several = st.lists(literals, min_size=1, max_size=3)
    nexts = draw(st.lists(literals, min_size=latches, max_size=latches))
    return Aiger(inputs, tuple(nexts), tuple(draw(several)), tuple(ands))


@given(graphs(latches=0))
def test_a_graph_survives_its_file(tmp_path_factory: pytest.TempPathFactory, graph: Aiger) -> None:
    path = tmp_path_factory.getbasetemp() / "graph.aig"
    graph.write(path)
    read = Aiger.read(path)
    assert (read.inputs, read.outputs) == (graph.inputs, graph.outputs)
    assert [set(pair) for pair in read.ands] == [set(pair) for pair in graph.ands]


@given(graphs(latches=2), st.data())
def test_unrolled_it_is_what_its_latches_do_cycle_by_cycle(graph: Aiger, data: st.DataObject) -> None:
    cycles = data.draw(st.integers(0, 3))
    flags = st.lists(st.booleans(), min_size=graph.inputs, max_size=graph.inputs)
    state = data.draw(st.lists(st.booleans(), min_size=2, max_size=2))
    inputs = [data.draw(flags) for _ in range(cycles + 1)]
    first = tuple(data.draw(st.permutations(range(graph.inputs))))[: data.draw(st.integers(0, graph.inputs))]
    rest = [inputs[0][place] for place in range(graph.inputs) if place not in first]
    free = [*rest, *state, *(flag for later in inputs[1:] for flag in later)]
    unrolled = graph.unrolled(cycles, first)
    assert unrolled.inputs == len(first) + len(free)
    answers = evaluate(unrolled, [inputs[0][place] for place in first] + free)
    step = Aiger(graph.inputs + 2, (), (*graph.latches, *graph.outputs), graph.ands)
    for cycle in inputs:
        *stored, expected = [*evaluate(step, [*cycle, *state])[:2], evaluate(step, [*cycle, *state])[2:]]
        state = [bool(flag) for flag in stored]
    assert answers == expected


@given(graphs(latches=0), st.data())
def test_inputs_that_nothing_reads_change_nothing(graph: Aiger, data: st.DataObject) -> None:
    first = data.draw(st.integers(0, graph.inputs))
    inputs = data.draw(st.lists(st.booleans(), min_size=graph.inputs, max_size=graph.inputs))
    wide = graph.widened(first, 2, 1)
    given_more = [*inputs[:first], True, False, *inputs[first:], True]
    assert evaluate(wide, given_more) == evaluate(graph, inputs)


def test_another_format_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "graph.aag"
    path.write_text("aag 1 1 0 1 0\n2\n2\n")
    with pytest.raises(ToolError, match="not a graph in the binary AIGER format"):
        Aiger.read(path)
