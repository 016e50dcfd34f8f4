from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.importers.gates import GateBuilder, in_order
from wnn2hdl.ir.models import LogicModel


def table(builder: GateBuilder, literal: int, inputs: int) -> list[bool]:
    """Answers of a literal for all inputs, the first input the slowest."""
    names = tuple(f"i{index}" for index in range(inputs))
    model = LogicModel(names, ("o",), builder.array(), np.array([literal], dtype=np.uint32))
    return list(map(bool, model.evaluate(list(product([False, True], repeat=inputs)))[:, 0]))


@given(st.lists(st.integers(0, 7), max_size=6))
def test_every_and_any_are_what_they_say(literals: list[int]) -> None:
    rows = list(product([False, True], repeat=3))
    values = [[bool(([False, *row][literal >> 1]) ^ (literal & 1)) for literal in literals] for row in rows]
    builder = GateBuilder(3)
    assert table(builder, builder.every(literals), 3) == [all(row) for row in values]
    assert table(builder, builder.any(literals), 3) == [any(row) for row in values]


def test_a_gate_is_made_once_and_never_for_what_is_known() -> None:
    builder = GateBuilder(2)
    assert (builder.both(2, 0), builder.both(1, 4), builder.both(2, 2), builder.both(4, 5)) == (0, 4, 2, 0)
    assert builder.gates == []
    assert builder.both(2, 4) == builder.both(4, 2) == 6
    assert builder.gates == [(2, 4)]


@given(st.integers(0, 12), st.data())
def test_each_node_comes_after_those_it_reads(count: int, data: st.DataObject) -> None:
    ranks = data.draw(st.permutations(range(count)))
    lower = [[other for other in range(count) if ranks[other] < ranks[node]] for node in range(count)]
    reads = [data.draw(st.lists(st.sampled_from(each), max_size=3)) if each else [] for each in lower]
    order = in_order(reads)
    assert sorted(order) == list(range(count))
    assert all(order.index(other) < order.index(node) for node in range(count) for other in reads[node])


def test_a_long_chain_needs_no_recursion() -> None:
    chain = [[node + 1] for node in range(50_000)] + [[]]
    assert all(a > b for a, b in pairwise(in_order(chain)))


@pytest.mark.parametrize("reads", [[[0]], [[1], [0]], [[], [2], [3], [0, 1]]])
def test_a_circle_has_no_order(reads: list[list[int]]) -> None:
    with pytest.raises(ValueError, match="in a circle"):
        in_order(reads)
