"""The integer program: latency and registers."""

from tests.wnn2hdl.schedule.conftest import chain
from wnn2hdl.ir import Lut, LutNetwork
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.network import Mux
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.schedule import XC7
from wnn2hdl.schedule.solve import Program
from wnn2hdl.schedule.timing import Paths

LEVEL = XC7.net + XC7.lut


def program(circuit: Circuit) -> Program:
    return Program(Paths(circuit, XC7))


def period(levels: int) -> int:
    return XC7.register + levels * LEVEL


def test_six_levels_take_six_stages_of_one_and_two_of_three() -> None:
    found = program(chain(6))
    assert [found.least_latency(period(levels)) for levels in (1, 2, 3, 4, 6)] == [6, 3, 2, 2, 1]
    assert found.least_latency(period(1) - 1) is None


def test_registers_stand_where_the_fewest_bits_pass() -> None:
    """Six bits become one in LUT `t0`, and that becomes six again: a register between is one bit."""
    names = tuple(f"i{place}" for place in range(6))
    waist = Lut("t0", names, 1)
    wide = tuple(Lut(f"u{place}", ("t0",), 1) for place in range(6))
    network = LutNetwork(names, (waist, *wide), tuple((cell.name, cell.name) for cell in wide))
    bits = Port("bits", 6)
    drivers = {"o": (Slice("waist", 0, 6),)}
    circuit = Circuit("waist", "Waist.", (bits,), (Table("waist", bits.word, network),), drivers)
    stages = program(circuit).fewest_registers(period(2), 3)
    assert stages.places["waist", ("waist", "t0")] == 0
    assert {stages.places["waist", ("waist", cell.name)] for cell in wide} == {2}
    assert stages.period == period(1)


def test_multiplexers_stay_in_the_stage_of_their_luts() -> None:
    bits = Port("bits", 3)
    cells = (Lut("a", ("i0",), 2), Lut("b", ("i1",), 1), Mux("m", "a", "b", "i2"), Lut("c", ("m",), 1))
    table = Table("choice", bits.word, LutNetwork(("i0", "i1", "i2"), cells, (("o", "c"),)))
    found = program(Circuit("mux", "Mux.", (bits,), (table,), {"o": (Slice("choice"),)}))
    assert found.least_latency(period(1)) is None
    stages = found.fewest_registers(period(1) + XC7.mux_data, 2)
    assert [stages.places["mux", ("choice", cell)] for cell in "abmc"] == [0, 0, 0, 1]


def test_all_instances_of_a_circuit_have_its_latency(nine: Circuit) -> None:
    found = program(nine)
    latency = found.least_latency(period(2))
    assert latency is not None
    stages = found.fewest_registers(period(2), latency)
    assert stages.latencies["nine"] == latency
    assert len({stages.places["nine", (f"pixel_{i}", "")] for i in range(9)}) == 1
    assert stages.period <= period(2)
