"""Pixels as the bits of ports."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from wnn2hdl.ir import BitSelect, codes_to_bits
from wnn2hdl.ir.pixels import bit_name, bits_to_pixels, pixel_bits, pixels_of_codes
from wnn2hdl.ir.wires import word_values


def test_red_is_in_the_highest_bits_of_a_pixel() -> None:
    pixels = [[255, 0, 0], [0, 1, 0], [0, 0, 128], [128, 255, 254]]
    assert word_values(pixel_bits(pixels)) == [0xFF0000, 0x000100, 0x000080, 0x80FFFE]
    assert [bit_name(position) for position in (23, 15, 7, 0)] == ["R7", "G7", "B7", "B0"]


def test_the_first_pixel_of_a_window_is_in_the_lowest_bits() -> None:
    window = np.zeros((1, 9, 3), dtype=np.uint8)
    window[0, 1, 2] = 1
    window[0, 8, 0] = 128
    assert np.flatnonzero(pixel_bits(window)).tolist() == [24, 215]


@given(arrays(np.uint8, st.tuples(st.integers(0, 4), st.integers(1, 9), st.just(3))))
def test_pixels_read_back_as_they_were(pixels: np.ndarray) -> None:
    assert np.array_equal(bits_to_pixels(pixel_bits(pixels)), pixels)


@given(st.permutations(["R7", "R0", "G3", "B7", "B1"]), st.integers(0, 5), st.booleans())
def test_pixels_of_codes_have_these_codes(names: list[str], seed: int, random: bool) -> None:
    encoder = BitSelect(tuple(names))
    codes = np.arange(32).reshape(4, 8)
    pixels = pixels_of_codes(encoder, codes, np.random.default_rng(seed) if random else None)
    assert pixels.shape == (4, 8, 3)
    assert np.array_equal(encoder.codes(pixels), codes)
    word = pixel_bits(pixels.reshape(-1, 3))
    assert np.array_equal(word[:, encoder.pixel_positions], codes_to_bits(codes.reshape(-1), 5))
    if not random:
        assert pixels[0, 0].tolist() == [0, 0, 0]
