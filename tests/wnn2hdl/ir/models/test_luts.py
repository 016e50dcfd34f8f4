from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir import FixedPoint, Thermometer, Words
from wnn2hdl.ir.models import LutGroupModel, LutLayer


@st.composite
def models(draw: st.DrawFn) -> LutGroupModel:
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    width, classes = draw(st.integers(1, 9)), draw(st.integers(2, 4))
    layers, before = [], width
    for nodes in draw(st.lists(st.integers(1, 8), min_size=1, max_size=3)):
        inputs = draw(st.integers(1, 6))
        mapping = rng.integers(0, before, (nodes, inputs), dtype=np.int32)
        layers.append(LutLayer(mapping, rng.random((nodes, 1 << inputs)) < 0.5))
        before = nodes
    groups = rng.integers(0, classes, before, dtype=np.int32)
    return LutGroupModel(Words(width), tuple(map(str, range(classes))), tuple(layers), groups)


def slow_responses(model: LutGroupModel, row: NDArray[np.bool_]) -> list[int]:
    """The definition, node by node."""
    values = row.tolist()
    for layer in model.layers:
        values = [
            bool(table[sum(values[i] << slot for slot, i in enumerate(inputs))])
            for inputs, table in zip(layer.mapping.tolist(), layer.tables, strict=True)
        ]
    return [
        sum(value for value, group in zip(values, model.groups, strict=True) if group == owner)
        for owner in range(len(model.classes))
    ]


@given(models())
def test_every_response_is_that_of_the_definition(model: LutGroupModel) -> None:
    bits = np.random.default_rng(0).random((30, model.width)) < 0.5
    responses = [slow_responses(model, row) for row in bits]
    assert model.responses(bits).tolist() == responses
    assert model.evaluate(bits).tolist() == [each.index(max(each)) for each in responses]


@given(models())
def test_json_gives_the_model_back(model: LutGroupModel) -> None:
    assert LutGroupModel.from_json(model.to_json()).to_json() == model.to_json()


def small() -> LutGroupModel:
    """Two nodes that vote for a class each: their input, and its inverse."""
    layer = LutLayer(np.array([[0], [0]], dtype=np.int32), np.array([[False, True], [True, False]]))
    return LutGroupModel(Words(1), ("a", "b"), (layer,), np.array([0, 1], dtype=np.int32))


def test_a_node_of_sixteen_inputs_has_its_last_address() -> None:
    table = np.zeros((1, 1 << 16), dtype=np.bool_)
    table[0, -1] = True
    assert LutLayer(np.zeros((1, 16), dtype=np.int32), table).evaluate(np.array([[True]])).all()


def test_the_digest_sees_the_encoder_and_not_the_origin() -> None:
    model = replace(small(), encoder=Thermometer(((0.5,),), strict=True))
    assert model.digest() == replace(model, origin={"file": "x"}).digest()
    others = [
        replace(model, encoder=Thermometer(((0.5,),), strict=False)),
        replace(model, encoder=Thermometer(((0.5,),), strict=True, input=FixedPoint(16, 12))),
        replace(model, groups=np.array([1, 0], dtype=np.int32)),
    ]
    assert len({model.digest(), *(other.digest() for other in others)}) == 4


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"encoder": Words(2), "layers": ()}, "at least one layer"),
        ({"groups": np.array([0], dtype=np.int32)}, "1 nodes vote"),
        ({"groups": np.array([0, 2], dtype=np.int32)}, "a class that does not exist"),
    ],
)
def test_a_model_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(small(), **change)


@pytest.mark.parametrize("reads", [1, -1])
def test_a_node_reads_only_what_there_is(reads: int) -> None:
    layer = replace(small().layers[0], mapping=np.array([[0], [reads]], dtype=np.int32))
    with pytest.raises(ValueError, match="reads"):
        replace(small(), layers=(layer,))


def test_tables_that_fit_no_mapping() -> None:
    with pytest.raises(ValueError, match="the tables have shape"):
        LutLayer(np.zeros((1, 2), dtype=np.int32), np.zeros((1, 2), dtype=np.bool_))
    with pytest.raises(ValueError, match="the mapping has shape"):
        LutLayer(np.zeros((1, 17), dtype=np.int32), np.zeros((1, 1 << 17), dtype=np.bool_))
