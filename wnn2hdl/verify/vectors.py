"""Stimulus: every cared-for input where these are few, and directed and random windows for the block."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import CHANNELS, WINDOW_BITS, WINDOW_CODES, codes_to_bits
from wnn2hdl.verify.specification import PartName, Samples, Specification

BLOCK_WINDOWS = 10_240
"""Windows that a block is simulated on: every cared-for binary window at least 20 times."""


def stimulus(specification: Specification, part: PartName, seed: int = 0) -> Samples:
    """Inputs on which a circuit is checked by simulation; all of them are cared for.

    A pixel classifier gets every cared-for code, an edge filter every cared-for window, a matcher all 2**18
    pairs of windows. A block gets `BLOCK_WINDOWS` windows: each cared-for binary window equally often, made
    of random pixels of the classes it asks for; with a matcher, against a reference that is equal to it,
    differs in one bit, is its complement, or is random. Bits of a pixel that the model does not read are
    random throughout.

    Args:
        specification: the model and its care sets.
        part: the circuit.
        seed: of what is random.
    """
    rng = np.random.default_rng(seed)
    if part == "pixel":
        return {"rgb": _pixels(specification, np.flatnonzero(specification.pixel_care), rng)}
    cared = np.flatnonzero(specification.window_care)
    if part == "edge":
        return {"bits": cared}
    if part == "match":
        bits, reference = np.divmod(np.arange(WINDOW_CODES**2), WINDOW_CODES)
        return {"bits": bits, "reference": reference}
    window = _windows(specification, cared, rng)
    if part == "block":
        return {"window": window}
    bits = specification.evaluate("block", {"window": window})["bits"]
    flips = np.select(
        [np.arange(len(window)) % 4 == kind for kind in range(3)],
        [
            np.zeros(len(window), dtype=np.int64),
            1 << rng.integers(WINDOW_BITS, size=len(window)),
            np.full(len(window), WINDOW_CODES - 1),
        ],
        rng.integers(WINDOW_CODES, size=len(window)),
    )
    return {"window": window, "reference": bits ^ flips}


def _windows(
    specification: Specification, cared: NDArray[np.int64], rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Pixels, uint8 ``[windows, 9, 3]``, whose classes make each cared-for binary window in turn."""
    codes = np.flatnonzero(specification.pixel_care)
    foreground = specification.model.evaluate(codes_to_bits(codes, specification.encoder.width)) != 0
    pools = {True: codes[foreground], False: codes[~foreground]}
    if not all(map(len, pools.values())):
        # Only one class occurs: there is one binary window, whatever the care set of windows says.
        chosen = codes[rng.integers(len(codes), size=(BLOCK_WINDOWS, WINDOW_BITS))]
    else:
        wanted = codes_to_bits(np.resize(cared, BLOCK_WINDOWS), WINDOW_BITS)
        draws = {kind: pool[rng.integers(len(pool), size=wanted.shape)] for kind, pool in pools.items()}
        chosen = np.where(wanted, draws[True], draws[False])
    return _pixels(specification, chosen, rng)


def _pixels(
    specification: Specification, codes: NDArray[np.int64], rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Pixels of these codes, uint8 ``S + (3,)``; bits that the encoder does not read are random."""
    encoder = specification.encoder
    pixels = rng.integers(0, 256, size=(*codes.shape, len(CHANNELS)), dtype=np.uint8)
    for position, name in enumerate(encoder.bits):
        channel, bit = CHANNELS.index(name[0]), int(name[1])
        pixels[..., channel] &= np.uint8(0xFF ^ 1 << bit)
        pixels[..., channel] |= ((codes >> position & 1) << bit).astype(np.uint8)
    return pixels
