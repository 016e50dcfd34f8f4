"""Circuits as JSON."""

import copy
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.random_circuits import circuits, random_inputs
from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import TruthTable
from wnn2hdl.ir.care import Codes, Implied
from wnn2hdl.ir.circuit import Care, Circuit, Instance
from wnn2hdl.ir.circuit_file import circuit_from_json, circuit_to_json
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Port, Slice

A, B = Port("a", 3), Port("b", 3)


def every_kind() -> Circuit:
    """One node of each kind."""
    inverter = TruthTable.exact(("x",), ("y",), np.array([[True], [False]]))
    inner = Circuit(
        "inner",
        "Inner.",
        (A,),
        (Table("inverter", (Slice("a"),), inverter),),
        {"y": (Slice("inverter"),)},
        (Care(A.word, Codes(np.arange(8) < 6)),),
    )
    nodes = (
        Instance("inner_one", inner, {"a": B.word}),
        Sum("ones", A.word, (1, 2, 3)),
        Sum("less", A.word, (1, -2, 3), 1, 3),
        Match("same", A.word, B.word),
        Threshold("high", A.word, 4),
        ArgMax("best", (A.word, B.word), "last"),
        Register("late", (Slice("ones", 0, 3), Slice("same", 0, 2), Slice("high"), Slice("best")), 2),
    )
    care = (Care(A.word, Implied(3, ((0, 1, 2),))),)
    carries: dict[int, Slice | bool] = {0: True, 3: Slice("y", 2)}
    return Circuit("outer", "Outer.", (A, B), nodes, {"y": (Slice("late", 0, 7),)}, care, carries)


EVERY_KIND = circuit_to_json(every_kind())


@settings(max_examples=50, deadline=None)
@given(circuits() | circuits(mapped=False))
def test_a_circuit_reads_back_as_it_was_written(circuit: Circuit) -> None:
    data = json.loads(json.dumps(circuit_to_json(circuit)))
    read = circuit_from_json(data)
    assert circuit_to_json(read) == circuit_to_json(circuit)
    assert read.latency == circuit.latency
    inputs = random_inputs(circuit, 10)
    answers = read.evaluate(inputs)
    assert all(np.array_equal(answers[port], bits) for port, bits in circuit.evaluate(inputs).items())


def test_care_sets_and_definitions_go_along() -> None:
    read = circuit_from_json(EVERY_KIND)
    assert [(item["name"], item["care"][0]["kind"]) for item in circuit_to_json(read)] == [
        ("inner", "codes"),
        ("outer", "implied"),
    ]


def test_what_a_circuit_carries_goes_along() -> None:
    assert circuit_from_json(EVERY_KIND).carries == {0: True, 3: Slice("y", 2)}


ANYTHING = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**70), 2**70)
    | st.floats()
    | st.text(max_size=5)
    | st.just("a[0:0]"),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@given(ANYTHING)
def test_anything_else_is_no_circuit(data: Any) -> None:
    with pytest.raises(ModelFileError, match="not a circuit"):
        circuit_from_json(data)


@settings(max_examples=300, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(st.data())
def test_a_damaged_circuit_is_refused_in_one_way_or_is_whole(data: st.DataObject) -> None:
    damaged = copy.deepcopy(EVERY_KIND)
    place: Any = damaged
    while True:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        key = data.draw(st.sampled_from(keys))
        if isinstance(place[key], dict | list) and place[key] and data.draw(st.booleans()):
            place = place[key]
            continue
        if data.draw(st.booleans()):
            del place[key]
        else:
            place[key] = data.draw(ANYTHING)
        break
    try:
        circuit = circuit_from_json(damaged)
    except ModelFileError:
        return
    assert circuit_to_json(circuit)


def definition(name: str, **changes: Any) -> dict[str, Any]:
    whole = {
        "name": name,
        "summary": "",
        "inputs": {"a": 1},
        "nodes": [],
        "outputs": {"y": ["a[0:0]"]},
        "care": [],
        "carries": {},
    }
    return whole | changes


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ([], "not a circuit"),
        ([definition("c", inputs={"a": 0})], "port a has 0 bits"),
        ([definition("c", inputs={"a b": 1})], "'a b' is not a name"),
        ([definition("c", nodes=[{"kind": "memory", "name": "m"}])], "memory"),
        ([definition("c", nodes=[{"kind": "sum", "name": 3, "word": ["a[0:0]"]}])], "3 is not a name"),
        ([definition("c", nodes=[{"kind": "instance", "name": "i", "circuit": "x", "inputs": {}}])], "x"),
        ([definition("c"), definition("c")], "two circuits are called c"),
        ([definition("c", carries={"0": "y[1:1]"})], "carries signal 0"),
        ([definition("c", carries={"0": "a[0:0]"})], "which is not an output"),
    ],
)
def test_the_fault_is_named(data: Any, message: str) -> None:
    with pytest.raises(ModelFileError, match=message):
        circuit_from_json(data)
