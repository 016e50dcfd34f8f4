"""The generated gate networks compute what they say, and their plain Verilog is the same network."""

import numpy as np
import pytest

from benchmarks.gates import TOP, layers, multiplier, plain_gates
from wnn2hdl.verify.equivalence import Circuit, evaluate


def _bits(number: int, width: int) -> list[bool]:
    return [bool(number >> place & 1) for place in range(width)]


def _number(bits: np.ndarray) -> int:
    return sum(1 << int(place) for place in np.flatnonzero(bits))


@pytest.mark.parametrize(("left", "right"), [(0, 0), (31, 31), (19, 7)])
def test_the_multiplier_multiplies(left: int, right: int) -> None:
    [answer] = multiplier(5).evaluate([_bits(left, 5) + _bits(right, 5)])
    assert _number(answer) == left * right


def test_layers_count_their_last_gates() -> None:
    model = layers(inputs=4, width=6, depth=0, classes=2)
    [answer] = model.evaluate([[True, False, True, True]])
    assert _number(answer) == 2 | 1 << 2  # inputs 0 and 2, inputs 1 and 3


def test_plain_verilog_of_gates_is_the_model() -> None:
    model = multiplier(3)
    found = evaluate(Circuit((plain_gates(model),), TOP), {"inputs": 5 | 6 << 3}, {"inputs": 6}, ("outputs",))
    assert found == {"outputs": 30}
