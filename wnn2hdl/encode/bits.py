"""Choosing the pixel bits that a network reads."""

from wnn2hdl.errors import InputError
from wnn2hdl.ir import CHANNELS, PIXEL_BIT_NAMES, BitSelect
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS


def parse_bits(text: str) -> BitSelect:
    """The encoder of a list of pixel bits such as ``R6,R5,B3``; the first named is code bit 0.

    Raises:
        InputError: an unknown name, one named twice, or none at all.
    """
    names = tuple(part.strip() for part in text.split(","))
    for name in names:
        if name not in PIXEL_BIT_NAMES:
            raise InputError(
                "no such pixel bit",
                value=repr(name),
                hint="use R, G or B and a number from 0 to 7 (7 is the highest), as in R7,G7,B7",
            )
    if len(set(names)) != len(names):
        raise InputError("a pixel bit is named twice", value=text, hint="name each bit once")
    return BitSelect(names)


def high_bits(per_channel: int = 4) -> BitSelect:
    """The highest bits of each channel; 4 of each is the reference design's 12-bit pixel.

    The order is R7, R6, …, then G7, …, then B7, …: code bit 0 is R7.

    Raises:
        InputError: fewer than 1 or more than 8 bits per channel.
    """
    if not 1 <= per_channel <= CHANNEL_BITS:
        raise InputError(
            "a channel does not have this number of bits", value=per_channel, hint="choose 1 to 8"
        )
    tops = range(CHANNEL_BITS - 1, CHANNEL_BITS - 1 - per_channel, -1)
    return BitSelect(tuple(f"{channel}{bit}" for channel in CHANNELS for bit in tops))
