# amaranth: UnusedElaboratable=no
"""Names for the reader of the Verilog, none for the simulator."""

from amaranth.hdl import Module, Signal

from hdl_templates.hierarchy import Emission
from hdl_templates.ports import named, tie_off


def test_values_get_names_only_where_verilog_is_written() -> None:
    bit = Signal(4)[2]
    assert named(Module(), "R7", bit, None) is bit
    emitted = named(Module(), "R7", bit, Emission())
    assert isinstance(emitted, Signal)
    assert emitted.name == "R7"


def test_nothing_is_tied_off_where_all_is_read() -> None:
    m = Module()
    tie_off(m, [], Emission())
    assert not m.elaborate(None).statements
