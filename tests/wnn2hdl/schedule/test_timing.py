"""Paths through a circuit and their lengths."""

from tests.wnn2hdl.schedule.conftest import chain
from wnn2hdl.ir import Lut, LutNetwork
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.network import Mux
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.schedule import XC7
from wnn2hdl.schedule.timing import Paths

LEVEL = XC7.net + XC7.lut


def test_every_lut_adds_a_level() -> None:
    assert Paths(chain(4), XC7).periods() == [XC7.register + levels * LEVEL for levels in range(1, 5)]


def test_paths_go_through_instances(nine: Circuit) -> None:
    paths = Paths(nine, XC7)
    assert paths.uses == {"chain": 9, "nine": 1}
    depth = max(paths.periods())
    assert (depth - XC7.register) % LEVEL == 0
    assert depth > XC7.register + 4 * LEVEL
    # Nine bits and four of their sum leave the circuit.
    assert len(paths.ends) == 13


def test_the_cells_of_a_path_that_is_too_long_are_apart() -> None:
    two = XC7.register + 2 * LEVEL
    pairs = [
        (first.places[0][1][1], later.places[0][1][1]) for first, later in Paths(chain(5), XC7).too_far(two)
    ]
    assert pairs == [("t0", "t2"), ("t1", "t3"), ("t2", "t4")]
    assert list(Paths(chain(5), XC7).too_far(XC7.register + 5 * LEVEL)) == []


def test_a_multiplexer_is_beside_its_luts() -> None:
    bits = Port("bits", 3)
    cells = (Lut("a", ("i0",), 2), Lut("b", ("i1",), 1), Mux("m", "a", "b", "i2"))
    table = Table("choice", bits.word, LutNetwork(("i0", "i1", "i2"), cells, (("o", "m"),)))
    paths = Paths(Circuit("mux", "Mux.", (bits,), (table,), {"o": (Slice("choice"),)}), XC7)
    through_lut = XC7.register + LEVEL + XC7.mux_data
    assert max(paths.periods()) == through_lut


def test_the_slowest_stage_is_that_of_the_longest_path_inside_one() -> None:
    paths = Paths(chain(5), XC7)
    keys = [cell.places[0] for cell in paths.cells]
    stages = dict(zip(keys, (0, 0, 1, 1, 1), strict=True))
    assert paths.slowest(stages) == XC7.register + 3 * LEVEL
