# amaranth: UnusedElaboratable=no
"""Match and count, on every pair of narrow words and on wide ones."""

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out
from numpy.typing import NDArray

from hdl_templates.hierarchy import Part
from hdl_templates.matcher import draw_match, match_network
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.verify.simulation import simulate


class Matcher(Part):
    """Counts the places in which two words agree."""

    module_name = "matcher"

    def __init__(self, *, width: int) -> None:
        ports = {"bits": In(width), "reference_bits": In(width), "match_count": Out(width.bit_length())}
        super().__init__(ports)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count = draw_match(m, self.bits, self.reference_bits, name="match", platform=platform)
        m.d.comb += self.match_count.eq(count)
        return m


def check(bits: NDArray[np.bool_], reference: NDArray[np.bool_]) -> None:
    width = bits.shape[1]
    count = codes_to_bits((bits == reference).sum(axis=1), width.bit_length())
    simulate(Matcher(width=width), {"bits": bits, "reference_bits": reference}, {"match_count": count})
    words = np.concatenate([bits, reference], axis=1)
    assert np.array_equal(match_network(width).evaluate_bits(words), count)


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 6])
def test_every_pair_of_narrow_words_is_counted_right(width: int) -> None:
    pairs = codes_to_bits(np.arange(1 << 2 * width), 2 * width)
    check(pairs[:, :width], pairs[:, width:])


@pytest.mark.parametrize("width", [37, 220])
def test_wide_words_are_counted_right(width: int) -> None:
    rng = np.random.default_rng(width)
    bits = rng.random((60, width)) < rng.random((60, 1))
    reference = rng.random((60, width)) < rng.random((60, 1))
    bits[0] = reference[0]
    bits[1] = ~reference[1]
    check(bits, reference)
