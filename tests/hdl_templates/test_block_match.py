"""The block with its matcher."""

import numpy as np
import pytest

from hdl_templates import bit_match, block, block_match, discriminator, edge_filter
from hdl_templates.lookup import SumOfProducts
from wnn2hdl.verify.simulation import simulate

RED = discriminator.Parameters((23,), SumOfProducts(("R7",), ("class_bit0",), (((1, 1),),)))
CENTRE = edge_filter.Parameters(
    SumOfProducts(tuple(f"bit{i}" for i in range(9)), ("edge_bit",), (((0b10000, 0b10000),),))
)


def test_the_circuit_equals_the_golden_model() -> None:
    parameters = block_match.Parameters(block.Parameters(RED, CENTRE))
    rng = np.random.default_rng(5)
    windows, references = rng.integers(0, 1 << 24, (500, 9)), rng.integers(0, 512, 500)
    expected = parameters.compute(windows, references)
    bits = (windows >> 23) @ (1 << np.arange(9))
    np.testing.assert_array_equal(expected["bits"], bits)
    np.testing.assert_array_equal(expected["match_count"], 9 - np.bitwise_count(bits ^ references))
    simulate(parameters.create(), {"window": windows, "reference": references}, expected)


def test_a_block_matches_nine_bits() -> None:
    with pytest.raises(ValueError, match="a block matches 9 bits, not 10"):
        block_match.Parameters(block.Parameters(RED, CENTRE), bit_match.Parameters(10))
