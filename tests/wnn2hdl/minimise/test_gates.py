"""Gate networks mapped to LUTs."""

import pytest
from hypothesis import given, settings

from benchmarks.gates import multiplier
from tests.small_gates import all_inputs, gate_networks
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.packing import packed_luts
from wnn2hdl.lower.gates import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.minimise.gates import map_gates


def silent(step: str, done: int, total: int) -> None:
    pass


@settings(max_examples=15, deadline=None)
@given(gate_networks())
def test_a_mapped_network_answers_as_its_gates_on_every_input(model: LogicModel) -> None:
    bits = all_inputs(model)
    mapped = minimise(network(model), 1, silent).circuit
    assert (mapped.evaluate({"inputs": bits})["outputs"] == model.evaluate(bits)).all()


def test_numbers_of_more_than_seven_bits_reach_the_mapper() -> None:
    model = multiplier(5)
    bits = all_inputs(model)
    luts, _ = map_gates(model, 0, silent)
    assert len(model.gates) > 128
    assert (luts.evaluate_bits(bits) == model.evaluate(bits)).all()


@pytest.mark.parametrize("effort", range(4))
def test_more_effort_never_takes_more_luts(effort: int) -> None:
    model = multiplier(4)
    steps: list[int] = []
    luts, method = map_gates(model, effort, lambda step, done, total: steps.append(done))
    least, _ = map_gates(model, 0, silent)
    assert packed_luts(luts) <= packed_luts(least)
    assert steps == list(range(effort + 2))
    assert method
