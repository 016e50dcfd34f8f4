"""The circuit: evaluation, latency, definitions and what is refused."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from tests.random_circuits import circuits, random_inputs
from wnn2hdl.ir import TruthTable, codes_to_bits
from wnn2hdl.ir.care import Everything
from wnn2hdl.ir.circuit import Care, Circuit, Instance, Node
from wnn2hdl.ir.nodes import Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Port, Slice, Word

A, B = Port("a", 3), Port("b", 3)
INVERTER = TruthTable.exact(("x",), ("y",), np.array([[True], [False]]))


def circuit(*nodes: Node, name: str = "c", care: tuple[Care, ...] = (), **drivers: Word) -> Circuit:
    return Circuit(name, "A circuit.", (A, B), nodes, drivers, care)


ALIKE = circuit(Match("same", A.word, B.word), name="alike", count=(Slice("same", 0, 2),))


def both(inner: Circuit, *, second: Circuit | None = None) -> Circuit:
    """Two instances in one circuit."""
    words = {"a": A.word, "b": B.word}
    nodes = (Instance("one", inner, words), Instance("two", second or inner, words))
    return circuit(*nodes, y=(Slice("one.count", 0, 2),), z=(Slice("two.count", 0, 2),))


def test_nodes_are_evaluated_one_after_the_other() -> None:
    nodes = (Sum("ones", A.word), Threshold("many", (Slice("ones", 0, 2),), 2))
    chain = circuit(*nodes, y=(Slice("many"), Slice("b", 2)), ones_out=(Slice("ones", 0, 2),))
    assert chain.outputs == (Port("y", 2), Port("ones_out", 2))
    inputs = {"a": codes_to_bits([0b011, 0b100], 3), "b": codes_to_bits([0b011, 0b100], 3)}
    answers = chain.evaluate(inputs)
    assert answers["y"].tolist() == [[True, False], [False, True]]
    assert answers["ones_out"].tolist() == [[False, True], [True, False]]


def test_an_instance_answers_as_its_circuit() -> None:
    inputs = random_inputs(ALIKE, 20)
    answers = both(ALIKE).evaluate(inputs)
    assert np.array_equal(answers["y"], ALIKE.evaluate(inputs)["count"])
    assert np.array_equal(answers["z"], answers["y"])


def test_latencies_add_up_through_instances() -> None:
    late = circuit(Register("r", A.word, 2), name="late", y=(Slice("r", 0, 3),))
    words = {"a": A.word, "b": B.word}
    outer = circuit(Instance("i", late, words), Register("s", (Slice("i.y", 0, 3),)), y=(Slice("s"),))
    assert (ALIKE.latency, late.latency, outer.latency) == (0, 2, 3)


def test_words_of_different_latencies_do_not_meet() -> None:
    register = Register("r", A.word)
    skewed = circuit(register, Match("m", (Slice("r", 0, 3),), B.word), y=(Slice("m"),))
    with pytest.raises(ValueError, match=r"m in c joins words of the latencies \[0, 1\]"):
        _ = skewed.latency
    with pytest.raises(ValueError, match=r"an output in c joins words of the latencies \[0, 1\]"):
        _ = circuit(register, y=(Slice("r"),), z=B.word).latency


def test_definitions_come_after_those_inside_them_each_once() -> None:
    outer = both(ALIKE)
    assert list(outer.definitions()) == ["alike", "c"]
    assert outer.definitions()["alike"] is ALIKE


def test_two_circuits_of_one_name_are_refused() -> None:
    with pytest.raises(ValueError, match="two circuits are called alike"):
        both(ALIKE, second=replace(ALIKE, summary="Another.")).definitions()
    with pytest.raises(ValueError, match="c is inside itself"):
        both(replace(ALIKE, name="c")).definitions()


def test_tables_go_by_the_names_of_their_circuits_or_their_own_and_are_found_once() -> None:
    def inverters(name: str, count: int) -> Circuit:
        nodes = tuple(Table(f"t{i}", (Slice("a", i),), INVERTER) for i in range(count))
        return circuit(*nodes, name=name, count=(Slice("t0"), Slice("a")))

    assert list(both(inverters("single", 1)).tables()) == ["single"]
    assert list(both(inverters("pair", 2)).tables()) == ["t0", "t1"]


def test_tables_of_one_name_in_two_circuits_go_by_both_names() -> None:
    inner = circuit(
        Table("t0", (Slice("a"),), INVERTER),
        Table("t1", (Slice("b"),), INVERTER),
        name="in",
        y=(Slice("t0"),),
    )
    instance = Instance("i", inner, {"a": A.word, "b": B.word})
    nodes = (instance, Table("t0", (Slice("i.y"),), INVERTER), Table("t2", (Slice("b"),), INVERTER))
    assert list(circuit(*nodes, y=(Slice("t0"),)).tables()) == ["in_t0", "t1", "c_t0", "t2"]


def test_a_change_is_made_once_to_each_definition() -> None:
    seen = []

    def change(definition: Circuit) -> Circuit:
        seen.append(definition.name)
        return replace(definition, summary=f"{definition.summary}!")

    changed = both(ALIKE).rebuilt(change)
    assert seen == ["alike", "c"]
    one, two = (node.circuit for node in changed.nodes if isinstance(node, Instance))
    assert one is two
    assert (changed.summary, one.summary) == ("A circuit.!", "A circuit.!")


@settings(max_examples=25, deadline=None)
@given(circuits())
def test_a_rebuilt_circuit_computes_the_same(random: Circuit) -> None:
    inputs = random_inputs(random, 10)
    rebuilt = random.rebuilt(lambda definition: definition)
    assert rebuilt.latency == random.latency
    answers = rebuilt.evaluate(inputs)
    for port, bits in random.evaluate(inputs).items():
        assert bits.shape == (10, {port.name: port.width for port in random.outputs}[port])
        assert np.array_equal(answers[port], bits)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: circuit(Sum("s", (Slice("x"),))), "s in c reads x before it is driven"),
        (lambda: circuit(Sum("s", (Slice("a", 2, 2),))), r"s in c reads a\[3:2\] of 3 bits"),
        (lambda: circuit(y=(Slice("a", -1),)), "y in c reads a"),
        (lambda: circuit(y=(Slice("a", 0, 0),)), "y in c reads a"),
        (lambda: circuit(y=()), "y in c reads no bits"),
        (lambda: circuit(Sum("a", B.word)), "two drivers of a in c"),
        (lambda: circuit(Sum("s", B.word), Sum("s", A.word)), "two drivers of s in c"),
        (lambda: circuit(Sum("s", B.word), s=A.word), "s in c is an output and a net"),
        (lambda: circuit(a=B.word), "a in c is an output and a net"),
        (lambda: circuit(signal=A.word), "the name signal is a reserved word"),
        (lambda: Circuit("c", "C.", (A, A), (), {"y": A.word}), "two inputs of c have one name"),
        (lambda: circuit(care=(Care(A.word, Everything(4)),)), "a care set of 4 bits is put on"),
        (lambda: circuit(care=(Care((Slice("x"),), Everything(1)),)), "the care set in c reads x"),
        (lambda: Instance("i", ALIKE, {"a": A.word}), "i connects {'a': 3}; alike has the inputs"),
        (lambda: Instance("i", ALIKE, {"a": A.word, "b": (Slice("b"),)}), "alike has the inputs"),
    ],
)
def test_what_does_not_fit_together_is_refused(make: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()
