"""The claims of the reference design: the model as the judge of pixel, edge filter, matcher and block."""

from types import ModuleType

import numpy as np

from wnn2hdl.ir import Relational, WisardModel, bits_to_codes, codes_to_bits
from wnn2hdl.ir.care import Codes
from wnn2hdl.ir.pixels import bits_to_pixels, pixel_bits
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.proof import prove
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.specify import specify


def random_pixels(samples: int, pixels: int) -> Bits:
    shape = (samples, pixels, 3)
    return pixel_bits(np.random.default_rng(0).integers(0, 256, shape, dtype=np.uint8))


def test_the_block_is_pixels_then_edge_filter_and_match_count(circuits: ModuleType) -> None:
    block = circuits.random_block(0, classes=3)
    claims = circuits.specification(block).claims
    window = random_pixels(50, 9)
    reference = np.arange(50)
    outputs = claims["block_match"].answers({"window": window, "reference_bits": codes_to_bits(reference, 9)})
    bits, counts = bits_to_codes(outputs["bits"]), bits_to_codes(outputs["match_count"])
    pixels = pixel_bits(bits_to_pixels(window).reshape(-1, 3))
    classes = bits_to_codes(claims["pixel"].answers({"rgb": pixels})["class_bits"]).reshape(50, 9)
    for sample in range(50):
        assert bits[sample] == sum(1 << i for i in range(9) if classes[sample, i])
        assert outputs["edge_bit"][sample, 0] == block.edges.patterns[bits[sample]]
        assert counts[sample] == 9 - (int(bits[sample]) ^ sample).bit_count()


RELATIONAL = Relational(("3R>=2B[7:1]-7", "G7", "R+9B[6:3]>=140"))
ANSWERS = np.array([0, 1, 1, 0, 0, 0, 1, 1])

BY_HAND = """
module pixel(input [23:0] rgb, output class_bits);
  wire signed [12:0] red = {5'd0, rgb[23:16]}, blue = {6'd0, rgb[7:1]}, high = {9'd0, rgb[6:3]};
  wire ratio = red + red + red - blue - blue + 13'sd7 >= 13'sd0;
  wire bright = red + high * 13'sd9 > 13'sd139;
  assign class_bits = bright ? rgb[15] : ratio ^ rgb[15];
endmodule
"""


def compared(care: list[int]) -> Specification:
    """A table over comparisons that is cared for on these of its codes."""
    model = WisardModel(
        RELATIONAL,
        ("a", "b"),
        np.arange(3).reshape(1, 1, 3),
        np.stack([ANSWERS == 0, ANSWERS == 1])[:, np.newaxis].astype(np.int64),
        1,
    )
    return specify(model, None, {"pixel": Codes(np.isin(np.arange(8), care))})


def test_a_circuit_that_compares_as_the_model_does_is_proved_and_no_other() -> None:
    everywhere = compared(list(range(8)))
    assert prove(everywhere, {"pixel": Circuit((BY_HAND,), "pixel")})["pixel"].status == "proved"
    for change in ("13'sd7 >", "13'sd6 >"), ("13'sd139", "13'sd140"), ("rgb[7:1]}", "rgb[7:2]}"):
        wrong = Circuit((BY_HAND.replace(*change),), "pixel")
        found = prove(everywhere, {"pixel": wrong})["pixel"].counterexample
        assert found is not None
        assert found.actual != found.expected


def test_a_circuit_that_compares_is_free_outside_of_its_care_set() -> None:
    # What is not bright is answered by the ratio alone: code 2 is G7 without the ratio.
    free = BY_HAND.replace("ratio ^ rgb[15]", "ratio & ~rgb[15]")
    circuit = {"pixel": Circuit((free,), "pixel")}
    assert prove(compared([0, 1, 3, 4, 5, 6, 7]), circuit)["pixel"].status == "proved"
    assert prove(compared(list(range(8))), circuit)["pixel"].status == "refuted"


def test_stimulus_of_comparisons_has_every_code_that_occurs_and_is_cared_for() -> None:
    claim = compared([0, 1, 2, 6]).claims["pixel"]
    assert claim.stimulus is not None
    inputs = claim.stimulus()
    codes = RELATIONAL.codes(bits_to_pixels(inputs["rgb"]))[:, 0]
    assert set(codes.tolist()) == {0, 1, 2, 6}
    assert len(np.unique(inputs["rgb"], axis=0)) > 1000
    assert claim.cared(inputs).all()
    outside = {"rgb": pixel_bits(np.array([[200, 200, 200]], dtype=np.uint8))}
    assert not claim.cared(outside).any()
    assert claim.cared(claim.hold(outside)).all()


def test_answers_have_the_ports_of_the_claim(circuits: ModuleType) -> None:
    rng = np.random.default_rng(0)
    for claim in circuits.specification(circuits.random_block(0, classes=5)).claims.values():
        inputs = {port: rng.random((4, width)) < 0.5 for port, width in claim.inputs.items()}
        answers = claim.answers(inputs)
        assert {port: bits.shape for port, bits in answers.items()} == {
            port: (4, width) for port, width in claim.outputs.items()
        }


def test_what_is_held_stays_in_the_care_set_and_leaves_what_is_inside_alone(circuits: ModuleType) -> None:
    block = circuits.random_block(1, care=0.3)
    for part, port, count in (("pixel", "rgb", 1), ("block", "window", 9)):
        claim = circuits.specification(block).claims[part]
        inputs = {port: random_pixels(500, count)}
        cared = claim.cared(inputs)
        assert cared.shape == (500, count)
        held = claim.hold(inputs)
        before, after = bits_to_pixels(inputs[port]), bits_to_pixels(held[port])
        assert np.array_equal(before[cared], after[cared])
        assert claim.cared(held).all()
        assert not cared.all()


def test_the_edge_bit_matters_on_the_cared_for_windows(circuits: ModuleType) -> None:
    block = circuits.random_block(1, care=0.3)
    claims = circuits.specification(block).claims
    windows = np.arange(512)
    cared = claims["edge"].cared({"bits": codes_to_bits(windows, 9)})
    assert np.array_equal(cared[:, 0], block.window_care)
    matters = claims["block"].matters["edge_bit"]({"bits": codes_to_bits(windows, 9)})
    assert np.array_equal(matters, block.window_care)


def test_without_an_edge_filter_nothing_is_claimed_about_one(circuits: ModuleType) -> None:
    specification = specify(circuits.random_block(0).model, None, {})
    assert set(specification.claims) == {"pixel", "match"}
    assert "proof__edge" not in specification.reference
