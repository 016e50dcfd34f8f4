"""The proof catches every mutant that matters, and only those."""

from types import ModuleType
from typing import Literal

import pytest

from wnn2hdl.verify.mutation import Mutant, check_proof, make_mutants

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


def test_a_small_circuit_is_broken_twice_when_its_single_faults_are_used_up() -> None:
    mutants = make_mutants(TEXT, 200, 0)
    assert len({mutant.verilog for mutant in mutants}) == 200
    assert any("; " in mutant.fault for mutant in mutants)
    assert make_mutants("// nothing here\n", 5, 0) == []


def test_the_choice_is_the_same_for_the_same_seed() -> None:
    assert make_mutants(TEXT, 5, 1) == make_mutants(TEXT, 5, 1)
    assert make_mutants(TEXT, 5, 1) != make_mutants(TEXT, 5, 2)


EDGE_OF_CELLS = """\
module edge_filter(input [8:0] bits, output edge_bit);
  wire all_low;
  LUT6 #(.INIT(64'h8000000000000000)) low (.O(all_low), .I0(bits[0]), .I1(bits[1]), .I2(bits[2]),
    .I3(bits[3]), .I4(bits[4]), .I5(bits[5]));
  LUT6 #(.INIT(64'h2aaaaaaa2aaaaaaa)) high (.O(edge_bit), .I0(bits[4]), .I1(all_low), .I2(bits[6]),
    .I3(bits[7]), .I4(bits[8]), .I5(1'h0));
endmodule
"""

CELL_MODEL = """\
module LUT6 #(parameter [63:0] INIT = 64'h0) (
  output O, input I0, input I1, input I2, input I3, input I4, input I5);
  assign O = INIT[{I5, I4, I3, I2, I1, I0}];
endmodule
"""


@pytest.mark.slow
@pytest.mark.simulator
@pytest.mark.parametrize("care", [1.0, 0.5])
def test_the_proof_catches_every_mutant_that_changes_a_cared_for_output(
    circuits: ModuleType, care: float
) -> None:
    specification = circuits.random_specification(11, care=care)
    parts: dict[Literal["pixel", "edge"], str] = {
        "pixel": circuits.emitted(specification, "pixel", free=False),
        "edge": EDGE_OF_CELLS,
    }
    for part, text in parts.items():
        # The simulator needs a model of the cells; the proof uses Yosys's.
        mutants = [Mutant(mutant.fault, mutant.verilog + CELL_MODEL) for mutant in make_mutants(text, 110, 0)]
        report = check_proof(specification, part, mutants, "icarus")
        assert report.mutants == 110
        assert report.harmful > 30
        assert not report.missed, [mutant.fault for mutant in report.missed]
        assert not report.false_alarms, [mutant.fault for mutant in report.false_alarms]


@pytest.mark.simulator
def test_a_proof_that_misses_or_cries_wolf_is_told_on(
    circuits: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    specification = circuits.random_specification(11)
    mutants = make_mutants(circuits.emitted(specification, "pixel"), 12, 0)
    blind = [None] * len(mutants)
    monkeypatch.setattr("wnn2hdl.verify.mutation.find_differences", lambda pairs, timeout: blind)
    report = check_proof(specification, "pixel", mutants, "icarus")
    assert report.caught == 0
    assert len(report.missed) == report.harmful > 0
    alarmed: list[dict[str, int]] = [{"rgb": 0}] * len(mutants)
    monkeypatch.setattr("wnn2hdl.verify.mutation.find_differences", lambda pairs, timeout: alarmed)
    report = check_proof(specification, "pixel", mutants, "icarus")
    assert len(report.false_alarms) == report.mutants - report.harmful
    assert str(report).startswith(f"{report.harmful} of {report.harmful} harmful mutants caught")
