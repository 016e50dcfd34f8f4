"""From a table of feature vectors to a trained WiSARD, and how well others of its kind do."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.encode import Spacing, fit_thermometer, whole_words
from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import SparseWisardModel
from wnn2hdl.progress import Progress
from wnn2hdl.training.folds import dealt, fold_count
from wnn2hdl.wisard import WisardClassifier, draw_mapping
from wnn2hdl.wisard.sparse import train_sparse

DENSE_COUNTS = 1 << 22
"""Counts of all discriminators together up to which RAMs hold every address: 32 MiB."""


@dataclass(frozen=True)
class TableOptions:
    """How a WiSARD over features is built.

    Attributes:
        levels: thresholds of each feature's thermometer.
        thermometer: where they lie.
        words: the format in which hardware reads the features; None for the narrowest format of whole
            numbers where all features are whole, and for real numbers otherwise.
        address_bits: n, address bits of a RAM.
        rams: k, RAMs of a discriminator; None for as many as read each bit once.
        per_class: draw a mapping for each class instead of one for all.
        bleaching: the threshold; None finds it by leaving out one sample at a time.
    """

    levels: int = 8
    thermometer: Spacing = "quantiles"
    words: FixedPoint | None = None
    address_bits: int = 6
    rams: int | None = None
    per_class: bool = False
    bleaching: int | None = None


def train_table(table: FeatureTable, options: TableOptions, seed: int) -> WisardModel | SparseWisardModel:
    """Train on all rows of a table.

    Discriminators of more than `DENSE_COUNTS` counts become a model of sparse RAMs.

    Args:
        table: the samples.
        options: how the network is built.
        seed: of the tuple mapping.

    Raises:
        InputError: the table has one class only or nothing but constant features, or n does not fit.
    """
    classes, owners = table.owned()
    notes = {
        "seed": seed,
        "rows": len(table.labels),
        "columns": list(table.columns),
        "bleaching": "auto" if options.bleaching is None else "given",
        "levels": options.levels,
        "thermometer": options.thermometer,
    }
    return _train(table.features, owners, classes, options, seed, notes)


def cross_validate_table(
    table: FeatureTable, options: TableOptions, seeds: Sequence[int], progress: Progress
) -> NDArray[np.int64]:
    """Rows by true class and answer when a model answers that has not seen them.

    For each seed the rows are `dealt` out to folds anew; thermometer, mapping, counts and bleaching threshold
    of a fold come from the other folds alone.

    Args:
        table: the samples.
        options: how the networks are built.
        seeds: of the folds and mappings.
        progress: reports each fold.

    Returns:
        int64 ``[seeds, classes, classes]``, classes in alphabetical order.

    Raises:
        InputError: as `train_table`, or the table has fewer than two rows.
    """
    classes = tuple(sorted(set(table.labels)))
    owners = np.searchsorted(classes, table.labels)
    folds = fold_count(len(owners))
    if folds < 2 or len(classes) < 2:
        raise InputError("cross-validation needs two rows of two classes", hint="give more rows")
    confusion = np.zeros((len(seeds), len(classes), len(classes)), dtype=np.int64)
    for position, seed in enumerate(seeds):
        fold_of = dealt(owners, folds, seed)
        for fold in range(folds):
            progress("cross-validating", position * folds + fold, len(seeds) * folds)
            test = fold_of == fold
            model = _train(table.features[~test], owners[~test], classes, options, seed, {})
            assert isinstance(model.encoder, Thermometer)
            answers = model.evaluate(model.encoder.bits(table.features[test]))
            np.add.at(confusion[position], (owners[test], answers), 1)
    progress("cross-validating", len(seeds) * folds, len(seeds) * folds)
    return confusion


def _train(
    features: NDArray[np.float64],
    owners: NDArray[np.int64],
    classes: tuple[str, ...],
    options: TableOptions,
    seed: int,
    notes: dict[str, Any],
) -> WisardModel | SparseWisardModel:
    words = options.words or whole_words(features)
    encoder = fit_thermometer(features, options.levels, options.thermometer, words)
    rams = options.rams or -(-encoder.width // options.address_bits)
    groups = len(classes) if options.per_class else 1
    mapping = draw_mapping(encoder.width, rams, options.address_bits, seed, groups)
    bits = encoder.bits(features)
    if len(classes) * rams << options.address_bits > DENSE_COUNTS:
        return train_sparse(bits, owners, encoder, classes, mapping, options.bleaching, notes)
    network = WisardClassifier(mapping=mapping, bleaching=options.bleaching or "auto")
    network.partial_fit(bits, owners, classes=np.arange(len(classes)))
    return replace(network.model(encoder), classes=classes, training=notes)
