"""The pass that maps every table of a circuit to LUTs."""

import numpy as np
from hypothesis import given, settings

from tests.random_circuits import circuits
from wnn2hdl.ir import LutNetwork, TruthTable, codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Sum, Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.minimise.circuit import minimise

A = Port("a", 4)
NAMES = ("p", "q", "r", "s")


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def two_tables(care: np.ndarray) -> Circuit:
    values = np.arange(16) % 5 == 0
    odd = TruthTable(NAMES, ("odd",), values[:, np.newaxis], care)
    even = TruthTable.exact(NAMES, ("even",), ~values[:, np.newaxis])
    nodes = (Table("one", A.word, odd), Table("two", A.word, even), Sum("both", (Slice("one"), Slice("two"))))
    return Circuit("pair", "Two tables.", (A,), nodes, {"y": (Slice("both", 0, 2),)})


def test_each_table_has_a_cover_a_network_and_the_name_of_its_method() -> None:
    circuit = two_tables(np.ones(16, dtype=np.bool_))
    done = minimise(circuit, 1, silent)
    assert set(done.covers) == set(done.methods) == {"one", "two"}
    assert all(done.methods.values())
    assert all(isinstance(table.function, LutNetwork) for table in done.circuit.tables().values())
    inputs = {"a": codes_to_bits(np.arange(16), 4)}
    assert np.array_equal(done.circuit.evaluate(inputs)["y"], circuit.evaluate(inputs)["y"])
    assert (
        done.covers["one"].cover.evaluate(np.arange(16))[:, 0].tolist() == (np.arange(16) % 5 == 0).tolist()
    )


def test_answers_outside_the_care_set_are_free() -> None:
    care = np.arange(16) % 5 == 0
    done = minimise(two_tables(care), 1, silent).circuit
    one = done.tables()["one"]
    assert isinstance(one.function, LutNetwork)
    assert one.function.cells == ()
    assert one.function.evaluate(np.flatnonzero(care)).all()


def test_networks_stay_as_they_are() -> None:
    once = minimise(two_tables(np.ones(16, dtype=np.bool_)), 0, silent).circuit
    again = minimise(once, 0, silent)
    assert again.covers == {}
    assert again.circuit.tables() == once.tables()


def test_progress_counts_the_tables() -> None:
    reports = []
    minimise(two_tables(np.ones(16, dtype=np.bool_)), 0, lambda *report: reports.append(report))
    assert reports == [("minimising tables", done, 2) for done in range(3)]


@settings(max_examples=10, deadline=None)
@given(circuits(("table", "instance"), mapped=False))
def test_a_minimised_circuit_equals_the_circuit_where_each_table_cares(circuit: Circuit) -> None:
    mapped = minimise(circuit, 0, silent).circuit.tables()
    for name, table in circuit.tables().items():
        assert isinstance(table.function, TruthTable)
        answers = mapped[name].function.evaluate(np.arange(len(table.function.care)))
        assert table.function.mismatches(answers).size == 0
