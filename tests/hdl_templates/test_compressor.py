# amaranth: UnusedElaboratable=no
"""Compressors, one by one and in trees."""

import numpy as np
import pytest
from amaranth.hdl import Cat, Module
from amaranth.lib.wiring import In, Out

from hdl_templates.compressor import Columns, Compressor, MatchCompressor, add_columns
from hdl_templates.hierarchy import Part
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.verify.simulation import simulate


@pytest.mark.parametrize("ones", range(2, 7))
def test_a_compressor_counts(ones: int) -> None:
    for twos in range(7 - ones):
        codes = np.arange(1 << (ones + twos))
        one, two = codes & ((1 << ones) - 1), codes >> ones
        total = np.bitwise_count(one) + 2 * np.bitwise_count(two)
        inputs = {"one": codes_to_bits(one, ones)}
        if twos:
            inputs["two"] = codes_to_bits(two, twos)
        full = (ones + 2 * twos).bit_length()
        for width in (full, full - 1):
            part = Compressor(ones=ones, twos=twos, width=width)
            simulate(part, inputs, {"total": codes_to_bits(total, width)})


@pytest.mark.parametrize("pairs", [2, 3])
def test_a_match_compressor_counts_equal_pairs(pairs: int) -> None:
    codes = np.arange(1 << (2 * pairs))
    bits, reference = codes & ((1 << pairs) - 1), codes >> pairs
    equal = pairs - np.bitwise_count(bits ^ reference)
    inputs = {"bits": codes_to_bits(bits, pairs), "reference_bits": codes_to_bits(reference, pairs)}
    simulate(MatchCompressor(pairs=pairs), inputs, {"total": codes_to_bits(equal, 2)})


@pytest.mark.parametrize(("ones", "twos", "width"), [(1, 0, 1), (6, 1, 3), (3, 0, 3), (2, 0, 0)])
def test_what_no_lut_can_count_is_refused(ones: int, twos: int, width: int) -> None:
    with pytest.raises(ValueError, match=r"a compressor adds|the sum of"):
        Compressor(ones=ones, twos=twos, width=width)


def test_only_what_fits_a_lut_is_compared_at_once() -> None:
    with pytest.raises(ValueError, match="compares 2 or 3 pairs, not 4"):
        MatchCompressor(pairs=4)


class Adder(Part):
    """Adds columns of bits."""

    module_name = "adder"

    def __init__(self, *, sizes: tuple[int, ...], width: int) -> None:
        self.sizes, self.width = sizes, width
        super().__init__({"word": In(sum(sizes)), "total": Out(width)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bits = iter(self.word)
        columns: Columns = {weight: [next(bits) for _ in range(n)] for weight, n in enumerate(self.sizes)}
        m.d.comb += self.total.eq(Cat(add_columns(m, columns, self.width, name="sum", platform=platform)))
        return m


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 6, 7, 9, 11, 12])
def test_a_popcount_is_right_for_every_word(width: int) -> None:
    words = np.arange(1 << width)
    total = codes_to_bits(np.bitwise_count(words), width.bit_length())
    adder = Adder(sizes=(width,), width=width.bit_length())
    simulate(adder, {"word": codes_to_bits(words, width)}, {"total": total})


@pytest.mark.parametrize("sizes", [(3, 3), (0, 2), (1, 4, 2), (2, 1, 0, 3), (5, 5, 1)])
def test_columns_of_any_height_are_added(sizes: tuple[int, ...]) -> None:
    words = codes_to_bits(np.arange(1 << sum(sizes)), sum(sizes))
    weights = np.repeat(1 << np.arange(len(sizes)), sizes)
    width = int(weights.sum()).bit_length()
    simulate(
        Adder(sizes=sizes, width=width), {"word": words}, {"total": codes_to_bits(words @ weights, width)}
    )
