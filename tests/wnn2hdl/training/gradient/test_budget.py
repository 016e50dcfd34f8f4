"""Nodes are dropped until the circuit fits, the least useful first."""

import numpy as np
import pytest

from tests.wnn2hdl.training.gradient.test_cost import CLASSES, some_inputs, some_layer
from wnn2hdl.errors import InputError
from wnn2hdl.training.gradient.budget import Budget


@pytest.mark.slow
def test_the_best_nodes_that_fit_are_kept() -> None:
    inputs = some_inputs()
    layer, effects = some_layer(inputs, 8), np.tile(np.arange(8.0), 3)
    budget = Budget(40, inputs, CLASSES)
    kept = budget.fitted(layer, effects)
    assert 1 <= kept.nodes_per_class < 8
    assert budget.luts(kept) <= 40 < budget.luts(layer.best_nodes(kept.nodes_per_class + 1, effects))
    assert np.array_equal(kept.weights[-1], layer.weights[-1])
    assert Budget(1000, inputs, CLASSES).fitted(layer, effects).nodes_per_class == 8
    with pytest.raises(InputError, match="no network of these classes fits: 2 LUTs; allow more"):
        Budget(2, inputs, CLASSES).fitted(layer, effects)
