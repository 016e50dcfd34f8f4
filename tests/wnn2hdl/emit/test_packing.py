"""Two look-up tables in one cell of the emitted Verilog."""

import numpy as np

from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir import Lut, LutNetwork, Mux
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.verify.equivalence import Circuit as Module
from wnn2hdl.verify.equivalence import evaluate, find_differences

INPUTS = ("a", "b", "c", "d", "e")
PAIR = LutNetwork(
    INPUTS,
    (Lut("t0", ("c", "a"), 0b0110), Lut("t1", ("e", "d", "b", "a"), 0x8E2B), Lut("t2", ("d",), 0b01)),
    (("o", "t0"), ("p", "t1"), ("q", "t2")),
)


def emitted(network: LutNetwork, style: str = "cells") -> str:
    word = (Slice("x", 0, len(network.inputs)),)
    outputs = {name: (Slice("t", i),) for i, (name, _) in enumerate(network.outputs)}
    table = Table("t", word, network)
    circuit = Circuit("c", "A table.", (Port("x", len(network.inputs)),), (table,), outputs)
    return verilog(
        component(circuit, style="cells" if style == "cells" else "equations"), prefix="", header=[]
    )


def test_a_pair_is_one_cell_and_computes_what_its_tables_do() -> None:
    text = emitted(PAIR)
    assert text.count("LUT6_2 #(") == 1
    assert text.count("LUT1 #(") + text.count("LUT2 #(") == 1
    assert find_differences(
        [(Module((text,), "c"), Module((emitted(PAIR, "equations"),), "c"))], timeout=60
    ) == [None]
    answers = evaluate(Module((text,), "c"), {"x": 0b01101}, {"x": 5}, ["o", "p", "q"])
    assert [answers[name] for name in "opq"] == PAIR.evaluate(np.array(0b01101)).astype(int).tolist()


def test_a_table_before_a_multiplexer_keeps_its_own_cell() -> None:
    cells = (Lut("t0", ("a", "b"), 6), Lut("t1", ("a", "b"), 8), Mux("m", "t0", "t1", "c"))
    assert "LUT6_2" not in emitted(LutNetwork(INPUTS, cells, (("o", "m"),)))


def test_equations_have_no_cells() -> None:
    assert "LUT" not in emitted(PAIR, "equations")
