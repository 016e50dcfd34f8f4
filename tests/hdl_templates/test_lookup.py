"""LUT networks as hardware; `tests/wnn2hdl/test_elaborate.py` simulates random ones."""

from amaranth.hdl import Const, Fragment, Module, Signal

from hdl_templates.hierarchy import Emission
from hdl_templates.lookup import draw_network, unread_inputs
from wnn2hdl.ir import Lut, LutNetwork, Mux, Style

NETWORK = LutNetwork(
    ("a", "b", "c", "d", "e"),
    (
        Lut("both", ("a", "b"), 0b1000),
        Lut("either", ("a", "b"), 0b1110),
        Mux("chosen", "both", "either", "c"),
        Lut("nobody", ("d",), 0b01),
    ),
    (("y", "chosen"), ("z", "c"), ("one", "1")),
)


def drawn(style: Style, platform: object) -> tuple[Fragment, list[object]]:
    m = Module()
    outputs = draw_network(m, NETWORK, list(Signal(5)), style=style, prefix="x_", platform=platform)
    return Fragment.get(m, None), list(outputs)


def test_inputs_that_decide_no_output_are_unread() -> None:
    assert unread_inputs(NETWORK) == [3, 4]


def test_cells_are_instances_of_the_vendors_and_what_nothing_reads_is_left_out() -> None:
    fragment, outputs = drawn("cells", Emission())
    cells = {name: cell.type for cell, name, _ in fragment.subfragments}
    assert cells == {"x_both_cell": "LUT2", "x_either_cell": "LUT2", "x_chosen_cell": "MUXF7"}
    assert isinstance(outputs[2], Const)
    assert outputs[2].value == 1


def test_equations_are_no_instances() -> None:
    fragment, outputs = drawn("equations", Emission())
    assert fragment.subfragments == []
    assert isinstance(outputs[0], Signal)
    assert outputs[0].name == "x_chosen"


def test_a_simulation_has_signals_only_for_outputs_and_what_is_read_twice() -> None:
    fragment, outputs = drawn("cells", None)
    assert fragment.subfragments == []
    assert len(fragment.statements["comb"]) == 1
    assert isinstance(outputs[0], Signal)
