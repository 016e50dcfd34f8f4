"""Bits of a pixel, and the encoder that chooses some of them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

CHANNELS = ("R", "G", "B")
"""Channels of a pixel, in the order of an image's last axis."""

CHANNEL_BITS = 8
"""Bits of a channel; bit 7 is the most significant."""

PIXEL_BITS = len(CHANNELS) * CHANNEL_BITS
"""Bits of a pixel in hardware: red in bits 23…16, green in 15…8, blue in 7…0."""

PIXEL_BIT_NAMES = {
    f"{channel}{bit}": (len(CHANNELS) - 1 - position) * CHANNEL_BITS + bit
    for position, channel in enumerate(CHANNELS)
    for bit in range(CHANNEL_BITS)
}
"""Position in the 24-bit pixel word of every bit of a pixel, by name."""


@dataclass(frozen=True)
class NamedBits:
    """An encoder of single pixels whose code bits go by their names.

    Attributes:
        bits: the names. The first named is code bit 0.
    """

    kind: ClassVar[str]
    bits: tuple[str, ...]

    @property
    def width(self) -> int:
        """Bits of a code."""
        return len(self.bits)

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each code bit."""
        return self.bits

    @property
    def halo(self) -> int:
        """A pixel's code depends on no other pixel."""
        return 0

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `encoder_from_json`."""
        return {"kind": self.kind, "bits": list(self.bits)}


@dataclass(frozen=True)
class BitSelect(NamedBits):
    """Chosen bits of the colour channels: pure wiring, no logic.

    Attributes:
        bits: names such as ``R7``: a channel of `CHANNELS`, then a bit number, 7 the most significant. The
            first named is code bit 0.
    """

    kind: ClassVar[str] = "bits"

    def __post_init__(self) -> None:
        for name in self.bits:
            if name not in PIXEL_BIT_NAMES:
                raise ValueError(
                    f"{name!r} is not a pixel bit; use R, G or B and a number from 0 to 7, as in R7"
                )
        if not self.bits:
            raise ValueError("no bits were chosen; name at least one, as in R7")
        if len(set(self.bits)) != len(self.bits):
            raise ValueError(f"a bit is named twice in {','.join(self.bits)}")

    @property
    def pixel_positions(self) -> tuple[int, ...]:
        """For each code bit, its position in the 24-bit pixel word (see `PIXEL_BITS`)."""
        return tuple(PIXEL_BIT_NAMES[name] for name in self.bits)

    @cached_property
    def _shares(self) -> NDArray[np.uint32]:
        """What each level of each channel adds to a code: uint32 ``[channels, 256]``."""
        levels = np.arange(1 << CHANNEL_BITS, dtype=np.uint32)
        shares = np.zeros((len(CHANNELS), len(levels)), dtype=np.uint32)
        for position, name in enumerate(self.bits):
            shares[CHANNELS.index(name[0])] |= (levels >> int(name[1]) & 1) << position
        return shares

    def codes(self, pixels: ArrayLike) -> NDArray[np.uint32]:
        """Codes of pixels.

        Args:
            pixels: uint8 ``S + (3,)``, channels in the order of `CHANNELS`.

        Returns:
            uint32 ``S``; bit ``i`` is ``bits[i]``.
        """
        array = np.asarray(pixels, dtype=np.uint8)
        # Every code bit comes from one channel, so a code is the OR of three look-ups.
        red, green, blue = self._shares
        codes = np.take(red, array[..., 0])
        codes |= np.take(green, array[..., 1])
        codes |= np.take(blue, array[..., 2])
        return codes


COLOURS = BitSelect(tuple(f"{channel}{bit}" for channel in CHANNELS for bit in (7, 6, 5, 4)))
"""Colours as coarse as the reference design sees them: 4096, by which a model remembers what it was shown."""
