"""Modules as Yosys describes them."""

import pytest
from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Module
from amaranth.hdl import Signal as Net

from wnn2hdl.emit.netlist import Cell, read_modules
from wnn2hdl.errors import ToolError


def text(m: Module, name: str, **ports: Net) -> str:
    """The RTLIL of a module with these ports."""
    rendered: str = rtlil.convert(
        m,
        name=name,
        ports=list(ports.values()),
        emit_src=False,
        missing_domain=lambda domain: ClockDomain(domain, reset_less=True),
    )
    return rendered


def counter() -> str:
    m, step, count = Module(), Net(4, name="step"), Net(4, name="count", init=9)
    m.d.sync += count.eq(count + step)
    return text(m, "counter", step=step, count=count)


def test_ports_stand_in_the_order_wanted_and_the_clock_before_them() -> None:
    a, b, y = Net(2, name="a"), Net(3, name="b"), Net(3, name="y")
    m = Module()
    m.d.comb += y.eq(a & b)
    module = read_modules([text(m, "gate", y=y, b=b, a=a)], {"gate": ["b", "y", "a"]})["gate"]
    assert list(module.inputs) == ["b", "a"]
    assert [len(bits) for bits in module.inputs.values()] == [3, 2]
    assert list(read_modules([counter()], {"counter": ["step", "count"]})["counter"].inputs) == [
        "clk",
        "step",
    ]


def test_cells_have_their_pins_by_direction_and_their_parameters_as_numbers() -> None:
    module = read_modules([counter()], {"counter": ["step", "count"]})["counter"]
    adder, register = sorted(module.cells, key=lambda cell: cell.kind)
    assert (adder.kind, register.kind) == ("$add", "$dff")
    assert (list(adder.inputs), list(adder.outputs)) == (["A", "B"], ["Y"])
    assert register.outputs == {"Q": module.outputs["count"]}
    assert register.number("WIDTH") == 4
    assert not register.is_instance


def test_start_values_are_those_of_the_nets() -> None:
    module = read_modules([counter()], {"counter": ["step", "count"]})["counter"]
    assert (module.nets["count"].initial, module.nets["step"].initial) == (9, None)
    assert not module.nets["count"].hidden


def test_cells_are_in_the_order_of_the_numbers_in_their_names() -> None:
    m, bits, y = Module(), Net(12, name="bits"), Net(11, name="y")
    m.d.comb += [y[i].eq(bits[i] & bits[i + 1]) for i in range(11)]
    module = read_modules([text(m, "gates", bits=bits, y=y)], {"gates": ["bits", "y"]})["gates"]

    def first_input(cell: Cell) -> object:
        return cell.inputs["A"][0]

    assert [first_input(cell) for cell in module.cells] == list(module.inputs["bits"][:11])


def test_what_is_no_rtlil_is_an_error_of_the_tool() -> None:
    with pytest.raises(ToolError):
        read_modules(["module \\broken\n"], {})
