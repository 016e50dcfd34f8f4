"""The claims about a classifier that counts bits in squares."""

import numpy as np

from wnn2hdl.ir import Context, WisardModel, bits_to_codes, codes_to_bits
from wnn2hdl.ir.care import Codes
from wnn2hdl.ir.context import box_sums
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.ir.relational import pixel_codes
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.proof import prove
from wnn2hdl.verify.specify import specify

ENCODER = Context(("7x7(3R>=2B)>=13", "R7", "7x7(3R>=2B)>=37", "3x3(R7)>=5"))
ANSWERS = np.random.default_rng(0).permutation(np.arange(16) % 2)
MODEL = WisardModel(
    ENCODER,
    ("forest", "deforested"),
    np.arange(4).reshape(1, 1, 4),
    np.stack([1 - ANSWERS, ANSWERS])[:, np.newaxis],
    1,
)
CARE = Codes(np.random.default_rng(1).permutation(np.arange(16) % 2 == 0))

PLANES = """\
module planes(input [23:0] rgb, output [1:0] plane_bits);
assign plane_bits = {rgb[23], 10'd3 * rgb[23:16] >= 10'd2 * rgb[7:0]};
endmodule
"""
DECISION = f"""\
module context(input [10:0] counts, output class_bits);
wire [3:0] code = {{counts[10:7] >= 5, counts[6:1] >= 37, counts[0], counts[6:1] >= 13}};
wire [15:0] table_ = 16'd{sum(int(bit) << code for code, bit in enumerate(ANSWERS))};
assign class_bits = table_[code];
endmodule
"""


def test_the_parts_are_together_the_model() -> None:
    claims = specify(MODEL, None, {}).claims
    picture = np.random.default_rng(2).integers(0, 256, (20, 30, 3), dtype=np.uint8)
    seen = claims["planes"].answers({"rgb": pixel_bits(picture.reshape(-1, 3))})["plane_bits"]
    planes = seen.reshape(20, 30, 2)
    assert np.array_equal(bits_to_codes(seen), pixel_codes(ENCODER.planes, picture).ravel())
    assert ENCODER.sums == (("R7", 1), ("3R>=2B", 7), ("R7", 3))
    words = [planes[3:-3, 3:-3, 1], box_sums(planes[..., 0], 7), box_sums(planes[2:-2, 2:-2, 1], 3)]
    bits = [codes_to_bits(word.ravel(), width) for word, width in zip(words, (1, 6, 4), strict=True)]
    counts = {"counts": np.concatenate(bits, axis=1)}
    answers = bits_to_codes(claims["context"].answers(counts)["class_bits"])
    assert answers.tolist() == ANSWERS[ENCODER.codes(picture)].ravel().tolist()


def test_counts_are_cared_for_by_their_code_and_each_threshold_is_tried() -> None:
    claim = specify(MODEL, None, {"context": CARE}).claims["context"]
    assert claim.stimulus is not None
    counts = claim.stimulus()
    assert claim.cared(counts).all()
    whole = specify(MODEL, None, {}).claims["context"]
    assert whole.stimulus is not None
    seen = bits_to_codes(whole.stimulus()["counts"][:, 1:7])
    assert {12, 13, 36, 37} <= set(seen.tolist())
    assert seen.max() <= 49


def test_parts_are_proved_and_wrong_ones_refuted() -> None:
    specification = specify(MODEL, None, {})
    right = {"planes": PLANES, "context": DECISION}
    found = prove(specification, {part: Circuit((text,), part) for part, text in right.items()})
    assert {part: proof.status for part, proof in found.items()} == dict.fromkeys(right, "proved")
    wrong = {"planes": PLANES.replace("2 *", "3 *"), "context": DECISION.replace("13}", "14}")}
    found = prove(specification, {part: Circuit((text,), part) for part, text in wrong.items()})
    assert {part: proof.status for part, proof in found.items()} == dict.fromkeys(wrong, "refuted")


def test_what_is_not_cared_for_may_differ() -> None:
    specification = specify(MODEL, None, {"context": CARE})
    free = int(np.flatnonzero(~CARE.project(tuple(range(4))) & ENCODER.possible)[0])
    kept = int(np.flatnonzero(CARE.project(tuple(range(4))) & ENCODER.possible)[0])
    status = {}
    for code in (free, kept):
        text = DECISION.replace("table_[code]", f"table_[code] ^ (code == {code})")
        status[code] = prove(specification, {"context": Circuit((text,), "context")})["context"].status
    assert status == {free: "proved", kept: "refuted"}
