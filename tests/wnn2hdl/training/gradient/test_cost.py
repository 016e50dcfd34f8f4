"""Costs are those of the build that `compile` makes."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.training.gradient.cost import affordable_nodes, decision_luts, network_luts
from wnn2hdl.training.gradient.inputs import InputBits, choose_inputs
from wnn2hdl.training.gradient.layer import VotingLayer

CLASSES = ("a", "b", "c")


def silent(step: str, done: int, total: int) -> None:
    pass


def some_inputs() -> InputBits:
    features = np.random.default_rng(0).integers(0, 256, (300, 9)).astype(np.float64)
    return choose_inputs(features, FixedPoint.parse("UQ8.0"), 2, (3, 3))


def some_layer(inputs: InputBits, per_class: int) -> VotingLayer:
    rng = np.random.default_rng(1)
    nodes = 3 * per_class
    weights = rng.uniform(-1, 1, (nodes, 64)).astype(np.float32)
    return VotingLayer(rng.integers(0, inputs.width, (6, nodes)), weights, 3)


def some_model(per_class: int) -> LutGroupModel:
    inputs = some_inputs()
    return inputs.model(some_layer(inputs, per_class), CLASSES)


@pytest.mark.slow
def test_a_network_costs_what_its_build_counts(tmp_path: Path) -> None:
    model = some_model(3)
    build = compile_model(model, tmp_path / "build", CompileOptions(target="network"), silent)
    assert build.failure is None
    assert build.report["parts"]["network"]["luts"] == network_luts(model) > 9


def test_as_many_nodes_as_their_votes_and_the_winner_leave_room_for() -> None:
    nodes = affordable_nodes(20, 3)
    costs = [3 * count + decision_luts(3, count) for count in (nodes, nodes + 1)]
    assert costs[0] <= 20 < costs[1]
    with pytest.raises(InputError, match="no network of 3 classes fits: 2 LUTs; allow at least"):
        affordable_nodes(2, 3)
