"""Networks of sums of tables answer as their models, however their tables were parted into bits."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.small_sums import sum_network
from wnn2hdl.importers.base import ImportOptions, Source
from wnn2hdl.importers.kanele import read
from wnn2hdl.ir.features import Words
from wnn2hdl.ir.models import SumLayer, TableSumModel
from wnn2hdl.ir.wires import word_values
from wnn2hdl.lower.sums import network


def require_same(model: TableSumModel, samples: int = 400) -> None:
    bits = np.random.default_rng(1).random((samples, model.width)) < 0.5
    found = word_values(network(model).evaluate({"features": bits})["class_bits"])
    assert found == model.evaluate(bits).tolist()


@given(st.integers(0, 10_000), st.sampled_from([(1, 9), (3, 4), (6, 3), (9, 2)]))
@settings(max_examples=25, deadline=None)
def test_the_circuit_answers_as_the_model(seed: int, words: tuple[int, int]) -> None:
    require_same(sum_network(seed, word_bits=words[0], inputs=words[1]))


@pytest.mark.parametrize("slope", [-40_000, 0, 40_000])
def test_sums_far_beyond_their_range_saturate(slope: int) -> None:
    first, second = np.zeros(3, np.int32), np.arange(3, dtype=np.int32)
    values = (slope * np.arange(4) + np.array([[100], [0], [-100]])).astype(np.int32)
    require_same(TableSumModel(Words(1, 2), ("a", "b", "c"), (SumLayer(3, 4, first, second, values),)))


def test_layers_are_circuits_of_their_own() -> None:
    model = sum_network(3)
    parts = network(model).definitions()
    assert list(parts) == ["layer_0", "saturation_0", "layer_1", "saturation_1", "winner", "network"]
    assert [port.width for port in parts["layer_0"].outputs] == [total.bits for total in model.totals[0]]


def test_equal_tables_of_a_word_are_made_once() -> None:
    values = np.array([[0, 5, 3, 6, 1, 7, 2, 4]] * 3, dtype=np.int32) * np.array(
        [[1], [1], [-1]], dtype=np.int32
    )
    layer = SumLayer(3, 5, np.zeros(3, np.int32), np.arange(3, dtype=np.int32), values)
    model = TableSumModel(Words(3, 3), ("a", "b", "c"), (layer,))
    alone = TableSumModel(
        Words(3, 3), ("a", "b"), (SumLayer(2, 5, layer.sources[:2], layer.targets[:2], values[:2]),)
    )
    tables = [
        sum(node.kind == "table" for node in network(each).definitions()["layer_0"].nodes)
        for each in (model, alone)
    ]
    assert tables[0] <= tables[1] + 1
    require_same(model)


@pytest.mark.realdata
def test_the_recorded_vectors_of_a_published_network_are_reproduced(realdata: Path) -> None:
    folder = realdata / "kanele" / "jsc_openml"
    model = read(Source(folder / "truth_tables.json"), ImportOptions())
    inputs, outputs = (np.loadtxt(folder / f"vectors_{way}.txt", dtype=int) for way in ("in", "out"))
    found = network(model).evaluate({"features": model.encoder.bits(inputs)})["class_bits"]
    assert word_values(found) == outputs.argmax(axis=1).tolist()
