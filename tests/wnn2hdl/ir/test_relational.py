"""Comparisons of channels: their names, their numbers, and the codes that they allow."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import BitSelect, Comparison, Relational
from wnn2hdl.ir.encoder import encoder_from_json
from wnn2hdl.ir.pixels import pixels_of_codes
from wnn2hdl.ir.relational import Weighted, examples, occurring, signal_name
from wnn2hdl.ir.verilog_text import check_identifier

slices = st.sampled_from([(low, high) for high in range(8) for low in range(max(0, high - 5), high + 1)])


@st.composite
def comparisons(draw: st.DrawFn) -> Comparison:
    channels = draw(st.permutations("RGB"))
    count = draw(st.integers(1, 3))
    terms = [Weighted(channel, draw(st.integers(1, 99)), *draw(slices)) for channel in channels]
    left = draw(st.integers(1, count))
    return Comparison(tuple(terms[:left]), tuple(terms[left:count]), draw(st.integers(-999, 999)))


colours = st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=20)


@given(comparisons())
def test_a_name_says_all_of_a_comparison(comparison: Comparison) -> None:
    assert Comparison.parse(str(comparison)) == comparison
    check_identifier(signal_name(str(comparison)))


@given(comparisons(), colours)
def test_sums_of_channels_are_compared_as_plain_numbers(
    comparison: Comparison, values: list[tuple[int, int, int]]
) -> None:
    answers = comparison.evaluate(np.array(values, dtype=np.uint8))
    for pixel, answer in zip(values, answers.tolist(), strict=True):
        level = dict(zip("RGB", pixel, strict=True))
        left, right = (
            sum(term.weight * (level[term.channel] % 2 ** (term.high + 1) >> term.low) for term in side)
            for side in (comparison.left, comparison.right)
        )
        assert answer == (left >= right + comparison.offset)


def test_large_sums_do_not_wrap_around() -> None:
    comparison = Comparison.parse("99R>=99B-99")
    bright = np.array([[255, 0, 255], [254, 0, 255], [253, 0, 255]], dtype=np.uint8)
    assert comparison.evaluate(bright).tolist() == [True, True, False]


def test_a_table_has_a_code_of_the_bits_that_are_read() -> None:
    comparison = Comparison.parse("3R[7:5]>=2B[7:6]+4")
    assert comparison.bits == ("R5", "R6", "R7", "B6", "B7")
    table = comparison.table()
    for code in range(32):
        assert table[code] == (3 * (code & 7) >= 2 * (code >> 3) + 4)


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("R7", "compares no channels"),
        ("3R>=2X", "compares no channels"),
        ("R>2B", "compares no channels"),
        ("100R>=2B", "compares no channels"),
        ("3R>=R", "each channel once"),
        ("1R>=B", "is written R>=B"),
        ("R[7:0]>=B", "is written R>=B"),
        ("R[2:5]>=B", "reads no bits"),
        ("R>=B+0", "is written R>=B"),
        ("R+G>=B", "24 bits; a table reads 20"),
    ],
)
def test_other_names_are_refused(name: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        Comparison.parse(name)


ENCODER = Relational(("3R>=2B-2", "R7", "2R[7:1]>=B[7:1]", "R>=40"))


def test_a_code_holds_comparisons_and_bits_in_their_order() -> None:
    pixels = np.array([[[30, 9, 46], [30, 9, 47]], [[200, 0, 255], [41, 0, 60]]], dtype=np.uint8)
    assert ENCODER.codes(pixels).tolist() == [[0b0101, 0b0100], [0b1111, 0b1101]]
    assert (ENCODER.width, ENCODER.names, ENCODER.halo) == (4, ENCODER.bits, 0)


def test_an_encoder_is_the_same_after_a_round_trip() -> None:
    assert encoder_from_json(json.loads(json.dumps(ENCODER.to_json()))) == ENCODER


@pytest.mark.parametrize(("bits", "says"), [(("R7",), "for bits alone"), (("R>=B", "R>=B"), "named twice")])
def test_an_encoder_compares_and_names_each_bit_once(bits: tuple[str, ...], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        Relational(bits)


def test_each_code_that_occurs_has_an_example_and_no_other_code_occurs() -> None:
    found = examples(ENCODER)
    for code, pixel in found.items():
        assert ENCODER.codes(np.array(pixel, dtype=np.uint8)) == code
    drawn = np.random.default_rng(0).integers(0, 256, (20_000, 3), dtype=np.uint8)
    assert set(ENCODER.codes(drawn).tolist()) <= found.keys()
    # R7 is set from 128 on, so that R >= 40 holds too.
    assert not occurring(ENCODER)[0b0010]
    assert occurring(BitSelect(("R7", "R6"))).all()


def test_pixels_are_drawn_for_every_code_that_occurs() -> None:
    codes = np.resize(np.flatnonzero(occurring(ENCODER)), (30, 7))
    rng = np.random.default_rng(0)
    pixels = pixels_of_codes(ENCODER, codes, rng)
    assert np.array_equal(ENCODER.codes(pixels), codes)
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 100
    assert np.array_equal(ENCODER.codes(pixels_of_codes(ENCODER, codes)), codes)
