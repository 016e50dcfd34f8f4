"""Circuits with registers compute the same, their latency later, and are proved to."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.random_circuits import circuits, random_inputs
from tests.wnn2hdl.schedule.conftest import chain
from tests.wnn2hdl.schedule.test_choose import COMBINATIONAL
from wnn2hdl.elaborate import component
from wnn2hdl.emit import cells_model, verilog
from wnn2hdl.ir import LutNetwork
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Register, Sum, Table
from wnn2hdl.ir.wires import Port, Slice, width_of
from wnn2hdl.schedule import for_stages, pipelined
from wnn2hdl.synth import synthesise
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.equivalence import Circuit as Module
from wnn2hdl.verify.equivalence import find_differences
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import Claim


def piped(circuit: Circuit, stages: int) -> Circuit:
    return pipelined(circuit, for_stages(circuit, stages))


def text(circuit: Circuit) -> str:
    return verilog(component(circuit, style="cells"), prefix="", header=[])


def register_bits(circuit: Circuit) -> int:
    return sum(width_of(node.word) for node in circuit.nodes if isinstance(node, Register))


def is_equal(circuit: Circuit, verilog: str, latency: int) -> bool:
    """Whether Verilog is the circuit so many cycles later."""
    reference = Module((text(circuit),), circuit.name)
    return find_differences([(reference, Module((verilog,), circuit.name, latency))], timeout=60) == [None]


@settings(max_examples=50, deadline=None)
@given(circuits(COMBINATIONAL), st.integers(1, 5))
def test_a_pipeline_computes_the_same_with_a_new_input_in_each_cycle(circuit: Circuit, stages: int) -> None:
    pipeline = piped(circuit, stages)
    assert pipeline.latency == stages
    assert pipeline.definitions().keys() == circuit.definitions().keys()
    inputs = random_inputs(circuit, 50)
    expected, answers = circuit.evaluate(inputs), pipeline.evaluate(inputs)
    assert all((answers[port] == expected[port]).all() for port in expected)
    simulate(component(pipeline, style="cells"), inputs, expected)


@settings(max_examples=4, deadline=None, derandomize=True)
@given(circuits(("table", "sum", "argmax", "match", "instance")), st.integers(1, 4))
def test_the_verilog_of_a_pipeline_is_proved_equal_to_the_circuit(circuit: Circuit, stages: int) -> None:
    assert is_equal(circuit, text(piped(circuit, stages)), stages)


def test_one_register_more_or_less_is_refuted() -> None:
    circuit = chain(4)
    right = text(piped(circuit, 2))
    assert is_equal(circuit, right, 2)
    assert "stage_1 <= {parity_0_t1, bits[4:3]}" in right
    for wrong in (
        right.replace("stage_1[0]", "bits[3]"),
        right.replace("stage_1[1]", "bits[4]"),
        right.replace("odd <= parity_1_t3", "{odd, late} <= {late, parity_1_t3}").replace(
            "wire p", "reg late; wire p", 1
        ),
    ):
        assert wrong != right
        assert not is_equal(circuit, wrong, 2)


def test_the_counted_registers_are_those_that_were_planned(nine: Circuit) -> None:
    pipeline = piped(nine, 5)
    planned = sum(
        register_bits(definition) * (9 if name == "chain" else 1)
        for name, definition in pipeline.definitions().items()
    )
    resources = synthesise(text(pipeline), "nine").resources
    assert (resources.ffs, resources.srl) == (planned, 0)
    assert resources.delay_ps is not None
    # Yosys counts the clock's buffer, 96 ps, and no wires.
    assert resources.delay_ps - 96 <= for_stages(nine, 5).period


@pytest.mark.simulator
@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_other_simulators_agree(nine: Circuit, tmp_path: Path, simulator: CompiledSimulator) -> None:
    sources = [tmp_path / "cells.v", tmp_path / "nine.v"]
    sources[0].write_text(cells_model())
    sources[1].write_text(text(piped(nine, 3)))
    inputs = random_inputs(nine, 200)
    claim = Claim("nine", *nine.widths, "none", nine.evaluate, None)
    answers, _ = run_compiled(claim, "nine", sources, inputs, simulator, latency=3)
    assert all((answers[port] == bits).all() for port, bits in nine.evaluate(inputs).items())
    late, _ = run_compiled(claim, "nine", sources, inputs, simulator, latency=4)
    assert not all((late[port] == bits).all() for port, bits in nine.evaluate(inputs).items())


def test_names_that_are_taken_are_not_given_again() -> None:
    stage = Port("stage_1", 3)
    nodes = (Sum("total", stage.word), Sum("total_0", stage.word))
    drivers = {"a": (Slice("total", 0, 2),), "b": (Slice("total_0", 0, 2),)}
    circuit = Circuit("named", "Named.", (stage,), nodes, drivers)
    pipeline = piped(circuit, 2)
    inputs = random_inputs(circuit, 8)
    simulate(component(pipeline, style="cells"), inputs, circuit.evaluate(inputs))
    assert "stage_1x" in {node.name for node in pipeline.nodes}


def test_constants_pass_through_a_pipeline() -> None:
    bits = Port("bits", 2)
    always = Table("fixed_bits", bits.word, LutNetwork(("i0", "i1"), (), (("low", "0"), ("high", "1"))))
    circuit = Circuit("fixed", "Fixed.", (bits,), (always,), {"o": (Slice("fixed_bits", 0, 2),)})
    pipeline = piped(circuit, 2)
    assert (pipeline.evaluate({"bits": np.zeros((1, 2), np.bool_)})["o"] == [[False, True]]).all()


def test_a_schedule_of_another_circuit_or_with_a_cell_too_early_is_refused() -> None:
    stages = for_stages(chain(4), 2)
    with pytest.raises(KeyError):
        pipelined(chain(5), stages)
    late = {**stages.places, ("chain", ("parity", "t0")): 1}
    with pytest.raises(KeyError):
        pipelined(chain(4), replace(stages, places=late))
