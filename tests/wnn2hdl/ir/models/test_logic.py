from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir.models import LogicModel


@st.composite
def models(draw: st.DrawFn) -> LogicModel:
    inputs, gates, outputs = draw(st.integers(1, 6)), draw(st.integers(0, 20)), draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    reads = [rng.integers(0, 2 * (1 + inputs + index), 2) for index in range(gates)]
    return LogicModel(
        inputs=tuple(f"in{index}" for index in range(inputs)),
        outputs=tuple(f"out{index}" for index in range(outputs)),
        gates=np.array(reads, dtype=np.uint32).reshape(-1, 2),
        literals=rng.integers(0, 2 * (1 + inputs + gates), outputs, dtype=np.uint32),
    )


def slow_answers(model: LogicModel, row: NDArray[np.bool_]) -> list[bool]:
    """The definition, gate by gate."""
    values = [False, *row.tolist()]

    def read(literal: int) -> bool:
        return bool(values[literal >> 1] ^ (literal & 1))

    for left, right in model.gates.tolist():
        values.append(read(left) and read(right))
    return [read(literal) for literal in model.literals.tolist()]


@given(models(), st.integers(0, 70))
def test_every_answer_is_that_of_the_definition(model: LogicModel, samples: int) -> None:
    bits = np.random.default_rng(0).random((samples, model.width)) < 0.5
    assert model.evaluate(bits).tolist() == [slow_answers(model, row) for row in bits]


@given(models())
def test_json_gives_the_model_back(model: LogicModel) -> None:
    assert LogicModel.from_json(model.to_json()).to_json() == model.to_json()


def both() -> LogicModel:
    return LogicModel(("a", "b"), ("y",), np.array([[2, 4]], dtype=np.uint32), np.array([6], dtype=np.uint32))


def test_a_level_is_the_longest_way_from_an_input() -> None:
    gates = np.array([[2, 4], [6, 2], [4, 2]], dtype=np.uint32)
    assert replace(both(), gates=gates).levels.tolist() == [0, 0, 0, 1, 2, 1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inputs": ("a", "a")}, "its own name"),
        ({"outputs": ()}, "its own name"),
        ({"gates": np.array([[2, 6]], dtype=np.uint32)}, "reads itself"),
        ({"gates": np.array([2, 4], dtype=np.uint32)}, "the gates have shape"),
        ({"literals": np.array([8], dtype=np.uint32)}, "variable 4, which does not exist"),
        ({"literals": np.array([1, 1], dtype=np.uint32)}, "2 output literals for 1 outputs"),
    ],
)
def test_a_network_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(both(), **change)
