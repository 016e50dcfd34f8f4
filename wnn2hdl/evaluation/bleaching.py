"""What a bleaching threshold that rises for each sample is worth against one that is fixed."""

from dataclasses import dataclass

import numpy as np

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.evaluation.rows import feature_bits, true_classes
from wnn2hdl.ir.models import SparseWisardModel
from wnn2hdl.ir.models.base import winner


@dataclass(frozen=True)
class Thresholds:
    """Accuracies of a model on some rows, 0 to 1.

    Attributes:
        rows: how many there are.
        as_given: of the model as it is.
        fixed: of each fixed threshold from 1 up that answers otherwise than the one before.
    """

    rows: int
    as_given: float
    fixed: dict[int, float]

    @property
    def best(self) -> int:
        """The fixed threshold that is most often right, the lowest of several."""
        return max(self.fixed, key=lambda threshold: (self.fixed[threshold], -threshold))


def compare_thresholds(model: SparseWisardModel, table: FeatureTable) -> Thresholds:
    """Measure a model on labelled rows, as it is and with every fixed threshold.

    Raises:
        InputError: the model cannot read the rows, or has no class for a label.
    """
    truth = true_classes(model.classes, table)
    bits = feature_bits(model, table.features)
    votes = model.votes(bits)
    # Between two counts that occur no RAM changes its answer; a threshold is then the lowest of its kind.
    thresholds = [1, *(int(count) + 1 for count in np.unique(votes[votes > 0])[:-1])]
    fixed = {
        threshold: float((winner((votes >= threshold).sum(axis=2), model.ties) == truth).mean())
        for threshold in thresholds
    }
    return Thresholds(len(truth), float((model.evaluate(bits) == truth).mean()), fixed)
