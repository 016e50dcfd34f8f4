"""The pixel word of the hardware, and pictures as the bits of ports.

A pixel is 24 bits: red in 23…16, green in 15…8, blue in 7…0. A window is its pixels row by row, the first in
the lowest bits: pixel ``i`` is ``window[24*i +: 24]``.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.pixel_bits import CHANNELS, PIXEL_BIT_NAMES, PIXEL_BITS
from wnn2hdl.ir.relational import PixelEncoder, Relational, examples
from wnn2hdl.ir.wires import Bits

_DRAWS = 16
"""How often a pixel of a code is drawn before a known one is taken."""


def pixel_bits(pixels: ArrayLike) -> Bits:
    """Pixels as the bits of a port.

    Args:
        pixels: uint8 ``[samples, 3]`` or ``[samples, pixels, 3]``, channels in the order of `CHANNELS`.

    Returns:
        bool ``[samples, 24 * pixels]``.
    """
    array = np.asarray(pixels, dtype=np.uint8)
    channels = np.flip(array, axis=-1).reshape(len(array), math.prod(array.shape[1:]))
    return np.unpackbits(channels, axis=1, bitorder="little").astype(np.bool_)


def bits_to_pixels(bits: Bits) -> NDArray[np.uint8]:
    """The inverse of `pixel_bits`: uint8 ``[samples, pixels, 3]``."""
    packed = np.packbits(bits, axis=1, bitorder="little")
    return packed.reshape(len(bits), packed.shape[1] // len(CHANNELS), len(CHANNELS))[:, :, ::-1]


def pixels_of_codes(
    encoder: PixelEncoder, codes: NDArray[np.int64], rng: np.random.Generator | None = None
) -> NDArray[np.uint8]:
    """Pixels of these codes, uint8 ``S + (3,)`` for codes of shape ``S``.

    Args:
        encoder: the bits that a code is made of.
        codes: codes that occur, see `occurring`.
        rng: draws what the codes leave open; if left out, bits that the encoder does not read are 0, and for
            comparisons it is always the same pixel.
    """
    shape = (*codes.shape, len(CHANNELS))
    pixels = np.zeros(shape, np.uint8) if rng is None else rng.integers(0, 256, size=shape, dtype=np.uint8)
    if isinstance(encoder, Relational):
        return _drawn(encoder, codes, pixels, rng)
    for position, name in enumerate(encoder.bits):
        channel, bit = CHANNELS.index(name[0]), int(name[1])
        pixels[..., channel] &= np.uint8(0xFF ^ 1 << bit)
        pixels[..., channel] |= ((codes >> position & 1) << bit).astype(np.uint8)
    return pixels


def _drawn(
    encoder: Relational,
    codes: NDArray[np.int64],
    pixels: NDArray[np.uint8],
    rng: np.random.Generator | None,
) -> NDArray[np.uint8]:
    """Pixels drawn again and again, and in the end replaced, until they have these codes."""
    if rng is not None:
        for _ in range(_DRAWS):
            wrong = encoder.codes(pixels) != codes
            pixels[wrong] = rng.integers(0, 256, size=(int(wrong.sum()), len(CHANNELS)), dtype=np.uint8)
    found = examples(encoder)
    for place in np.argwhere(encoder.codes(pixels) != codes):
        pixels[tuple(place)] = found[int(codes[tuple(place)])]
    return pixels


def bit_name(position: int) -> str:
    """Name of a bit of the pixel word: ``R7`` for 23."""
    return _NAMES[position]


_NAMES = {position: name for name, position in PIXEL_BIT_NAMES.items()}
assert len(_NAMES) == PIXEL_BITS
