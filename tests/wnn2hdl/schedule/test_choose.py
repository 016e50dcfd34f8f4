"""Pipelines by the number of their stages and by the clock."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.random_circuits import circuits
from tests.wnn2hdl.schedule.conftest import chain
from wnn2hdl.errors import InputError
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.wires import Slice, Word
from wnn2hdl.schedule import XC7, for_clock, for_instances, for_stages, pipelined
from wnn2hdl.schedule.stages import Stages

COMBINATIONAL = ("table", "threshold", "sum", "match", "argmax", "instance")
LEVEL = XC7.net + XC7.lut


def test_stages_are_balanced() -> None:
    assert [for_stages(chain(7), n).period for n in (1, 2, 3, 4, 7)] == [
        XC7.register + levels * LEVEL for levels in (7, 4, 3, 2, 1)
    ]


def test_more_stages_than_levels_are_as_fast_as_one_level_is() -> None:
    stages = for_stages(chain(2), 5)
    assert (stages.latencies["chain"], stages.period) == (5, XC7.register + LEVEL)


@pytest.mark.parametrize(("megahertz", "latency"), [(100, 1), (400, 4), (318, 3), (800, 7)])
def test_a_clock_takes_as_few_stages_as_it_allows(megahertz: float, latency: int) -> None:
    stages = for_clock(chain(7), megahertz)
    assert stages.latencies["chain"] == latency
    assert stages.period <= 1e6 / megahertz
    if latency > 1:
        assert for_stages(chain(7), latency - 1).period > 1e6 / megahertz


def test_a_clock_that_is_too_fast_for_one_lut_is_refused() -> None:
    with pytest.raises(InputError) as error:
        for_clock(chain(3), 900)
    assert error.value.line() == (
        "no number of stages meets the clock: 900 MHz, 1111 ps; "
        "a stage takes at least 1245 ps, so give at most --clock 803"
    )
    assert for_clock(chain(3), 803).latencies["chain"] == 3


def test_clocks_of_any_speed_have_an_answer() -> None:
    with pytest.raises(InputError, match="no number of stages meets the clock"):
        for_clock(chain(3), 1e9)
    assert for_clock(chain(3), 5e-324).latencies["chain"] == 1


@settings(max_examples=25, deadline=None)
@given(circuits(COMBINATIONAL), st.integers(1, 4))
def test_the_clock_that_some_stages_allow_is_met_by_no_more(circuit: Circuit, stages: int) -> None:
    period = for_stages(circuit, stages).period
    found = for_clock(circuit, 1e6 / period - 1e-3)
    assert found.latencies[circuit.name] <= stages
    assert found.period <= period


def side_by_side(*circuits: Circuit) -> Circuit:
    """Instances with ports of their own."""
    nodes, inputs = [], []
    drivers: dict[str, Word] = {}
    for number, circuit in enumerate(circuits):
        ports = [replace(port, name=f"{port.name}_{number}") for port in circuit.inputs]
        words = {port.name: outer.word for port, outer in zip(circuit.inputs, ports, strict=True)}
        node = Instance(f"part_{number}", replace(circuit, name=f"chain_{number}"), words)
        nodes.append(node)
        inputs += ports
        drivers |= {f"out_{number}": tuple(Slice(net, 0, width) for net, width in node.drives.items())}
    return Circuit("all", "Chains.", tuple(inputs), tuple(nodes), drivers)


def latencies(circuit: Circuit, stages: Stages | None) -> list[int]:
    assert stages is not None
    return [node.latency for node in pipelined(circuit, stages).nodes]


def test_circuits_side_by_side_get_registers_of_their_own_where_they_need_any() -> None:
    circuit = side_by_side(chain(7), chain(2))
    # What has no registers needs room for one LUT more.
    assert latencies(circuit, for_instances(circuit, megahertz=1e6 / (XC7.register + 3 * LEVEL))) == [3, 0]
    assert latencies(circuit, for_instances(circuit, megahertz=1e6 / (XC7.register + 2 * LEVEL))) == [4, 1]
    assert latencies(circuit, for_instances(circuit, stages=2)) == [2, 0]
    assert for_instances(circuit, megahertz=10) is None
    assert for_instances(circuit) is None
