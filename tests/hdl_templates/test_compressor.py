# amaranth: UnusedElaboratable=no
"""Compressors, one by one and in trees."""

import numpy as np
import pytest

from hdl_templates.bit_match import Parameters as MatchParameters
from hdl_templates.compressor import Compressor, MatchCompressor
from hdl_templates.popcount import Parameters as PopcountParameters
from wnn2hdl.verify.simulation import simulate


@pytest.mark.parametrize("ones", range(2, 7))
def test_a_compressor_counts(ones: int) -> None:
    for twos in range(7 - ones):
        codes = np.arange(1 << (ones + twos))
        one, two = codes & ((1 << ones) - 1), codes >> ones
        total = np.bitwise_count(one) + 2 * np.bitwise_count(two)
        inputs = {"one": one, "two": two} if twos else {"one": one}
        full = (ones + 2 * twos).bit_length()
        for width in (full, full - 1):
            simulate(
                Compressor(ones=ones, twos=twos, width=width), inputs, {"total": total & ((1 << width) - 1)}
            )


@pytest.mark.parametrize("pairs", [2, 3])
def test_a_match_compressor_counts_equal_pairs(pairs: int) -> None:
    codes = np.arange(1 << (2 * pairs))
    bits, reference = codes & ((1 << pairs) - 1), codes >> pairs
    equal = pairs - np.bitwise_count(bits ^ reference)
    simulate(MatchCompressor(pairs=pairs), {"bits": bits, "reference": reference}, {"total": equal})


@pytest.mark.parametrize(("ones", "twos", "width"), [(1, 0, 1), (6, 1, 3), (3, 0, 3), (2, 0, 0)])
def test_what_no_lut_can_count_is_refused(ones: int, twos: int, width: int) -> None:
    with pytest.raises(ValueError, match=r"a compressor adds|the sum of"):
        Compressor(ones=ones, twos=twos, width=width)


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 6, 7, 9, 11, 12])
def test_a_popcount_is_right_for_every_word(width: int) -> None:
    words = np.arange(1 << width)
    parameters = PopcountParameters(width)
    bits = words[:, np.newaxis] >> np.arange(width) & 1
    count = parameters.compute(bits)
    assert count.tolist() == [int(word).bit_count() for word in words]
    simulate(parameters.create(), {"bits": words}, {"count": count})


@pytest.mark.parametrize("width", [37, 220])
def test_a_wide_match_counts_right(width: int) -> None:
    rng = np.random.default_rng(width)
    bits = rng.random((60, width)) < rng.random((60, 1))
    reference = rng.random((60, width)) < rng.random((60, 1))
    bits[0] = reference[0]
    bits[1] = ~reference[1]
    parameters = MatchParameters(width)
    expected = parameters.compute(bits, reference)
    assert expected[:2].tolist() == [width, 0]
    simulate(parameters.create(), {"bits": bits, "reference": reference}, {"match_count": expected})
