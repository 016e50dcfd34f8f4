"""Stimulus: every cared-for input where these are few, and directed and random windows for the block."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import CHANNELS, WINDOW_BITS, WINDOW_CODES, BitSelect, Tap, bits_to_codes, codes_to_bits
from wnn2hdl.verify.specification import (
    AnySpecification,
    NeighbourhoodSpecification,
    PartName,
    Samples,
    Specification,
)

BLOCK_WINDOWS = 10_240
"""Windows that a block or a neighbourhood is simulated on: every cared-for code of it several times."""


def stimulus(specification: AnySpecification, part: PartName, seed: int = 0) -> Samples:
    """Inputs on which a circuit is checked by simulation; all of them are cared for.

    A pixel classifier gets every cared-for code, an edge filter every cared-for window, a matcher all 2**18
    pairs of windows. A block gets `BLOCK_WINDOWS` windows: each cared-for binary window equally often, made
    of random pixels of the classes it asks for; with a matcher, against a reference that is equal to it,
    differs in one bit, is its complement, or is random. A neighbourhood gets as many windows, each cared-for
    code equally often, if a window can have it. Bits of a pixel that the model does not read are random
    throughout.

    Args:
        specification: the model and its care sets.
        part: the circuit.
        seed: of what is random.
    """
    rng = np.random.default_rng(seed)
    if isinstance(specification, NeighbourhoodSpecification):
        return {"window": _neighbourhoods(specification, rng)}
    if part == "pixel":
        return {"rgb": _pixels(specification.encoder, np.flatnonzero(specification.pixel_care), rng)}
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


def _neighbourhoods(specification: NeighbourhoodSpecification, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Windows, uint8 ``[windows, size * size, 3]``, whose codes are the cared-for ones in turn."""
    encoder = specification.encoder
    taps: dict[int, list[int]] = {}
    for position, tap in enumerate(encoder.taps):
        taps.setdefault(encoder.size * tap.row + tap.column, []).append(position)
    pools = {place: _pools([encoder.taps[position] for position in taps[place]]) for place in taps}
    cared = codes_to_bits(np.flatnonzero(specification.care), encoder.width)
    possible = np.ones(len(cared), dtype=np.bool_)
    for place, positions in taps.items():
        possible &= np.isin(bits_to_codes(cared[:, positions]), list(pools[place][1]))
    wanted = np.resize(cared[possible], (BLOCK_WINDOWS, encoder.width))
    shape = (len(wanted), encoder.size**2, len(CHANNELS))
    windows = rng.integers(0, 256, size=shape, dtype=np.uint8)
    for place, positions in taps.items():
        pixel, codes = pools[place]
        answers = bits_to_codes(wanted[:, positions])
        for answer, pool in codes.items():
            chosen = np.flatnonzero(answers == answer)
            drawn = pool[rng.integers(len(pool), size=len(chosen))]
            windows[chosen, place] = _pixels(pixel, drawn, rng)
    return windows


def _pools(taps: list[Tap]) -> tuple[BitSelect, dict[int, NDArray[np.int64]]]:
    """The bits that the taps of one pixel read, and the codes that give each of their joint answers."""
    pixel = BitSelect(tuple(dict.fromkeys(name for tap in taps for name in tap.pixel.bits)))
    codes = np.arange(1 << pixel.width)
    bits = codes_to_bits(codes, pixel.width)
    columns = [
        tap.table[bits_to_codes(bits[:, [pixel.bits.index(name) for name in tap.pixel.bits]])] for tap in taps
    ]
    answers = bits_to_codes(np.stack(columns, axis=1))
    return pixel, {int(answer): codes[answers == answer] for answer in np.unique(answers)}


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
    return _pixels(specification.encoder, chosen, rng)


def _pixels(encoder: BitSelect, codes: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.uint8]:
    """Pixels of these codes, uint8 ``S + (3,)``; bits that the encoder does not read are random."""
    pixels = rng.integers(0, 256, size=(*codes.shape, len(CHANNELS)), dtype=np.uint8)
    for position, name in enumerate(encoder.bits):
        channel, bit = CHANNELS.index(name[0]), int(name[1])
        pixels[..., channel] &= np.uint8(0xFF ^ 1 << bit)
        pixels[..., channel] |= ((codes >> position & 1) << bit).astype(np.uint8)
    return pixels
