"""Names of bits."""

from collections.abc import Mapping

import pytest

from wnn2hdl.emit.names import Names
from wnn2hdl.emit.netlist import Cell, Module, Net, count_reads

RGB = tuple(range(2, 10))


def gate(name: str, output: int, kind: str = "$and") -> Cell:
    return Cell(name, kind, {}, {}, {"A": (2,), "B": (3,)}, {"Y": (output,)})


def module(cells: tuple[Cell, ...] = (), nets: Mapping[str, Net] | None = None) -> Module:
    return Module("m", {"rgb": RGB}, {"y": (20, 21)}, nets or {}, cells)


def visible(*bits: int) -> Net:
    return Net(bits, hidden=False, initial=None)


def hidden(*bits: int) -> Net:
    return Net(bits, hidden=True, initial=None)


def test_bits_of_ports_go_by_the_names_of_the_component_the_highest_first() -> None:
    names = Names(module(nets={"R0": visible(2), "R7": visible(9), "R6": visible(8), "$1": hidden(3)}))
    assert list(names.aliases) == ["R7", "R6", "R0"]
    assert names.aliases["R7"] == ("rgb", 7, 1)
    assert names.word((8, 9)) == [("R6", 0, 1), ("R7", 0, 1)]
    assert names.word((3, 4)) == [("rgb", 1, 2)]


def test_what_a_cell_drives_takes_the_name_of_a_port_then_of_a_net_then_one_of_its_own() -> None:
    joined = Cell("$3", "$and", {}, {}, {"A": (2, 3)}, {"Y": (20, 21)})
    nets = {"y": visible(20, 21), "sum": visible(20, 21), "carry": visible(30)}
    names = Names(module((joined, gate("$4", 30), gate("$5", 31)), nets))
    assert names.driven((20, 21)) == [("y", 0, 2)]
    assert names.driven((30,)) == [("carry", 0, 1)]
    assert names.driven((31,)) == [("term_5", 0, 1)]


def test_a_name_that_amaranth_numbered_is_the_last_choice() -> None:
    names = Names(module((gate("$4", 30),), {"a$13": visible(30), "sum": visible(30), "b$14": visible(30)}))
    assert names.driven((30,)) == [("sum", 0, 1)]


def test_of_two_ports_the_first_gives_its_name() -> None:
    both = Module("m", {"rgb": RGB}, {"z": (20,), "y": (20,)}, {"y": visible(20)}, (gate("$4", 20),))
    assert Names(both).driven((20,)) == [("z", 0, 1)]


def test_the_outputs_of_an_instance_are_named_after_its_pins() -> None:
    instance = Cell("pixel_0", "p_pixel", {}, {}, {}, {"class_bits": (30, 31)})
    names = Names(module((instance,)))
    assert names.driven((30, 31)) == [("pixel_0_class_bits", 0, 2)]
    assert names.instances == {instance: "pixel_0"}


@pytest.mark.parametrize(
    ("wanted", "given"),
    [
        ("module", "module_1"),
        ("Signal", "Signal_1"),
        ("rgb", "rgb_1"),
        ("a.b$2", "a_b_2"),
        ("unit", "unit_1"),
        ("3rd", "n3rd"),
    ],
)
def test_names_that_verilog_cannot_have_or_has_already_are_changed(wanted: str, given: str) -> None:
    instance = Cell("unit", "p_unit", {}, {}, {}, {})
    names = Names(module((instance, gate("$4", 30)), {wanted: visible(30)}))
    assert names.driven((30,)) == [(given, 0, 1)]
    assert names.widths[given] == 1


def test_no_two_things_have_one_name() -> None:
    cells = (Cell("always", "p_unit", {}, {}, {}, {"y": (30,)}), gate("$4", 31))
    names = Names(module(cells, {"always_1_y": visible(31)}))
    assert names.instances[cells[0]] == "always_1"
    assert names.driven((30,)) != names.driven((31,))


def test_a_word_of_a_joined_output_is_that_port() -> None:
    names = Names(module((gate("$4", 20), gate("$5", 21))))
    assert names.word((20, 21)) == [("term_4", 0, 1), ("term_5", 0, 1)]
    names.joined_output("y")
    assert names.word((20, 21)) == [("y", 0, 2)]
    assert names.word((20,)) == [("term_4", 0, 1)]


def test_constants_are_words_and_undefined_bits_are_refused() -> None:
    names = Names(module())
    assert names.word(("1", "0", 2)) == [("", 1, 2), ("rgb", 0, 1)]
    with pytest.raises(NotImplementedError, match="undefined bit"):
        names.word(("x",))


def test_reads_of_cells_and_of_ports_are_counted() -> None:
    reads = count_reads(module((gate("$4", 20), gate("$5", 21))))
    assert (reads[2], reads[3], reads[20], reads[9]) == (2, 2, 1, 0)
