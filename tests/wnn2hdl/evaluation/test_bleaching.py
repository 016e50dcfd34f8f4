"""A threshold that rises for each sample against fixed ones, on labelled rows."""

from dataclasses import replace

import numpy as np

from tests.small_networks import wisard
from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.evaluation.bleaching import compare_thresholds
from wnn2hdl.evaluation.rows import row_confusion
from wnn2hdl.ir.models import Dynamic


def test_each_fixed_threshold_is_that_of_a_model_of_its_own() -> None:
    model = replace(wisard(1), bleaching=Dynamic())
    features = np.random.default_rng(0).uniform(-4, 4, (300, 3))
    labels = tuple(np.where(features[:, 0] > 0, "a", "b").tolist())
    table = FeatureTable(("x", "y", "z"), features, labels)
    found = compare_thresholds(model, table)

    def right(bleaching: int | Dynamic) -> float:
        confusion = row_confusion(replace(model, bleaching=bleaching), table, None)
        return float(confusion.trace() / confusion.sum())

    assert found.rows == 300
    assert found.as_given == right(Dynamic())
    assert found.fixed == {threshold: right(threshold) for threshold in (1, 2, 3)}
    assert right(found.best) == max(found.fixed.values())
