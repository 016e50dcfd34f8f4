"""The proof: passes what equals the model where it matters, and nothing else."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.tools import find_yosys
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.mutation import make_mutants
from wnn2hdl.verify.proof import prove, prove_netlists
from wnn2hdl.verify.specification import (
    PART_NAMES,
    NeighbourhoodSpecification,
    PartName,
    Specification,
    pixels_to_word,
)
from wnn2hdl.verify.vectors import stimulus


def written(folder: Path, text: str, name: str = "circuit.v") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("care", [1.0, 0.4])
@pytest.mark.parametrize("classes", [2, 3])
def test_circuits_that_equal_the_model_are_proved(
    circuits: ModuleType, tmp_path: Path, care: float, classes: int
) -> None:
    specification = circuits.random_specification(7, classes=classes, care=care)
    files = {
        part: written(tmp_path, circuits.emitted(specification, part), f"{part}.v") for part in PART_NAMES
    }
    proofs = prove(specification, files)
    assert {part: proof.status for part, proof in proofs.items()} == dict.fromkeys(PART_NAMES, "proved")


@pytest.mark.parametrize("part", ["pixel", "edge", "block", "block_match"])
def test_freedom_outside_the_care_set_is_an_error_in_exact_mode(
    circuits: ModuleType, tmp_path: Path, part: PartName
) -> None:
    domain = circuits.random_specification(7, care=0.4)
    exact = Specification.exact(domain.model, domain.edge_filter)
    path = written(tmp_path, circuits.emitted(domain, part))
    assert prove(domain, {part: path})[part].status == "proved"
    assert prove(exact, {part: path})[part].status == "refuted"


@pytest.mark.parametrize("care", [1.0, 0.4])
def test_one_wrong_code_in_one_of_nine_pixels_is_found(
    circuits: ModuleType, tmp_path: Path, care: float
) -> None:
    specification = circuits.random_specification(8, care=care)
    code = int(np.flatnonzero(specification.pixel_care)[5])
    wrong = specification.model.evaluate_all_codes()
    wrong[code] ^= 1
    bits = [f"window[{24 * 6 + place}]" for place in specification.encoder.pixel_positions]
    this_code = " & ".join(f"{'' if code >> i & 1 else '~'}{bit}" for i, bit in enumerate(bits))
    text = circuits.emitted(specification, "block_match").replace(
        "assign bits[6] = |class_6;", f"assign bits[6] = (|class_6) ^ ({this_code});"
    )
    found = prove(specification, {"block_match": written(tmp_path, text)})["block_match"].counterexample
    assert found is not None
    pixel = found.inputs["window"][0, 6]
    assert specification.encoder.codes(pixel) == code
    assert found.actual["bits"] == found.expected["bits"] ^ 1 << 6
    assert specification.pixel_care[specification.encoder.codes(found.inputs["window"])].all()
    red, green, blue = pixel.tolist()
    assert f"({red},{green},{blue})" in str(found)
    assert f"bits is {found.actual['bits']:#b} (the model says {found.expected['bits']:#b})" in str(found)


def test_a_wrong_edge_bit_is_found_on_cared_for_windows_only(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_specification(9, care=0.4)
    cared, free = (
        int(np.flatnonzero(mask)[3]) for mask in (specification.window_care, ~specification.window_care)
    )
    for window, status in ((cared, "refuted"), (free, "proved")):
        text = circuits.emitted(specification, "edge").replace(
            "edge_bit = ", f"edge_bit = (bits == 9'd{window}) ^ ("
        )
        text = text.replace(";\nendmodule", ");\nendmodule")
        proof = prove(specification, {"edge": written(tmp_path, text)})["edge"]
        assert proof.status == status
        if proof.counterexample is not None:
            assert proof.counterexample.inputs["bits"].tolist() == [window]


@pytest.mark.parametrize(("classes", "care"), [(2, 1.0), (3, 1.0), (2, 0.5), (3, 0.5)])
def test_a_neighbourhood_that_equals_the_model_is_proved(
    circuits: ModuleType, tmp_path: Path, classes: int, care: float
) -> None:
    specification = circuits.random_neighbourhood(1, classes=classes, care=care)
    path = written(tmp_path, circuits.emitted_neighbourhood(specification))
    assert prove(specification, {"neighbourhood": path})["neighbourhood"].status == "proved"
    if care < 1.0:
        exact = NeighbourhoodSpecification(specification.model, np.ones(32, dtype=np.bool_))
        assert prove(exact, {"neighbourhood": path})["neighbourhood"].status == "refuted"


def test_a_neighbourhood_that_reads_a_wrong_pixel_is_found(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_neighbourhood(2, care=0.8)
    text = circuits.emitted_neighbourhood(specification)
    low = 24 * (3 * 0 + 2)
    wrong = text.replace(f"window[{low + 23}]", f"window[{low + 24 + 23}]")
    assert wrong != text
    found = prove(specification, {"neighbourhood": written(tmp_path, wrong)})["neighbourhood"].counterexample
    assert found is not None
    assert found.actual != found.expected
    assert specification.care[specification.codes(found.inputs["window"])].all()


@pytest.mark.simulator
def test_mutants_of_a_neighbourhood_that_differ_are_found(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_neighbourhood(3)
    text = circuits.emitted_neighbourhood(specification)
    windows = stimulus(specification, "neighbourhood")
    inputs = {"window": windows["window"]}
    expected = specification.evaluate("neighbourhood", inputs)["class_bits"]
    mutants = make_mutants(text, 8, seed=0)
    part = specification.part("neighbourhood")
    refuted = 0
    for mutant in mutants:
        path = written(tmp_path, mutant.verilog)
        status = prove(specification, {"neighbourhood": path})["neighbourhood"].status
        answers, _ = run_compiled(part, [path], inputs, "icarus")
        if (answers["class_bits"] != expected).any():
            assert status == "refuted", mutant.fault
            refuted += 1
        else:
            assert status == "proved", mutant.fault
    assert refuted > 0


def test_a_matcher_that_miscounts_is_found(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_specification(0)
    text = circuits.emitted(specification, "match").replace(
        "same[6] + same[7] + same[8]", "same[6] + same[7]"
    )
    found = prove(specification, {"match": written(tmp_path, text)})["match"].counterexample
    assert found is not None
    assert found.actual["match_count"] == found.expected["match_count"] - 1


def test_bits_that_the_encoder_does_not_select_must_not_matter(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_specification(2)
    text = circuits.emitted(specification, "pixel").replace("class_bits[0] = ", "class_bits[0] = rgb[0] | ")
    found = prove(specification, {"pixel": written(tmp_path, text)})["pixel"].counterexample
    assert found is not None
    assert pixels_to_word(found.inputs["rgb"]) & 1


@pytest.mark.parametrize(
    ("edge_bit", "error", "message"),
    [
        ("bits[4] | 1'bx", CheckError, "undefined value"),
        ("bits[4] | nothing", ToolError, "check -assert"),
    ],
)
def test_undefined_values_are_refused(
    circuits: ModuleType, tmp_path: Path, edge_bit: str, error: type[Exception], message: str
) -> None:
    text = (
        "module edge_filter(input [8:0] bits, output edge_bit);\n"
        f"  wire nothing;\n  assign edge_bit = {edge_bit};\nendmodule\n"
    )
    with pytest.raises(error, match=message):
        prove(circuits.random_specification(0), {"edge": written(tmp_path, text)})


def test_registers_are_refused(circuits: ModuleType, tmp_path: Path) -> None:
    text = (
        "module edge_filter(input [8:0] bits, output reg edge_bit);\n"
        "  always @(posedge bits[0]) edge_bit <= bits[4];\nendmodule\n"
    )
    with pytest.raises(CheckError, match="registers"):
        prove(circuits.random_specification(0), {"edge": written(tmp_path, text)})


def test_a_missing_port_is_an_error(circuits: ModuleType, tmp_path: Path) -> None:
    text = "module edge_filter(input [8:0] bits, output edges);\n  assign edges = bits[4];\nendmodule\n"
    with pytest.raises(ToolError, match="edge_bit"):
        prove(circuits.random_specification(0), {"edge": written(tmp_path, text)})


LUT_EDGE = """\
module edge_filter(input [8:0] bits, output edge_bit);
  wire all_low;
  LUT6 #(.INIT(64'h8000000000000000)) low (.O(all_low), .I0(bits[0]), .I1(bits[1]), .I2(bits[2]),
    .I3(bits[3]), .I4(bits[4]), .I5(bits[5]));
  LUT5 #(.INIT(32'h{init:08x})) high (.O(edge_bit), .I0(bits[4]), .I1(all_low), .I2(bits[6]), .I3(bits[7]),
    .I4(bits[8]));
endmodule
"""


def test_instantiated_luts_are_proved_by_their_contents(circuits: ModuleType, tmp_path: Path) -> None:
    specification = circuits.random_specification(0)
    # The centre is set, and not all of the nine: address bit 0 is the centre, 31 is "all set".
    right = sum(1 << address for address in range(31) if address & 1)
    for init, status in ((right, "proved"), (right ^ 1 << 31, "refuted")):
        path = written(tmp_path, LUT_EDGE.format(init=init))
        assert prove(specification, {"edge": path})["edge"].status == status


def test_the_mapped_netlist_is_proved_equal_and_one_flipped_init_bit_found(
    circuits: ModuleType, tmp_path: Path
) -> None:
    specification = circuits.random_specification(6)
    source = written(tmp_path, circuits.emitted(specification, "edge"))
    netlist = tmp_path / "netlist.v"
    find_yosys().run(
        f"read_verilog {source}\nsynth_xilinx -family xc7 -flatten -noiopad -top edge_filter\n"
        f"write_verilog -noattr {netlist}\n",
        timeout=60,
    )
    assert prove_netlists(specification, {"edge": (source, netlist)})["edge"].status == "proved"
    text = netlist.read_text(encoding="utf-8")
    start = text.index("'h", text.index("INIT(")) + 2
    netlist.write_text(f"{text[:start]}{int(text[start], 16) ^ 1:x}{text[start + 1 :]}", encoding="utf-8")
    found = prove_netlists(specification, {"edge": (source, netlist)})["edge"].counterexample
    assert found is not None
    assert found.actual["edge_bit"] != found.expected["edge_bit"]


def test_what_a_file_says_of_a_library_cell_or_of_the_proofs_own_modules_does_not_count(
    circuits: ModuleType, tmp_path: Path
) -> None:
    specification = circuits.random_specification(0)
    wrong = LUT_EDGE.format(init=0)
    for module in (
        "module LUT5(output O, input I0, I1, I2, I3, I4); parameter INIT = 0;"
        " assign O = I0 & ~(I1 & I2 & I3 & I4);",
        "module held(input [8:0] bits, output edge_bit); assign edge_bit = 1'b0;",
        "module care_window(input [8:0] bits, output cared); assign cared = 1'b0;",
    ):
        path = written(tmp_path, f"{wrong}{module} endmodule\n")
        assert prove(specification, {"edge": path})["edge"].status == "refuted"
