"""Thresholds of a BTHOWeN model, whose file holds none, from the rows that it was trained on.

BTHOWeN fits its thermometers to all training rows and trains on the first nine tenths of them, or on all
(``train_swept_models.py``). Where a data set has no test rows of its own, it shuffles the rows with a fixed
seed and keeps the first third to test on (``tabular_tools.py``). All these ways are tried, and the filters
are trained again: thresholds count as found where every entry of every filter comes out as it is in the file.
A change of the rows that changes no entry goes unnoticed.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.encode.thermometer import whole_words
from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, ThermometerBits
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.models.bloom import hashed

_SEED = 123
_TEST_SHARE = 1.0 / 3
_SHARES = (0.9, 1.0)


def with_thresholds(model: BloomWisardModel, table: FeatureTable) -> BloomWisardModel:
    """A model that reads features, from one that reads thermometer bits and the rows it was trained on.

    Args:
        model: as its file has it.
        table: in the order in which they were trained on, or the whole data set in its published order.

    Returns:
        A model with the thermometers of these rows, whose classes have the names of the table's.

    Raises:
        InputError: the model has thresholds already, or other features or classes than the table; or training
            on the rows does not give the contents of its filters.
    """
    bits = model.encoder
    if not isinstance(bits, ThermometerBits):
        raise InputError("the model has thresholds already", value=bits.kind)
    if table.features.shape[1] != bits.thermometers:
        raise InputError(
            "the table has another number of features than the model",
            value=f"{table.features.shape[1]}, not {bits.thermometers}",
        )
    names = _in_order(set(table.labels))
    if len(names) != len(model.classes):
        raise InputError(
            "the table has another number of classes than the model",
            value=f"{len(names)}, not {len(model.classes)}",
        )
    labels = np.array([names.index(label) for label in table.labels])
    for rows in _orders(len(labels)):
        levels = _levels(table.features[rows], bits.levels)
        reached = np.concatenate([table.features[rows] >= level for level in levels], axis=1)
        for share in _SHARES:
            count = int(share * len(rows))
            owners = _owners(model, reached[:count], labels[rows[:count]])
            if owners is not None:
                return _reading_features(model, table, levels, [names[owner] for owner in owners])
    raise InputError(
        "training on these rows does not give the filters of the model, so their thresholds are not its own",
        value=f"{len(labels)} rows",
        hint="give the rows it was trained on, in their published order, or leave --table out",
    )


def _in_order(labels: set[str]) -> list[str]:
    """Class names as BTHOWeN numbers them: numbers by their value, or texts by the alphabet."""
    try:
        return sorted(labels, key=float)
    except ValueError:
        return sorted(labels)


def _orders(count: int) -> Iterator[NDArray[np.int64]]:
    """Rows that may have been trained on, in the order of training."""
    # What pandas' `sample` draws from this seed; NumPy keeps the stream of this generator as it is.
    shuffled = np.random.RandomState(_SEED).permutation(count).astype(np.int64)
    yield shuffled[int(np.floor(_TEST_SHARE * count)) :]
    yield shuffled
    yield np.arange(count)


def _levels(features: NDArray[np.float64], bits: int) -> NDArray[np.float64]:
    """Thresholds ``[bits, features]``: equally probable parts of a normal distribution."""
    from scipy.stats import norm

    parts = norm.ppf(np.arange(1, bits + 1) / (bits + 1))
    return np.asarray(features.mean(axis=0) + parts[:, np.newaxis] * features.std(axis=0))


def _owners(model: BloomWisardModel, bits: NDArray[np.bool_], labels: NDArray[np.int64]) -> list[int] | None:
    """For each class of the model the label whose rows give its filters; None if there is none.

    Args:
        model: the model.
        bits: bool ``[rows, width]``.
        labels: int64 ``[rows]``.
    """
    counts = np.stack([_counts(model, bits[labels == label]) for label in range(len(model.classes))])
    # One threshold has to part the entries of all filters, so as many reach it as are set in the model.
    reach = int(model.contents.sum())
    threshold = int(np.sort(counts, axis=None)[-reach]) if reach else int(counts.max()) + 1
    return _matched(counts >= max(threshold, 1), model.contents)


def _matched(found: NDArray[np.bool_], contents: NDArray[np.bool_]) -> list[int] | None:
    """Which of the trained discriminators each of a model's is, in their order where several are equal."""
    left = list(range(len(found)))
    owners = []
    for discriminator in contents:
        owner = next((each for each in left if np.array_equal(found[each], discriminator)), None)
        if owner is None:
            return None
        left.remove(owner)
        owners.append(owner)
    return owners


def _counts(model: BloomWisardModel, bits: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The entries of one class's filters after training on its rows: int64 ``[filters, entries]``."""
    rows = np.ascontiguousarray(bits.T)
    places = np.stack([hashed(rows, model.mapping, constants) for constants in model.hashes])
    filters = np.arange(len(model.mapping))
    counts = np.zeros(model.contents.shape[1:], dtype=np.int64)
    # A sample raises the lowest of its entries, and others only up to that, so the order matters.
    for sample in range(len(bits)):
        here = counts[filters, places[:, :, sample]]
        counts[filters, places[:, :, sample]] = np.maximum(here, here.min(axis=0) + 1)
    return counts


def _reading_features(
    model: BloomWisardModel, table: FeatureTable, levels: NDArray[np.float64], names: list[str]
) -> BloomWisardModel:
    count, features = levels.shape
    mapping = np.where(
        model.mapping == ZERO, ZERO, model.mapping % features * count + model.mapping // features
    )
    thresholds = tuple(tuple(map(float, column)) for column in levels.T)
    return replace(
        model,
        encoder=Thermometer(thresholds, input=whole_words(table.features)),
        mapping=mapping.astype(np.int32),
        classes=tuple(names),
        origin=dict(model.origin)
        | {"encoder": "thermometers fitted to the rows of training, which give every entry of the filters"},
    )
