"""The drawing shows the network: every cell, every connection, nothing else."""

import re
from itertools import combinations

import numpy as np
import pytest

from wnn2hdl.ir import Lut, LutNetwork, TruthTable
from wnn2hdl.minimise import map_luts
from wnn2hdl.report.schematic import Node, draw


@pytest.fixture(scope="module")
def mapped() -> LutNetwork:
    """A random function of nine inputs and two outputs, mapped."""
    values = np.random.default_rng(1).random((512, 2)) < 0.4
    names = tuple(f"x{i}" for i in range(9))
    return map_luts(TruthTable.exact(names, ("f", "g"), values), effort=0).network


def test_every_cell_input_and_output_has_a_box(mapped: LutNetwork) -> None:
    drawing = draw(mapped)
    kinds = {kind: sum(node.kind == kind for node in drawing.nodes) for kind in ("lut", "mux", "output")}
    assert kinds == {"lut": len(mapped.luts), "mux": len(mapped.muxes), "output": 2}
    inputs = {node.name for node in drawing.nodes if node.kind == "input"}
    assert inputs | set(drawing.unread) == set(mapped.inputs)


def test_every_pin_has_a_wire_from_its_signal(mapped: LutNetwork) -> None:
    wires = sorted((wire.source, wire.target) for wire in draw(mapped).wires)
    pins = {(name, lut.name) for lut in mapped.luts for name in lut.inputs}
    pins |= {(name, mux.name) for mux in mapped.muxes for name in (mux.low, mux.high, mux.select)}
    pins |= {(signal, name) for name, signal in mapped.outputs}
    assert wires == sorted(pins)


def test_wires_go_from_the_right_of_a_box_to_the_left_of_another(mapped: LutNetwork) -> None:
    drawing = draw(mapped)
    outputs = {node.name: node for node in drawing.nodes if node.kind == "output"}
    cells = {node.name: node for node in drawing.nodes if node.kind != "output"}
    for wire in drawing.wires:
        numbers = [float(number) for number in re.findall(r"[\d.]+", wire.path)]
        start, end = cells[wire.source], outputs.get(wire.target) or cells[wire.target]
        assert numbers[:2] == pytest.approx([start.x + start.width, start.y], abs=0.1)
        assert numbers[-2] == pytest.approx(end.x, abs=0.1)
        assert abs(numbers[-1] - end.y) <= end.height / 2
        assert start.x + start.width < end.x


def test_boxes_do_not_overlap_and_lie_in_the_drawing(mapped: LutNetwork) -> None:
    drawing = draw(mapped)

    def apart(a: Node, b: Node) -> bool:
        return a.x + a.width <= b.x or b.x + b.width <= a.x or abs(a.y - b.y) >= (a.height + b.height) / 2

    assert all(apart(a, b) for a, b in combinations(drawing.nodes, 2))
    for node in drawing.nodes:
        assert 0 <= node.x <= node.x + node.width <= drawing.width
        assert 0 <= node.y - node.height / 2 <= node.y + node.height / 2 <= drawing.height


def test_the_longest_path_has_as_many_luts_as_the_network_is_deep(mapped: LutNetwork) -> None:
    drawing = draw(mapped)
    luts = {lut.name for lut in mapped.luts}
    assert sum(name in luts for name in drawing.path) == mapped.depth
    assert drawing.path[0] in mapped.inputs
    assert drawing.path[-1] in ("f", "g")
    assert sum(wire.critical for wire in drawing.wires) == len(drawing.path) - 1


def test_outputs_may_be_constants_inputs_or_have_the_name_of_a_signal() -> None:
    lut = Lut("t0", ("a", "a"), 0b1001)
    drawing = draw(LutNetwork(("a", "b"), (lut,), (("one", "1"), ("through", "a"), ("t0", "t0"))))
    assert {(wire.source, wire.target) for wire in drawing.wires} == {
        ("1", "one"),
        ("a", "through"),
        ("a", "t0"),
        ("t0", "t0"),
    }
    assert drawing.unread == ("b",)


def test_the_same_network_gives_the_same_drawing(mapped: LutNetwork) -> None:
    assert draw(mapped) == draw(mapped)
