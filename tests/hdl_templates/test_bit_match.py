"""The matcher of nine bits, on every pair of windows."""

import numpy as np
import pytest

from hdl_templates.bit_match import Parameters
from wnn2hdl.verify.simulation import simulate


@pytest.mark.slow
def test_the_matcher_is_right_for_every_pair() -> None:
    reference, bits = np.divmod(np.arange(1 << 18), 1 << 9)
    equal = 9 - np.bitwise_count(bits ^ reference)
    result = simulate(Parameters().create(), {"bits": bits, "reference": reference}, {"match_count": equal})
    assert result.vectors == 1 << 18


def test_the_golden_model_counts_equal_places() -> None:
    assert Parameters(4).compute([[1, 0, 1, 0], [1, 1, 1, 1]], [[1, 1, 1, 1], [1, 1, 1, 1]]).tolist() == [
        2,
        4,
    ]


def test_single_bits_are_not_matched() -> None:
    with pytest.raises(ValueError, match="at least 2 bits"):
        Parameters(1)
