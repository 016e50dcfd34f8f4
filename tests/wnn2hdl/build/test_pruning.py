"""Pruned networks answer as before: on all inputs, or on all but a stated number of rows."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.small_networks import lut_network
from wnn2hdl.build.pruning import prune_exactly, prune_on_rows
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel, Words, all_codes, codes_to_bits
from wnn2hdl.ir.models import Dynamic, LogicModel, LutGroupModel, LutLayer, SparseWisardModel, VotingModel
from wnn2hdl.wisard import draw_mapping
from wnn2hdl.wisard.sparse import train_sparse

EVERY = codes_to_bits(all_codes(8), 8)


def silent(step: str, done: int, total: int) -> None:
    pass


def random_network(kind: str, seed: int) -> VotingModel:
    """Three classes over eight bits, with silent tables, and tables that all classes have."""
    rng = np.random.default_rng(seed)
    if kind == "luts":
        mapping = rng.integers(0, 8, (15, 2)).astype(np.int32)
        tables = rng.random((15, 4)) < 0.4
        mapping[5:7] = mapping[10:12] = mapping[0:2]
        tables[5:7] = tables[10:12] = tables[0:2]
        groups = np.repeat([0, 1, 2], 5).astype(np.int32)
        return LutGroupModel(Words(8), ("a", "b", "c"), (LutLayer(mapping, tables),), groups)
    shared = draw_mapping(8, 5, 2, seed, groups=3 if kind == "own" else 1)
    counts = rng.integers(0, 4, (3, 5, 4))
    counts[:, 1] = counts[0, 1]
    counts[1, 2] = 0
    dense = WisardModel(Words(8), ("a", "b", "c"), shared, counts, 2)
    if kind != "sparse":
        return dense
    bits = rng.random((60, 8)) < 0.5
    return replace(
        train_sparse(bits, rng.integers(0, 3, 60), Words(8), ("a", "b", "c"), shared, 2), ties="last"
    )


@given(st.sampled_from(["luts", "dense", "own", "sparse"]), st.integers(0, 2**32))
def test_nothing_that_matters_is_pruned_without_a_table(kind: str, seed: int) -> None:
    model = random_network(kind, seed)
    found = prune_exactly(model)
    assert np.array_equal(found.model.evaluate(EVERY), model.evaluate(EVERY))
    assert (found.of, found.rows) == (15, None)
    if kind in ("luts", "dense"):
        assert found.tables >= 3
    again = prune_exactly(found.model)
    assert np.array_equal(again.model.evaluate(EVERY), model.evaluate(EVERY))


@given(st.sampled_from(["luts", "dense", "own", "sparse"]), st.integers(0, 2**32), st.integers(0, 20))
def test_as_many_answers_change_as_are_stated(kind: str, seed: int, most: int) -> None:
    model = random_network(kind, seed)
    rows = EVERY[::2]
    found = prune_on_rows(model, rows, most, silent)
    assert found.changed is not None
    assert found.changed == np.count_nonzero(found.model.evaluate(rows) != model.evaluate(rows)) <= most
    assert found.rows == 128
    assert found.tables >= prune_exactly(model).tables


def test_more_tables_go_where_more_may_change() -> None:
    model = random_network("luts", 3)
    pruned = [prune_on_rows(model, EVERY, most, silent) for most in (0, 60)]
    assert pruned[0].tables < pruned[1].tables
    assert isinstance(pruned[1].model, LutGroupModel)
    assert pruned[1].model.layers[-1].nodes == 15 - pruned[1].tables


def test_a_class_keeps_a_table() -> None:
    layer = LutLayer(np.zeros((3, 1), dtype=np.int32), np.array([[False, True]] * 2 + [[False, False]]))
    model = LutGroupModel(Words(8), ("a", "b", "c"), (layer,), np.array([0, 1, 2], dtype=np.int32))
    assert prune_exactly(model).tables == 0
    same = replace(model, layers=(LutLayer(layer.mapping, layer.tables[[0, 0, 0]]),))
    assert prune_exactly(same).tables == 0
    assert (
        prune_on_rows(lut_network(1), np.zeros((1, lut_network(1).width), dtype=bool), 1, silent).tables <= 9
    )


def test_only_votes_can_be_pruned() -> None:
    gates = LogicModel(("a",), ("b",), np.zeros((0, 2), np.uint32), np.array([2], np.uint32))
    rising = random_network("sparse", 0)
    assert isinstance(rising, SparseWisardModel)
    for model in (gates, replace(rising, bleaching=Dynamic())):
        with pytest.raises(InputError, match="only tables that vote, with a fixed threshold, can be pruned"):
            prune_exactly(model)
