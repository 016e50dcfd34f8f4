# amaranth: UnusedElaboratable=no
"""From circuits to hardware that computes the same."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Fragment
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates.hierarchy import Emission
from tests.random_circuits import KINDS, circuits, networks, random_inputs
from wnn2hdl.elaborate import component
from wnn2hdl.ir import BitSelect, Lut, LutNetwork, Style, TruthTable, codes_to_bits
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower import deforestation
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.simulation import simulate

STYLES: tuple[Style, ...] = ("cells", "equations")


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def check(circuit: Circuit, style: Style = "cells", count: int = 100) -> None:
    part = component(circuit, style=style)
    inputs = random_inputs(circuit, count)
    expected = circuit.evaluate(inputs)
    simulate(part, inputs, expected)


@settings(max_examples=60, deadline=None)
@given(circuits(), st.sampled_from(STYLES))
def test_any_circuit_simulates_as_it_evaluates(circuit: Circuit, style: Style) -> None:
    check(circuit, style)


@pytest.mark.parametrize("kind", KINDS)
def test_a_circuit_of_each_kind_of_node_simulates_as_it_evaluates(kind: str) -> None:
    @settings(max_examples=12, deadline=None, database=None)
    @given(circuits((kind,)))
    def run(circuit: Circuit) -> None:
        check(circuit)

    run()


@settings(max_examples=10, deadline=None)
@given(circuits(("table", "sum", "instance"), mapped=False))
def test_minimised_tables_simulate_as_the_truth_tables_evaluate(circuit: Circuit) -> None:
    mapped = minimise(circuit, 0, silent).circuit
    inputs = random_inputs(mapped, 100)
    answers = mapped.evaluate(inputs)
    if all(table.function.care.all() for table in circuit.tables().values()):  # type: ignore[union-attr]
        expected = circuit.evaluate(inputs)
        assert all((answers[port] == expected[port]).all() for port in answers)
    check(mapped)


def test_words_of_any_width_are_added_and_matched() -> None:
    for width in (1, 2, 37, 154):
        a, b = Port("a", width), Port("b", width)
        nodes = (Sum("ones", a.word), Match("same", a.word, b.word))
        drivers = {node.name: (Slice(node.name, 0, width.bit_length()),) for node in nodes}
        circuit = Circuit("wide", "Wide.", (a, b), nodes, {f"{port}_bits": w for port, w in drivers.items()})
        check(circuit)


@pytest.mark.parametrize("tie", ["first", "last"])
def test_equal_words_have_the_winner_that_the_rule_says(tie: Any) -> None:
    ports = tuple(Port(f"word{i}", 2) for i in range(5))
    argmax = ArgMax("winner", tuple(port.word for port in ports), tie)
    circuit = Circuit("ties", "Ties.", ports, (argmax,), {"index": (Slice("winner", 0, 3),)})
    inputs = {port.name: codes_to_bits([3, 1], 2) for port in ports}
    assert (circuit.evaluate(inputs)["index"] @ [1, 2, 4]).tolist() == [0 if tie == "first" else 4] * 2
    simulate(component(circuit, style="cells"), inputs, circuit.evaluate(inputs))


@pytest.mark.parametrize("at_least", [-1, 0, 1, 7, 8, 9])
def test_a_threshold_out_of_reach_is_a_constant(at_least: int) -> None:
    level = Port("level", 3)
    node = Threshold("reached", level.word, at_least)
    circuit = Circuit("level", "Level.", (level,), (node,), {"high": (Slice("reached"),)})
    inputs = {"level": codes_to_bits(np.arange(8), 3)}
    expected = np.arange(8) >= at_least
    assert (circuit.evaluate(inputs)["high"][:, 0] == expected).all()
    assert node.constant == (expected[0] if len(set(expected.tolist())) == 1 else None)
    simulate(component(circuit, style="cells"), inputs, circuit.evaluate(inputs))


def test_registers_delay_by_their_cycles_and_start_at_zero() -> None:
    port = Port("data", 4)
    register = Register("late", port.word, 3)
    circuit = Circuit("delay", "Delay.", (port,), (register,), {"later": (Slice("late", 0, 4),)})
    part = component(circuit, style="cells")
    assert (part.clocked, part.latency, part.summary) == (True, 3, "Delay. Latency 3 cycles.")
    data = codes_to_bits(np.arange(1, 11), 4)
    # The first three answers are the registers' start values, of samples that were never applied.
    early = np.concatenate([np.zeros((3, 4), dtype=np.bool_), data[:-3]])
    part.latency = 0
    simulate(part, {"data": data}, {"later": early})


ENCODER = BitSelect(("R7", "G0", "B5", "R6", "B0"))
OUTPUTS = ("class_bit0", "class_bit1")


def pixel(encoder: BitSelect, function: LutNetwork) -> Circuit:
    code = tuple(Slice("rgb", position) for position in encoder.pixel_positions)
    table = Table("decision", code, function)
    drivers = {"class_bits": (Slice("decision", 0, len(function.outputs)),)}
    return Circuit("pixel", "Pixel.", (Port("rgb", 24),), (table,), drivers)


def edge(function: LutNetwork) -> Circuit:
    bits = Port("bits", 9)
    table = Table("filter", bits.word, function)
    return Circuit("edge", "Edge.", (bits,), (table,), {"edge_bit": (Slice("filter"),)})


@settings(max_examples=25, deadline=None)
@given(networks(ENCODER.names, OUTPUTS), st.sampled_from(STYLES))
def test_pixel_logic_golden_model_and_simulation_agree(network: LutNetwork, style: Style) -> None:
    circuit = pixel(ENCODER, network)
    # For each code a pixel that has it, the other bits at random.
    codes = np.arange(1 << ENCODER.width)
    rgb = np.random.default_rng(0).random((len(codes), 24)) < 0.5
    rgb[:, ENCODER.pixel_positions] = codes_to_bits(codes, ENCODER.width)
    expected = {"class_bits": network.evaluate(codes)}
    assert (circuit.evaluate({"rgb": rgb})["class_bits"] == expected["class_bits"]).all()
    simulate(component(circuit, style=style), {"rgb": rgb}, expected)


WINDOW_NAMES = tuple(f"bit{i}" for i in range(9))


@settings(max_examples=10, deadline=None)
@given(networks(WINDOW_NAMES, ("edge_bit",)))
def test_an_edge_filter_is_right_for_every_window(network: LutNetwork) -> None:
    windows = codes_to_bits(np.arange(512), 9)
    part = component(edge(network), style="cells")
    simulate(part, {"bits": windows}, {"edge_bit": network.evaluate(np.arange(512))})


def mapped(inputs: tuple[str, ...], outputs: tuple[str, ...], rule: Callable[[Any], Any]) -> LutNetwork:
    """The LUT network of a rule over the columns of the table's inputs."""
    columns = codes_to_bits(np.arange(1 << len(inputs)), len(inputs)).T
    values = np.stack(rule(columns), axis=1)
    word = Port("word", len(inputs)).word
    circuit = Circuit(
        "one",
        "One table.",
        (Port("word", len(inputs)),),
        (Table("rule", word, TruthTable.exact(inputs, outputs, values)),),
        {"y": (Slice("rule", 0, len(outputs)),)},
    )
    (table,) = minimise(circuit, 0, silent).circuit.tables().values()
    assert isinstance(table.function, LutNetwork)
    return table.function


CENTRE_WITHOUT_TOP = edge(mapped(WINDOW_NAMES, ("edge_bit",), lambda bit: [bit[4] & ~bit[1]]))


@pytest.mark.parametrize("classes", [2, 3])
def test_a_block_puts_the_parts_together(classes: int) -> None:
    names = ("R7", "G7")
    if classes == 2:
        network = mapped(names, ("class_bit0",), lambda bit: [bit[0] & ~bit[1]])
    else:
        network = mapped(names, OUTPUTS, lambda bit: [bit[0] & ~bit[1], bit[0] & bit[1]])
    block = deforestation.block(pixel(BitSelect(names), network), CENTRE_WITHOUT_TOP)
    circuit = minimise(deforestation.block_match(block, deforestation.match()), 0, silent).circuit
    rng = np.random.default_rng(1)
    window, reference = rng.random((2000, 216)) < 0.5, rng.random((2000, 9)) < 0.5
    red, green = window[:, 23::24], window[:, 15::24]
    bits = red & ~green if classes == 2 else red
    expected = {
        "bits": bits,
        "edge_bit": (bits[:, 4] & ~bits[:, 1])[:, np.newaxis],
        "match_count": codes_to_bits((bits == reference).sum(axis=1), 4),
    }
    inputs = {"window": window, "reference_bits": reference}
    evaluated = circuit.evaluate(inputs)
    assert all((evaluated[port] == expected[port]).all() for port in expected)
    assert simulate(component(circuit, style="cells"), inputs, expected).vectors == 2000


@pytest.mark.slow
def test_the_matcher_is_right_for_every_pair() -> None:
    reference, bits = np.divmod(np.arange(1 << 18), 1 << 9)
    equal = 9 - np.bitwise_count(bits ^ reference)
    inputs = {"bits": codes_to_bits(bits, 9), "reference_bits": codes_to_bits(reference, 9)}
    part = component(deforestation.match(), style="cells")
    assert simulate(part, inputs, {"match_count": codes_to_bits(equal, 4)}).vectors == 1 << 18


def test_a_table_that_is_not_mapped_is_refused() -> None:
    table = TruthTable.exact(("a",), ("y",), np.array([[True], [False]]))
    circuit = Circuit(
        "raw",
        "Raw.",
        (Port("a", 1),),
        (Table("inverter", Port("a", 1).word, table),),
        {"y": (Slice("inverter"),)},
    )
    with pytest.raises(ValueError, match="inverter is not mapped to LUTs"):
        Fragment.get(component(circuit, style="cells"), None)


def test_words_of_different_latencies_are_refused() -> None:
    port = Port("data", 2)
    word = (Slice("data", 0), Slice("late"))
    circuit = Circuit("skewed", "S.", (port,), (Register("late", (Slice("data"),)),), {"both": word})
    with pytest.raises(ValueError, match=r"an output in skewed joins words of the latencies \[0, 1\]"):
        component(circuit, style="cells")


def test_parts_of_one_circuit_are_one_module() -> None:
    inner = deforestation.match()
    ports = tuple(Port(f"word{i}", 9) for i in range(3))
    instances = tuple(
        Instance(f"matcher{i}", inner, {"bits": ports[i].word, "reference_bits": ports[i + 1].word})
        for i in range(2)
    )
    drivers = {f"count{i}": (Slice(f"matcher{i}.match_count", 0, 4),) for i in range(2)}
    emission = Emission("p_")
    Fragment.get(component(Circuit("two", "T.", ports, instances, drivers), style="cells"), emission)
    assert list(emission.parts) == ["p_match_3", "p_compress_3_3_to_4", "p_match"]


def test_a_simulator_takes_tables_that_read_tables() -> None:
    """Expressions in expressions would be of a size that is exponential in their number."""
    names = ("a", "b")
    xor = LutNetwork(names, (Lut("t0", names, 0b0110),), (("o", "t0"),))
    bits = [Slice("x", 0), Slice("x", 1)]
    nodes = []
    for place in range(60):
        nodes.append(Table(f"t{place}", (bits[-2], bits[-1]), xor))
        bits.append(Slice(f"t{place}"))
    circuit = Circuit("chain", "A chain.", (Port("x", 2),), tuple(nodes), {"o": (bits[-1],)})
    inputs = {"x": codes_to_bits(np.arange(4), 2)}
    simulate(component(circuit, style="cells"), inputs, circuit.evaluate(inputs))
