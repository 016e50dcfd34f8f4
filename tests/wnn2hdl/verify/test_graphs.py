"""Circuits as graphs: equal ones are proved, a gate that is wrong is found."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.gates import multiplier
from wnn2hdl.errors import ToolError
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.gates import gates_specification, stimulus
from wnn2hdl.verify.graphs import difference_of_graphs, graph_of, graph_of_model
from wnn2hdl.verify.proof import prove
from wnn2hdl.verify.signals import read_signals


def mutant(model: LogicModel, gate: int) -> LogicModel:
    """The network with one input of a gate inverted."""
    gates = model.gates.copy()
    gates[gate, 0] ^= 1
    return replace(model, gates=gates)


def test_a_network_equals_itself() -> None:
    graph = graph_of_model(multiplier(5))
    assert difference_of_graphs(graph, graph) is None


@pytest.mark.parametrize("gate", [0, 60, -1])
def test_a_wrong_gate_is_found_with_inputs_that_show_it(gate: int) -> None:
    model = multiplier(4)
    wrong = mutant(model, gate)
    found = difference_of_graphs(graph_of_model(model), graph_of_model(wrong))
    assert isinstance(found, list)
    assert (model.evaluate([found]) != wrong.evaluate([found])).any()


def test_graphs_of_other_ports_are_refused() -> None:
    with pytest.raises(ToolError, match="different ports"):
        difference_of_graphs(graph_of_model(multiplier(2)), graph_of_model(multiplier(3)))


TABLES = """
module half(input [1:0] inputs, output [1:0] outputs);
  LUT2 #(.INIT(4'h6)) low (.I0(inputs[0]), .I1(inputs[1]), .O(outputs[0]));
  LUT2 #(.INIT(4'h{contents})) high (.I0(inputs[0]), .I1(inputs[1]), .O(outputs[1]));
endmodule
"""


def half_adder() -> LogicModel:
    """Gates: both, neither, and what is left."""
    gates = np.array([[2, 4], [3, 5], [7, 9]], dtype=np.uint32)
    return LogicModel(("a", "b"), ("sum", "carry"), gates, np.array([10, 6], dtype=np.uint32))


@pytest.mark.parametrize(("contents", "status"), [("8", "proved"), ("9", "refuted")])
def test_verilog_of_tables_is_proved_or_refuted(contents: str, status: str) -> None:
    circuit = Circuit((TABLES.replace("{contents}", contents),), "half")
    proof = prove(gates_specification(half_adder()), {"network": circuit})["network"]
    assert proof.status == status
    assert (proof.counterexample is None) == (status == "proved")


def test_the_tables_of_verilog_become_a_graph_of_the_same_function() -> None:
    (signals,) = read_signals([Circuit((TABLES.replace("{contents}", "8"),), "half")])
    assert signals is not None
    assert difference_of_graphs(graph_of(signals), graph_of_model(half_adder())) is None


def test_few_inputs_are_all_tried_and_of_many_the_corners() -> None:
    assert len(stimulus(multiplier(4))) == 256
    bits = stimulus(multiplier(8))
    assert len(bits) == 4096
    assert {0, 1, 15, 16} <= set(bits.sum(axis=1).tolist())
