"""Circuits taken apart into cells."""

import numpy as np
import pytest

from tests.wnn2hdl.schedule.conftest import chain
from wnn2hdl.ir import LutNetwork, TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.schedule.logic import WHOLE, Logic

BITS = Port("bits", 4)


def test_cells_read_what_drives_them_whatever_node_it_is_in() -> None:
    logic = Logic(chain(2))
    assert logic.reads == {
        ("parity", "t0"): (("bits", 0), ("bits", 1)),
        ("parity", "t1"): (("parity", "t0"), ("bits", 2)),
    }
    assert logic.outputs == {"odd": (("parity", "t1"),)}
    assert logic.driver(("parity", "t1")) == ("parity", "t1")
    assert logic.driver(("bits", 2)) is None


def test_what_is_a_wire_has_no_cell_and_a_comparison_stays_whole() -> None:
    nodes = (Sum("same", (Slice("bits", 3),)), Threshold("reached", BITS.word, 5))
    drivers = {"wire_bit": (Slice("same"),), "above": (Slice("reached"),)}
    logic = Logic(Circuit("wires", "Wires.", (BITS,), nodes, drivers))
    assert list(logic.reads) == [("reached", WHOLE)]
    assert logic.outputs == {"wire_bit": (("bits", 3),), "above": (("reached", 0),)}


def test_cells_that_no_output_depends_on_are_left_out() -> None:
    circuit = chain(3)
    odd = Slice("parity")
    unread = Sum("unread", (odd, odd))
    logic = Logic(Circuit("more", "More.", circuit.inputs, (*circuit.nodes, unread), {"odd": (odd,)}))
    assert {node for node, _ in logic.reads} == {"parity"}


def test_a_constant_output_is_a_cell_that_reads_anything() -> None:
    always = Table("fixed_bits", (Slice("bits", 1),), LutNetwork(("i0",), (), (("o", "1"),)))
    logic = Logic(Circuit("one", "One.", (BITS,), (always,), {"high": (Slice("fixed_bits"),)}))
    assert logic.reads == {("fixed_bits", "1"): (("bits", 1),)}


def test_registers_and_tables_that_are_not_mapped_are_refused() -> None:
    register = Register("late", BITS.word)
    with pytest.raises(ValueError, match="late is a register already"):
        Logic(Circuit("late", "Late.", (BITS,), (register,), {"later": (Slice("late", 0, 4),)}))
    table = Table("raw", (Slice("bits"),), TruthTable.exact(("i0",), ("o",), np.array([[False], [True]])))
    with pytest.raises(ValueError, match="raw is not mapped to LUTs"):
        Logic(Circuit("raw", "Raw.", (BITS,), (table,), {"high": (Slice("raw"),)}))
