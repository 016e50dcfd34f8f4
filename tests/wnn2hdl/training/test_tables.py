"""From feature vectors to a model: fitted on training rows alone, and judged on others."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import row_confusion
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import SparseWisardModel
from wnn2hdl.training import tables
from wnn2hdl.training.tables import TableOptions, cross_validate_table, train_table


def silent(step: str, done: int, total: int) -> None:
    pass


def blobs(rows: int = 120, *, whole: bool = False) -> FeatureTable:
    """Three clouds of points in three dimensions, of which the last says nothing."""
    rng = np.random.default_rng(7)
    owners = rng.integers(0, 3, rows)
    points = rng.normal(size=(rows, 3)) + 4 * np.stack([owners == 1, owners == 2, owners < 0], axis=1)
    features = np.round(20 * points) if whole else points
    return FeatureTable(("x", "y", "noise"), features, tuple(np.array(["c", "a", "b"])[owners].tolist()))


def test_a_table_is_learned() -> None:
    table = blobs()
    model = train_table(table, TableOptions(), seed=0)
    assert isinstance(model, WisardModel)
    assert model.classes == ("a", "b", "c")
    assert (model.address_bits, model.rams) == (6, 4)
    assert np.trace(row_confusion(model, table, raw=None)) >= 115
    assert model.training["columns"] == ["x", "y", "noise"]


def test_large_discriminators_become_sparse_and_answer_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    table, options = blobs(), TableOptions(per_class=True)
    dense = train_table(table, options, seed=3)
    monkeypatch.setattr(tables, "DENSE_COUNTS", 100)
    sparse = train_table(table, options, seed=3)
    assert isinstance(sparse, SparseWisardModel)
    assert len(sparse.mapping) == 3
    assert np.array_equal(row_confusion(dense, table, raw=None), row_confusion(sparse, table, raw=None))


def test_more_address_bits_than_a_dense_ram_can_have() -> None:
    model = train_table(blobs(), TableOptions(address_bits=24), seed=0)
    assert isinstance(model, SparseWisardModel)
    assert model.address_bits == 24


def test_features_become_words_where_that_changes_nothing() -> None:
    def words(table: FeatureTable, options: TableOptions = TableOptions()) -> FixedPoint | None:  # noqa: B008
        encoder = train_table(table, options, seed=0).encoder
        assert isinstance(encoder, Thermometer)
        return encoder.input

    assert str(words(blobs(whole=True))) == "Q8.0"
    assert words(blobs()) is None
    assert words(blobs(), TableOptions(words=FixedPoint(8, 4))) == FixedPoint(8, 4)


def test_cross_validation_answers_for_every_row_once_per_seed() -> None:
    table = blobs()
    steps: list[tuple[int, int]] = []
    confusion = cross_validate_table(
        table, TableOptions(), (0, 1), lambda _, done, total: steps.append((done, total))
    )
    truth = [table.labels.count(name) for name in "abc"]
    assert confusion.sum(axis=2).tolist() == [truth, truth]
    assert (confusion[0] != confusion[1]).any()
    assert steps == [(done, 10) for done in range(11)]
    assert np.trace(confusion[0]) > 100


def test_a_test_row_has_no_part_in_its_model() -> None:
    # Labels at random cannot be guessed; a model that had seen the rows would know them.
    rng = np.random.default_rng(1)
    table = replace(blobs(), labels=tuple(rng.choice(["a", "b"], 120).tolist()))
    options = TableOptions(address_bits=18, levels=30, bleaching=1)
    assert np.trace(row_confusion(train_table(table, options, seed=0), table, raw=None)) > 110
    assert 40 < np.trace(cross_validate_table(table, options, (0,), silent)[0]) < 80


def test_tables_that_nothing_can_be_learned_from() -> None:
    one = replace(blobs(), labels=("a",) * 120)
    with pytest.raises(InputError, match="the table has one class only: a"):
        train_table(one, TableOptions(), seed=0)
    with pytest.raises(InputError, match="two rows of two classes"):
        cross_validate_table(one, TableOptions(), (0,), silent)
    with pytest.raises(InputError, match="more address bits than the network has input bits: 40 of 24"):
        train_table(blobs(), TableOptions(address_bits=40), seed=0)
