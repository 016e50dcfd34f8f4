"""Simulation in its own process says what it says in this one."""

from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.build.design import Design
from wnn2hdl.build.simulating import simulate_apart, simulate_parts
from wnn2hdl.errors import ToolError
from wnn2hdl.ir import LutNetwork
from wnn2hdl.ir.nodes import Table


@pytest.mark.slow
def test_a_right_circuit_runs_on_every_cared_for_code(pixel_build: Path) -> None:
    design = Design.load(pixel_build)
    assert design.care is not None
    cared = int(design.care.project(tuple(range(8))).sum())
    assert simulate_parts(design, ["pixel"]) == ({"pixel": cared}, None)
    assert simulate_apart(pixel_build, ["pixel"]) == ({"pixel": cared}, None)


@pytest.mark.slow
def test_a_wrong_circuit_is_reported_in_words(pixel_build: Path, tmp_path: Path) -> None:
    design = Design.load(pixel_build)
    (decision,) = design.circuit.nodes
    assert isinstance(decision, Table)
    stuck = LutNetwork(decision.function.inputs, (), (("class_bit0", "1"),))
    wrong = replace(design.circuit, nodes=(replace(decision, function=stuck),))
    replace(design, circuit=wrong).save(tmp_path)
    vectors, failure = simulate_apart(tmp_path, ["pixel"])
    assert vectors == {}
    assert failure is not None
    assert "the model says" in failure


def test_a_process_that_fails_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ToolError, match="failed"):
        simulate_apart(tmp_path / "nothing", ["pixel"])
