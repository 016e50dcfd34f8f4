"""What a lane of a match engine has to compute: in how many pairs of bits the two are equal.

No model says that; it is what a template's agreement with a map is made of. So many bits are beyond a SAT
solver: the count is proved as a sum of one table for each pair (`wnn2hdl.verify.addition`).
"""

import numpy as np

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.addition import Sums, TableSum
from wnn2hdl.verify.composition import Box, Composition, Piece, bits
from wnn2hdl.verify.reference import module, plain_sum
from wnn2hdl.verify.specification import Claim, Samples, Specification

ENGINE = "engine"
"""The circuit of a match engine, and of one of its lanes, and what that consists of."""

LANE = "lane"
_AGREEMENT = "agreement"
_EQUAL = np.array([1, 0, 0, 1])
"""What a pair adds, by its code."""

_SAMPLES = 512


def lane_specification(columns: int) -> Specification:
    """The claims about a lane that compares so many pairs."""
    inputs, outputs = {"pairs": 2 * columns}, {"count": columns.bit_length()}
    total = TableSum("count", columns.bit_length(), dict.fromkeys(range(columns), _EQUAL), 0)
    piece = Piece(
        "the count is the number of pairs of equal bits, for all bits",
        None,
        inputs,
        outputs,
        sums=Sums("pairs", 2, [np.ones(4, dtype=np.bool_)] * columns, (total,)),
    )
    composition = Composition(
        LANE,
        {_AGREEMENT: piece},
        {"compares": Box(_AGREEMENT, {"pairs": bits("pairs", 2 * columns)})},
        {"count": bits("compares.count", columns.bit_length())},
        "",
    )

    def answers(samples: Samples) -> dict[str, Bits]:
        pairs = samples["pairs"].reshape(-1, columns, 2)
        return {"count": codes_to_bits((pairs[..., 0] == pairs[..., 1]).sum(axis=1), columns.bit_length())}

    def stimulus() -> dict[str, Bits]:
        return {"pairs": np.random.default_rng(0).random((_SAMPLES, 2 * columns)) < 0.5}

    equal = [f"(pairs[{2 * column}] ~^ pairs[{2 * column + 1}])" for column in range(columns)]
    lines = [f"  assign count = {plain_sum(equal, columns.bit_length())};"]
    reference = f"proof__{LANE}"
    claim = Claim(LANE, inputs, outputs, reference, answers, stimulus)
    return Specification({LANE: claim}, module(reference, inputs, outputs, lines), "", composition)
