import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import (
    PIXEL_BIT_NAMES,
    PIXEL_BITS,
    BitSelect,
    Encoder,
    Neighbourhood,
    Tap,
    codes_to_bits,
)
from wnn2hdl.ir.encoder import encoder_from_json

selections = st.lists(st.sampled_from(sorted(PIXEL_BIT_NAMES)), min_size=1, unique=True).map(
    lambda names: BitSelect(tuple(names))
)
few_bits = st.lists(st.sampled_from(sorted(PIXEL_BIT_NAMES)), min_size=1, max_size=5, unique=True)


@st.composite
def neighbourhoods(draw: st.DrawFn) -> Neighbourhood:
    size = draw(st.sampled_from([1, 3, 5]))
    places = st.integers(0, size - 1)
    taps = []
    for _ in range(draw(st.integers(1, 4))):
        pixel = BitSelect(tuple(draw(few_bits)))
        contents = draw(st.integers(0, (1 << (1 << pixel.width)) - 1))
        taps.append(Tap(draw(places), draw(places), pixel, contents))
    return Neighbourhood(size, tuple(taps))


pixels = st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=20)


def test_the_first_named_bit_is_code_bit_0() -> None:
    encoder = BitSelect(("R7", "B0"))
    assert encoder.codes(np.array([[128, 0, 0], [0, 0, 1], [127, 255, 254]], dtype=np.uint8)).tolist() == [
        1,
        2,
        0,
    ]
    assert encoder.names == ("R7", "B0")
    assert encoder.pixel_positions == (23, 0)


def test_every_bit_of_the_pixel_word_has_one_name() -> None:
    assert sorted(PIXEL_BIT_NAMES.values()) == list(range(PIXEL_BITS))
    assert (PIXEL_BIT_NAMES["R7"], PIXEL_BIT_NAMES["G0"], PIXEL_BIT_NAMES["B7"]) == (23, 8, 7)


@given(selections, pixels)
def test_codes_are_bits_of_the_24_bit_pixel_word(
    encoder: BitSelect, values: list[tuple[int, int, int]]
) -> None:
    array = np.array(values, dtype=np.uint8)
    words = array.astype(np.int64) @ [1 << 16, 1 << 8, 1]
    wired = codes_to_bits(words, PIXEL_BITS)[:, encoder.pixel_positions]
    assert np.array_equal(codes_to_bits(encoder.codes(array), encoder.width), wired)


def test_an_image_gives_an_image_of_codes() -> None:
    image = np.zeros((4, 5, 3), dtype=np.uint8)
    assert BitSelect(("G7",)).codes(image).shape == (4, 5)


@given(neighbourhoods(), st.integers(0, 2**32 - 1))
def test_a_neighbourhood_asks_each_tap_about_its_own_pixel(encoder: Neighbourhood, seed: int) -> None:
    picture = np.random.default_rng(seed).integers(0, 256, (6, 7, 3), dtype=np.uint8)
    codes = encoder.codes(picture)
    assert codes.shape == (6 - 2 * encoder.halo, 7 - 2 * encoder.halo)
    for row, column in np.ndindex(*codes.shape):
        for bit, tap in enumerate(encoder.taps):
            code = int(tap.pixel.codes(picture[row + tap.row, column + tap.column]))
            assert codes[row, column] >> bit & 1 == tap.contents >> code & 1


def test_a_picture_smaller_than_the_window_has_no_codes() -> None:
    encoder = Neighbourhood(5, (Tap(4, 0, BitSelect(("R7",)), 0b10),))
    assert encoder.codes(np.zeros((4, 9, 3), dtype=np.uint8)).shape == (0, 5)


def test_a_tap_and_its_table_are_one() -> None:
    table = np.array([True, False, False, True])
    tap = Tap.of(0, 0, BitSelect(("R7", "G7")), table)
    assert tap.contents == 0b1001
    assert tap.table.tolist() == table.tolist()


def test_taps_that_no_window_has() -> None:
    pixel = BitSelect(("R7",))
    with pytest.raises(ValueError, match="do not fit 1 bits"):
        Tap(0, 0, pixel, 0b100)
    with pytest.raises(ValueError, match="odd size, not 4"):
        Neighbourhood(4, (Tap(0, 0, pixel, 1),))
    with pytest.raises(ValueError, match="at least one tap"):
        Neighbourhood(3, ())
    with pytest.raises(ValueError, match="row 3, column 0 is outside of 3x3"):
        Neighbourhood(3, (Tap(3, 0, pixel, 1),))


@given(st.one_of(selections, neighbourhoods()))
def test_json_gives_the_encoder_back(encoder: Encoder) -> None:
    assert encoder_from_json(json.loads(json.dumps(encoder.to_json()))) == encoder


@pytest.mark.parametrize(
    ("bits", "message"),
    [(("X9",), "'X9' is not a pixel bit"), ((), "no bits were chosen"), (("R1", "R1"), "named twice")],
)
def test_bits_that_cannot_be_selected(bits: tuple[str, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        BitSelect(bits)


def test_taps_of_one_table_share_it_wherever_they_look() -> None:
    table, other = np.arange(4) == 2, np.arange(4) > 0
    bits = BitSelect(("R7", "G7"))
    places = [(0, 1, table), (1, 1, other), (2, 1, table), (1, 1, table)]
    encoder = Neighbourhood(3, tuple(Tap.of(row, column, bits, answers) for row, column, answers in places))
    assert encoder.tables == encoder.taps[:2]
    assert encoder.sources == (0, 1, 0, 0)
