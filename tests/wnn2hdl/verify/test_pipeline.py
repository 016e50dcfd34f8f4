"""Pipelines: equal to the model their latency later, whatever happened before and after."""

from dataclasses import replace
from itertools import pairwise
from types import ModuleType
from typing import Any

import pytest

from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.verify.equivalence import Circuit, evaluate, find_differences
from wnn2hdl.verify.proof import prove

PORTS = "input clk, input [3:0] a, input [3:0] b, output [4:0] s"


def pipeline(body: str, latency: int, ports: str = PORTS) -> Circuit:
    return Circuit((f"module pipe({ports});\n{body}\nendmodule\n",), "pipe", latency)


SUM = Circuit(
    ("module add(input [3:0] a, input [3:0] b, output [4:0] s); assign s = a + b; endmodule\n",), "add"
)

TWO_STAGES = """
  reg [3:0] a1, b1; reg [4:0] s2;
  always @(posedge clk) begin a1 <= a; b1 <= b; s2 <= a1 + b1; end
  assign s = s2;
"""


def is_equal(circuit: Circuit) -> bool:
    return find_differences([(circuit, SUM)], timeout=60) == [None]


def test_a_pipeline_is_its_function_so_many_cycles_later() -> None:
    assert is_equal(pipeline(TWO_STAGES, 2))
    for latency in (1, 3):
        assert not is_equal(pipeline(TWO_STAGES, latency))


def test_initial_values_do_not_matter() -> None:
    assert is_equal(pipeline(TWO_STAGES.replace("reg [4:0] s2", "reg [4:0] s2 = 21"), 2))


@pytest.mark.parametrize(
    "change",
    [
        ("s2 <= a1 + b1", "s2 <= a1 + b"),
        ("s2 <= a1 + b1", "s2 <= {a1[3], a1[2:0]} + {b1[3:1], b[0]}"),
        ("b1 <= b;", "b1 <= b0;"),
        ("s2 <= a1 + b1", "s2 <= a1 - b1"),
        ("s2 <= a1 + b1", "if (a1[0]) s2 <= a1 + b1"),
        ("s2 <= a1 + b1", "s2 <= s2 ^ s2 | a1 + b1 | (s2 & {5{a1 == 15}})"),
    ],
    ids=["a register missing", "of one bit", "one too many", "another function", "an enable", "feedback"],
)
def test_a_wrong_pipeline_is_refuted(change: tuple[str, str]) -> None:
    earlier = "  reg [3:0] b0; always @(posedge clk) b0 <= b;\n"
    assert not is_equal(pipeline(earlier + TWO_STAGES.replace(*change), 2))


def test_an_accumulator_is_refuted() -> None:
    body = "  reg [4:0] t; always @(posedge clk) t <= t + a + b;\n  assign s = t;"
    assert not is_equal(pipeline(body, 1))


@pytest.mark.parametrize(
    "body",
    [
        TWO_STAGES.replace("posedge", "negedge"),
        TWO_STAGES.replace("posedge clk", "posedge a[0]"),
        TWO_STAGES.replace("posedge clk", "posedge clk or posedge b[0]").replace(
            "begin", "if (b[0]) s2 <= 0; else begin"
        ),
        "  reg [4:0] t; always @* if (clk) t = a + b;\n  assign s = t;",
        "  wire gated = clk & a[0]; reg [4:0] t; always @(posedge gated) t <= a + b;\n  assign s = t;",
    ],
    ids=["falling edge", "another clock", "asynchronous reset", "latch", "gated clock"],
)
def test_other_clocks_and_latches_are_refused(body: str) -> None:
    with pytest.raises(Wnn2hdlError):
        find_differences([(pipeline(body, 2), SUM)], timeout=60)


def test_a_difference_is_in_the_inputs_that_the_outputs_belong_to() -> None:
    wrong = pipeline(TWO_STAGES.replace("a1 + b1", "a1 + b1 + (a1 == 11 & b1 == 6)"), 2)
    assert find_differences([(SUM, wrong)], timeout=60) == [{"a": 11, "b": 6}]
    widths = {"a": 4, "b": 4}
    assert evaluate(wrong, {"a": 11, "b": 6}, widths, ["s"]) == {"s": 18}


def test_two_pipelines_are_compared_and_each_has_its_own_past() -> None:
    right, other = pipeline(TWO_STAGES, 2), pipeline(TWO_STAGES.replace("a1 + b1", "b1 + a1"), 2)
    held = pipeline(TWO_STAGES.replace("s2 <= a1", "if (a1[0]) s2 <= a1"), 2)
    assert find_differences([(right, other)], timeout=60) == [None]
    # Equal texts: only what their registers held before can differ.
    assert find_differences([(held, held)], timeout=60) != [None]


@pytest.mark.slow
def test_a_mapped_netlist_of_flip_flops_and_shift_registers_is_compared(circuits: ModuleType) -> None:
    body = TWO_STAGES.replace("assign s = s2;", "reg [4:0] s3, s4, s5; assign s = s5;").replace(
        "s2 <= a1 + b1;", "s2 <= a1 + b1; s3 <= s2; s4 <= s3; s5 <= s4;"
    )
    source = pipeline(body, 5)
    netlist = circuits.mapped(source)
    assert "FDRE" in netlist.sources[0]
    assert "SRL16E" in netlist.sources[0]
    wrong = Circuit((netlist.sources[0].replace(".A0(1'h1)", ".A0(1'h0)", 1),), netlist.top, 5)
    assert wrong != netlist
    same, different = find_differences([(source, netlist), (source, wrong)], timeout=60)
    assert same is None
    assert different is not None
    assert is_equal(netlist)


def registered(circuits: ModuleType, block: Any, part: str, inner: str, latency: int) -> Circuit:
    """A circuit behind this many registers at each of its inputs."""
    claim = circuits.specification(block).claims[part]
    ports = [f"input [{width - 1}:0] {port}" for port, width in claim.inputs.items()]
    ports += [f"output [{width - 1}:0] {port}" for port, width in claim.outputs.items()]
    lines = [f"module piped(input clk, {', '.join(ports)});"]
    for port, width in claim.inputs.items():
        lines.append(f"  reg [{width - 1}:0] {', '.join(f'{port}_{i + 1}' for i in range(latency))};")
        stages = [port, *(f"{port}_{i + 1}" for i in range(latency))]
        lines += [f"  always @(posedge clk) {later} <= {now};" for now, later in pairwise(stages)]
    pins = [f".{port}({port}_{latency})" for port in claim.inputs] + [f".{x}({x})" for x in claim.outputs]
    lines.append(f"  {inner} inner ({', '.join(pins)});\nendmodule\n")
    return Circuit((circuits.emitted(block, part), "\n".join(lines)), "piped", latency)


@pytest.mark.parametrize("care", [1.0, 0.5])
def test_a_pipeline_is_proved_equal_to_the_model_where_that_matters(
    circuits: ModuleType, care: float
) -> None:
    for drawn, part, inner in (
        (circuits.random_block(7, care=care), "pixel", "pixel"),
        (circuits.random_block(7, care=care), "edge", "edge_filter"),
        (circuits.random_neighbours(1, care=care), "neighbourhood", "neighbourhood"),
    ):
        piped = registered(circuits, drawn, part, inner, 2)
        specification = circuits.specification(drawn)
        assert prove(specification, {part: piped})[part].status == "proved"
        early = replace(piped, latency=1)
        found = prove(specification, {part: early})[part].counterexample
        assert found is not None
        if found.actual == found.expected:
            assert str(found).endswith("the outputs depend on registers or inputs of another time")
        if care < 1.0:
            assert prove(circuits.exact(drawn), {part: piped})[part].status == "refuted"
