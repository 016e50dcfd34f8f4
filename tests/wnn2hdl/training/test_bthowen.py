"""Thresholds of BTHOWeN come back from its training rows, exactly or not at all."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import row_confusion
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.bthowen import read
from wnn2hdl.ir import Thermometer, ThermometerBits
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.training.bthowen import with_thresholds

ORDER = np.random.default_rng(3).permutation(18)


def rows(count: int = 90) -> FeatureTable:
    """Two clouds of points of four features."""
    rng = np.random.default_rng(0)
    owners = rng.integers(0, 2, count)
    labels = tuple(np.array(["east", "west"])[owners].tolist())
    return FeatureTable(("a", "b", "c", "d"), rng.normal(size=(count, 4)) + owners[:, np.newaxis], labels)


def trained(table: FeatureTable, threshold: int = 2) -> BloomWisardModel:
    """What BTHOWeN trains on rows in their order, written down sample by sample; 16 bits are padded to 18."""
    hashes = np.random.default_rng(1).integers(0, 16, (2, 6))
    mean, deviation = table.features.mean(axis=0), table.features.std(axis=0)
    parts = (-0.8416212335729142, -0.2533471031357997, 0.2533471031357997, 0.8416212335729142)
    bits = np.concatenate([table.features >= mean + part * deviation for part in parts], axis=1)
    counts = np.zeros((2, 3, 16), dtype=np.int64)
    for sample, label in zip(bits, table.labels, strict=True):
        inputs = np.pad(sample, (0, 2))[ORDER].reshape(3, 6)
        for number, own in enumerate(inputs):
            places = np.bitwise_xor.reduce(np.where(own, hashes, 0), axis=1)
            entries = counts[int(label == "west"), number]
            entries[places] = np.maximum(entries[places], entries[places].min() + 1)
    return BloomWisardModel(
        ThermometerBits(4, 4),
        ("0", "1"),
        np.where(ORDER < 16, ORDER, -1).reshape(3, 6).astype(np.int32),
        hashes.astype(np.uint32),
        counts >= threshold,
    )


def test_thresholds_are_found_and_classes_get_their_names() -> None:
    table = rows()
    model = trained(table)
    found = with_thresholds(model, table)
    assert isinstance(found.encoder, Thermometer)
    assert found.classes == ("east", "west")
    levels = np.array(found.encoder.thresholds).T
    bits = np.concatenate([table.features >= level for level in levels], axis=1)
    assert np.array_equal(found.responses(found.encoder.bits(table.features)), model.responses(bits))


def test_discriminators_in_another_order_keep_their_own_names() -> None:
    model = trained(rows())
    swapped = replace(model, contents=model.contents[::-1])
    assert with_thresholds(swapped, rows()).classes == ("west", "east")


def test_other_rows_are_refused() -> None:
    model, table = trained(rows()), rows()
    table.features[::5] += 2
    with pytest.raises(InputError, match="training on these rows does not give the filters of the model"):
        with_thresholds(model, table)


def test_one_other_entry_is_refused() -> None:
    model = trained(rows())
    contents = model.contents.copy()
    contents[1, 2, 5] ^= True
    with pytest.raises(InputError, match="their thresholds are not its own: 90 rows"):
        with_thresholds(replace(model, contents=contents), rows())


def test_other_tables_and_models_are_refused() -> None:
    model, table = trained(rows()), rows()
    with pytest.raises(InputError, match="another number of features than the model: 3, not 4"):
        with_thresholds(model, replace(table, features=table.features[:, :3]))
    with pytest.raises(InputError, match="another number of classes than the model: 1, not 2"):
        with_thresholds(model, replace(table, labels=("east",) * 90))
    with pytest.raises(InputError, match="the model has thresholds already"):
        with_thresholds(with_thresholds(model, table), table)


@pytest.mark.realdata
@pytest.mark.parametrize(
    ("name", "right"),
    [("iris", 49 / 50), ("wine", 58 / 59), ("ecoli", 98 / 112), ("vehicle", 215 / 282)],
)
def test_published_models_get_their_published_accuracy(realdata: Path, name: str, right: float) -> None:
    model = read(Source(realdata / "bthowen" / f"{name}.pickle.lzma"), ImportOptions())
    table = read_table(realdata / "uci" / f"{name}.csv", "label")
    found = with_thresholds(model, table)
    # The rows that its training keeps to test on.
    kept = np.random.RandomState(123).permutation(len(table.labels))[: len(table.labels) // 3]
    tested = replace(table, features=table.features[kept], labels=tuple(table.labels[row] for row in kept))
    confusion = row_confusion(found, tested, None)
    assert confusion.trace() / confusion.sum() == pytest.approx(right, abs=1e-4)
