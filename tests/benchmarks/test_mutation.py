"""The proof catches every mutant that matters, and only those."""

import numpy as np
import pytest

from benchmarks import mutation
from benchmarks.mutation import Mutant, check_proof, make_mutants
from wnn2hdl.edges import boundary
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.ir.care import CareSet, Codes
from wnn2hdl.lower.targets import TARGETS, Ingredients
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.specify import specify

TEXT = """\
module m(input [2:0] a, output b);
  wire c;
  assign c = a[0] & ~a[1];
  assign b = c | a[2];
endmodule
"""


def test_faults_are_inversions_constants_and_exchanges() -> None:
    mutants = make_mutants(TEXT, 14, 0)
    expressions = {mutant.verilog.splitlines()[2] for mutant in mutants}
    assert "  assign c = ~a[0] & ~a[1];" in expressions
    assert "  assign c = a[0] & a[1];" in expressions
    assert "  assign c = a[0] & 1'h1;" in expressions
    assert "  assign c = a[1] & ~a[0];" in expressions
    assert Mutant("line 4: c became 1'h0", TEXT.replace("c | a[2]", "1'h0 | a[2]")) in mutants
    assert TEXT not in {mutant.verilog for mutant in mutants}


def test_every_bit_of_a_lut_is_flipped_and_its_pins_are_exchanged() -> None:
    text = "LUT2 #(.INIT(4'h8)) g (.O(y), .I0(p), .I1(q));\n"
    texts = {mutant.verilog for mutant in make_mutants(text, 11, 0)}
    assert {text.replace("h8", f"h{8 ^ 1 << bit:x}") for bit in range(4)} <= texts
    assert text.replace(".I0(p)", ".I0(~p)") in texts
    assert text.replace(".I0(p), .I1(q)", ".I0(q), .I1(p)") in texts


HIERARCHY = """\
module half (
    input  wire [1:0] a,
    input  wire [1:0] b,
    output wire y
);
endmodule

module other (
    input  wire [1:0] a,
    input  wire [1:0] b,
    output wire y
);
endmodule

module top (
    input  wire [3:0] x,
    output wire z
);
    wire first_y;
    half first (.a(x[1:0]), .b(x[3:2]), .y(first_y));
    wire second_y;
    half second (.a(x[2:1]), .b({x[0], x[3]}), .y(second_y));
    half third (.a({first_y, second_y}), .b(x[1:0]), .y(z));
endmodule
"""


def test_faults_of_the_hierarchy_tie_off_exchange_and_replace_instances() -> None:
    faults = {mutant.fault.partition(": ")[2]: mutant.verilog for mutant in make_mutants(HIERARCHY, 90, 0)}
    assert ".a({2{1'b0}}), .b(x[3:2])" in faults["a of first tied to 0"]
    assert ".a({2{1'b1}}), .b(x[3:2])" in faults["a of first tied to 1"]
    assert ".a({x[0], x[3]}), .b(x[2:1])" in faults["a and b of second exchanged"]
    assert "other first (.a(x[1:0])" in faults["first became a other"]
    exchanged = faults["first and second exchanged"]
    assert "half first (.a(x[2:1]), .b({x[0], x[3]}), .y(first_y))" in exchanged
    assert "half second (.a(x[1:0]), .b(x[3:2]), .y(second_y))" in exchanged
    # The third reads what the first drives: exchanged, they would make a loop.
    assert "first and third exchanged" not in faults


def test_a_small_circuit_is_broken_twice_when_its_single_faults_are_used_up() -> None:
    mutants = make_mutants(TEXT, 200, 0)
    assert len({mutant.verilog for mutant in mutants}) == 200
    assert any("; " in mutant.fault for mutant in mutants)
    assert make_mutants("// nothing here\n", 5, 0) == []


def test_the_choice_is_the_same_for_the_same_seed() -> None:
    assert make_mutants(TEXT, 5, 1) == make_mutants(TEXT, 5, 1)
    assert make_mutants(TEXT, 5, 1) != make_mutants(TEXT, 5, 2)


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def design(care: float) -> tuple[Specification, str]:
    """A small block whose modules begin with ``m_``, and what it has to compute."""
    rng = np.random.default_rng(11)
    model = WisardModel(
        BitSelect(("R7", "R6", "G7", "G6", "B7", "B5")),
        ("forest", "deforested"),
        np.stack([rng.permutation(6)[:3] for _ in range(5)])[np.newaxis],
        rng.integers(0, 3, (2, 5, 8)),
        bleaching=1,
    )
    sets: dict[str, CareSet] = {}
    if care < 1.0:
        sets = {"pixel": Codes(rng.random(64) < care), "edge": Codes(rng.random(512) < care)}
    circuit = TARGETS["block"].lower(Ingredients(model, boundary(), sets))
    part = component(minimise(circuit, 0, silent).circuit, style="cells")
    return specify(model, boundary(), sets), verilog(part, prefix="m_", header=[])


@pytest.mark.slow
@pytest.mark.simulator
@pytest.mark.parametrize("care", [1.0, 0.5])
@pytest.mark.parametrize("part", ["pixel", "edge", "block_match"])
def test_the_proof_catches_every_mutant_that_changes_a_cared_for_output(part: str, care: float) -> None:
    specification, text = design(care)
    draw = specification.claims[part].stimulus
    assert draw is not None
    inputs = {port: bits[:512] for port, bits in draw().items()}
    mutants = make_mutants(text, 40, 0)
    report = check_proof(specification, part, f"m_{part}", mutants, inputs)
    assert report.mutants == 40
    assert report.harmful > 3
    assert not report.missed, [mutant.fault for mutant in report.missed]
    assert not report.false_alarms, [mutant.fault for mutant in report.false_alarms]


@pytest.mark.simulator
def test_a_proof_that_misses_or_cries_wolf_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    specification, text = design(1.0)
    draw = specification.claims["pixel"].stimulus
    assert draw is not None
    mutants = make_mutants(text, 12, 0)
    blind = [None] * len(mutants)
    monkeypatch.setattr(mutation, "find_differences", lambda pairs, timeout: blind)
    report = check_proof(specification, "pixel", "m_pixel", mutants, draw())
    assert report.caught == 0
    assert len(report.missed) == report.harmful > 0
    alarmed: list[dict[str, int]] = [{"rgb": 0}] * len(mutants)
    monkeypatch.setattr(mutation, "find_differences", lambda pairs, timeout: alarmed)
    report = check_proof(specification, "pixel", "m_pixel", mutants, draw())
    assert len(report.false_alarms) == report.mutants - report.harmful > 0
    assert str(report).startswith(f"{report.harmful} of {report.harmful} harmful mutants caught")


@pytest.mark.simulator
def test_a_mutant_that_a_tool_refuses_is_caught_and_no_other_suffers() -> None:
    specification, text = design(1.0)
    draw = specification.claims["pixel"].stimulus
    assert draw is not None
    broken = Mutant("broken", text.replace("endmodule", "endmodul"))
    report = check_proof(specification, "pixel", "m_pixel", [Mutant("none", text), broken], draw())
    assert (report.mutants, report.harmful, report.caught) == (2, 1, 1)
    assert not report.false_alarms
