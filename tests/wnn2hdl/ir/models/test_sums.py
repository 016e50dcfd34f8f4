from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Words
from wnn2hdl.ir.models import SumLayer, TableSumModel


@st.composite
def models(draw: st.DrawFn) -> TableSumModel:
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    words, bits = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    encoder, layers = Words(words, bits), []
    for nodes in [*draw(st.lists(st.integers(1, 5), max_size=2)), draw(st.integers(2, 4))]:
        edges, wider = draw(st.integers(0, 9)), draw(st.integers(1, 6))
        layers.append(
            SumLayer(
                nodes=nodes,
                output_bits=wider,
                sources=rng.integers(0, words, edges, dtype=np.int32),
                targets=np.sort(rng.integers(0, nodes, edges, dtype=np.int32)),
                values=rng.integers(-20, 20, (edges, 1 << bits), dtype=np.int32),
            )
        )
        words, bits = nodes, wider
    return TableSumModel(encoder, tuple(map(str, range(words))), tuple(layers))


def slow_responses(model: TableSumModel, row: list[int]) -> list[int]:
    """The definition, edge by edge."""
    words = row
    for layer in model.layers:
        sums = [0] * layer.nodes
        for source, target, values in zip(layer.sources, layer.targets, layer.values, strict=True):
            sums[target] += int(values[words[source]])
        half = 2 ** (layer.output_bits - 1)
        sums = [min(max(value, -half), half - 1) for value in sums]
        words = [value + half for value in sums]
    return sums


@given(models())
def test_every_response_is_that_of_the_definition(model: TableSumModel) -> None:
    features = np.random.default_rng(0).integers(0, 1 << model.layers[0].input_bits, (30, model.words))
    bits = model.encoder.bits(features)
    responses = [slow_responses(model, row) for row in features.tolist()]
    assert model.responses(bits).tolist() == responses
    assert model.evaluate(bits).tolist() == [each.index(max(each)) for each in responses]


@given(models())
def test_json_gives_the_model_back(model: TableSumModel) -> None:
    assert TableSumModel.from_json(model.to_json()).to_json() == model.to_json()


def layer() -> SumLayer:
    """Two nodes of four bits: the only word times 5, and times -5."""
    values = np.array([[0, 5, 10, 15], [0, -5, -10, -15]], dtype=np.int32)
    return SumLayer(2, 4, np.array([0, 0], dtype=np.int32), np.array([0, 1], dtype=np.int32), values)


def test_a_sum_saturates() -> None:
    model = TableSumModel(Words(1, 2), ("a", "b"), (layer(),))
    assert model.responses(model.encoder.bits([[1], [2], [3]])).tolist() == [[5, -5], [7, -8], [7, -8]]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"output_bits": 0}, "no layer: 2 nodes of 0 bits"),
        ({"values": np.zeros((2, 3), dtype=np.int32)}, "power of two"),
        ({"sources": np.array([0], dtype=np.int32)}, "every edge needs"),
        ({"targets": np.array([0, 2], dtype=np.int32)}, "a node that does not exist"),
        ({"targets": np.array([1, 0], dtype=np.int32)}, "not in the order of their targets"),
        ({"sources": np.array([0, -1], dtype=np.int32)}, "a word before the first"),
    ],
)
def test_a_layer_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(layer(), **change)


def test_layers_that_do_not_fit() -> None:
    with pytest.raises(ValueError, match="a node for each class"):
        TableSumModel(Words(1, 2), ("a", "b", "c"), (layer(),))
    with pytest.raises(ValueError, match="3 input bits do not make words of 2 bits"):
        TableSumModel(Words(3), ("a", "b"), (layer(),))
    with pytest.raises(ValueError, match="reads words of 2 bits; the one before gives 4"):
        TableSumModel(Words(1, 2), ("a", "b"), (layer(), layer()))
    beyond = replace(layer(), sources=np.array([0, 1], dtype=np.int32))
    with pytest.raises(ValueError, match="reads word 1; there are 1"):
        TableSumModel(Words(1, 2), ("a", "b"), (beyond,))


@given(models(), st.integers(0, 99))
def test_totals_count_the_sums_from_nought_and_hold_the_next_address(model: TableSumModel, seed: int) -> None:
    rng = np.random.default_rng(seed)
    words = rng.integers(0, 1 << model.layers[0].input_bits, (model.words, 20))
    for number, (layer, totals) in enumerate(zip(model.layers, model.totals, strict=True)):
        occurring = model.occurring(number)
        assert all(codes[word].all() for codes, word in zip(occurring, words, strict=True))
        sums = replace(layer, output_bits=16).evaluate(words)
        addresses = layer.evaluate(words) - layer.lowest
        for node, total in enumerate(totals):
            counted = sums[node] + total.offset
            assert (total.lowest <= sums[node]).all()
            assert (sums[node] <= total.highest).all()
            assert (counted >= 0).all()
            assert (counted < 1 << total.bits).all()
            fits = (layer.lowest <= sums[node]) & (sums[node] < -layer.lowest)
            assert np.array_equal((counted % (1 << layer.output_bits))[fits], addresses[node][fits])
        words = addresses


def test_a_range_too_wide_to_list_counts_as_possible_throughout() -> None:
    values = np.array([[0, 3_000_000]], dtype=np.int32)
    layer = SumLayer(2, 3, np.zeros(1, np.int32), np.zeros(1, np.int32), values)
    total, none = layer.totals([np.ones(2, dtype=np.bool_)])
    assert (total.lowest, total.highest) == (0, 3_000_000)
    assert total.codes.tolist() == [False] * 4 + [True] * 4
    assert none.codes.tolist() == [False] * 4 + [True] + [False] * 3
