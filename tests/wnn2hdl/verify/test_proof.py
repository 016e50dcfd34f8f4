"""The proof: passes what equals the model where it matters, and nothing else."""

from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir.pixels import bits_to_pixels
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.proof import Counterexample, prove, prove_netlists
from wnn2hdl.verify.specification import Specification, value_bits


def status(specification: Specification, part: str, circuit: Circuit) -> str:
    """The outcome for one circuit."""
    return prove(specification, {part: circuit})[part].status


def counterexample(specification: Specification, part: str, circuit: Circuit) -> Counterexample:
    """Where one circuit is not the model."""
    found = prove(specification, {part: circuit})[part].counterexample
    assert found is not None
    return found


@pytest.mark.parametrize("care", [1.0, 0.4])
@pytest.mark.parametrize("classes", [2, 3])
def test_circuits_that_equal_the_model_are_proved(circuits: ModuleType, care: float, classes: int) -> None:
    block = circuits.random_block(7, classes=classes, care=care)
    proofs = prove(
        circuits.specification(block), {part: circuits.circuit(block, part) for part in circuits.PARTS}
    )
    assert {part: proof.status for part, proof in proofs.items()} == dict.fromkeys(circuits.PARTS, "proved")


@pytest.mark.parametrize("part", ["pixel", "edge", "block", "block_match"])
def test_freedom_outside_the_care_set_is_an_error_in_exact_mode(circuits: ModuleType, part: str) -> None:
    block = circuits.random_block(7, care=0.4)
    circuit = circuits.circuit(block, part)
    assert status(circuits.specification(block), part, circuit) == "proved"
    assert status(circuits.exact(block), part, circuit) == "refuted"


@pytest.mark.parametrize("care", [1.0, 0.4])
def test_one_wrong_code_in_one_of_nine_pixels_is_found(circuits: ModuleType, care: float) -> None:
    block = circuits.random_block(8, care=care)
    code = int(np.flatnonzero(block.pixel_care)[5])
    bits = [f"window[{24 * 6 + place}]" for place in block.encoder.pixel_positions]
    this_code = " & ".join(f"{'' if code >> i & 1 else '~'}{bit}" for i, bit in enumerate(bits))
    text = circuits.emitted(block, "block_match").replace(
        "assign bits[6] = |class_6;", f"assign bits[6] = (|class_6) ^ ({this_code});"
    )
    specification = circuits.specification(block)
    found = counterexample(specification, "block_match", circuits.as_circuit("block_match", text))
    window = {"window": value_bits(found.inputs["window"], 216)}
    codes = block.encoder.codes(bits_to_pixels(window["window"]))[0]
    assert codes[6] == code
    assert found.actual["bits"] == found.expected["bits"] ^ 1 << 6
    assert block.cared(window).all()
    assert f"window {found.inputs['window']:#x}" in str(found)
    assert f"bits is {found.actual['bits']:#x} (the model says {found.expected['bits']:#x})" in str(found)


def test_a_wrong_edge_bit_is_found_on_cared_for_windows_only(circuits: ModuleType) -> None:
    block = circuits.random_block(9, care=0.4)
    specification = circuits.specification(block)
    cared, free = (int(np.flatnonzero(mask)[3]) for mask in (block.window_care, ~block.window_care))
    for window, outcome in ((cared, "refuted"), (free, "proved")):
        text = circuits.emitted(block, "edge").replace("edge_bit = ", f"edge_bit = (bits == 9'd{window}) ^ (")
        text = text.replace(";\nendmodule", ");\nendmodule")
        proof = prove(specification, {"edge": circuits.as_circuit("edge", text)})["edge"]
        assert proof.status == outcome
        if proof.counterexample is not None:
            assert proof.counterexample.inputs == {"bits": window}


@pytest.mark.parametrize(("classes", "care"), [(2, 1.0), (3, 1.0), (2, 0.5), (3, 0.5)])
def test_a_neighbourhood_that_equals_the_model_is_proved(
    circuits: ModuleType, classes: int, care: float
) -> None:
    neighbours = circuits.random_neighbours(1, classes=classes, care=care)
    circuit = circuits.circuit(neighbours, "neighbourhood")
    assert status(circuits.specification(neighbours), "neighbourhood", circuit) == "proved"
    if care < 1.0:
        assert status(circuits.exact(neighbours), "neighbourhood", circuit) == "refuted"


def test_a_neighbourhood_that_reads_a_wrong_pixel_is_found(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(2, care=0.8)
    text = circuits.emitted(neighbours, "neighbourhood")
    low = 24 * (3 * 0 + 2)
    wrong = text.replace(f"window[{low + 23}]", f"window[{low + 24 + 23}]")
    assert wrong != text
    found = counterexample(
        circuits.specification(neighbours), "neighbourhood", circuits.as_circuit("neighbourhood", wrong)
    )
    assert found.actual != found.expected
    assert neighbours.cared({"window": value_bits(found.inputs["window"], 216)}).all()


def test_a_matcher_that_miscounts_is_found(circuits: ModuleType) -> None:
    block = circuits.random_block(0)
    text = circuits.emitted(block, "match").replace("same[6] + same[7] + same[8]", "same[6] + same[7]")
    found = counterexample(circuits.exact(block), "match", circuits.as_circuit("match", text))
    assert found.actual["match_count"] == found.expected["match_count"] - 1


def test_bits_that_the_encoder_does_not_select_must_not_matter(circuits: ModuleType) -> None:
    block = circuits.random_block(2)
    text = circuits.emitted(block, "pixel").replace("class_bits[0] = ", "class_bits[0] = rgb[0] | ")
    found = counterexample(circuits.exact(block), "pixel", circuits.as_circuit("pixel", text))
    assert found.inputs["rgb"] & 1


@pytest.mark.parametrize(
    ("edge_bit", "error", "message"),
    [
        ("bits[4] | 1'bx", CheckError, "undefined value"),
        ("bits[4] | nothing", ToolError, "check -assert"),
    ],
)
def test_undefined_values_are_refused(
    circuits: ModuleType, edge_bit: str, error: type[Exception], message: str
) -> None:
    text = (
        "module edge_filter(input [8:0] bits, output edge_bit);\n"
        f"  wire nothing;\n  assign edge_bit = {edge_bit};\nendmodule\n"
    )
    with pytest.raises(error, match=message):
        prove(circuits.exact(circuits.random_block(0)), {"edge": circuits.as_circuit("edge", text)})


def test_registers_are_refused(circuits: ModuleType) -> None:
    text = (
        "module edge_filter(input [8:0] bits, output reg edge_bit);\n"
        "  always @(posedge bits[0]) edge_bit <= bits[4];\nendmodule\n"
    )
    with pytest.raises(CheckError, match="registers"):
        prove(circuits.exact(circuits.random_block(0)), {"edge": circuits.as_circuit("edge", text)})


def test_a_missing_port_is_an_error(circuits: ModuleType) -> None:
    text = "module edge_filter(input [8:0] bits, output edges);\n  assign edges = bits[4];\nendmodule\n"
    with pytest.raises(ToolError, match="edge_bit"):
        prove(circuits.exact(circuits.random_block(0)), {"edge": circuits.as_circuit("edge", text)})


LUT_EDGE = """\
module edge_filter(input [8:0] bits, output edge_bit);
  wire all_low;
  LUT6 #(.INIT(64'h8000000000000000)) low (.O(all_low), .I0(bits[0]), .I1(bits[1]), .I2(bits[2]),
    .I3(bits[3]), .I4(bits[4]), .I5(bits[5]));
  LUT5 #(.INIT(32'h{init:08x})) high (.O(edge_bit), .I0(bits[4]), .I1(all_low), .I2(bits[6]), .I3(bits[7]),
    .I4(bits[8]));
endmodule
"""


def test_instantiated_luts_are_proved_by_their_contents(circuits: ModuleType) -> None:
    specification = circuits.exact(circuits.random_block(0))
    # The centre is set, and not all of the nine: address bit 0 is the centre, 31 is "all set".
    right = sum(1 << address for address in range(31) if address & 1)
    for init, outcome in ((right, "proved"), (right ^ 1 << 31, "refuted")):
        circuit = circuits.as_circuit("edge", LUT_EDGE.format(init=init))
        assert status(specification, "edge", circuit) == outcome


@pytest.mark.parametrize("as_graphs", [(), ("edge", "match")], ids=["as Yosys reads it", "as graphs"])
@pytest.mark.parametrize(("part", "output"), [("edge", "edge_bit"), ("match", "match_count")])
def test_the_mapped_netlist_is_proved_equal_and_one_flipped_init_bit_found(
    circuits: ModuleType, part: str, output: str, as_graphs: tuple[str, ...]
) -> None:
    block = circuits.random_block(6)
    source = circuits.circuit(block, part)
    netlist = circuits.mapped(source)
    (text,) = netlist.sources
    claim = circuits.exact(block).claims[part]
    ports = {part: (claim.inputs, claim.outputs)}
    assert prove_netlists({part: (source, netlist)}, ports, as_graphs)[part].status == "proved"
    start = text.index("'h", text.index("INIT(")) + 2
    wrong = f"{text[:start]}{int(text[start], 16) ^ 1:x}{text[start + 1 :]}"
    netlist = circuits.as_circuit(part, wrong)
    found = prove_netlists({part: (source, netlist)}, ports, as_graphs)[part].counterexample
    assert found is not None
    assert found.actual[output] != found.expected[output]


@pytest.mark.parametrize(
    "module",
    [
        "module LUT5(output O, input I0, I1, I2, I3, I4); parameter INIT = 0;"
        " assign O = I0 & ~(I1 & I2 & I3 & I4);",
        "module proof__held(input [8:0] bits, output edge_bit); assign edge_bit = 1'b0;",
        "module proof__care_window(input [8:0] bits, output cared); assign cared = 1'b0;",
    ],
)
def test_what_a_file_says_of_a_library_cell_or_of_the_proofs_own_modules_does_not_count(
    circuits: ModuleType, module: str
) -> None:
    circuit = circuits.as_circuit("edge", f"{LUT_EDGE.format(init=0)}{module} endmodule\n")
    assert status(circuits.exact(circuits.random_block(0)), "edge", circuit) == "refuted"
