"""Stimulus: every cared-for input where these are few, and directed and random windows for the block.

Bits of a pixel that the model does not read are random throughout.
"""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import (
    CHANNELS,
    WINDOW_BITS,
    WINDOW_CODES,
    BitSelect,
    Context,
    Neighbourhood,
    PixelEncoder,
    Tap,
    WisardModel,
    bits_to_codes,
    codes_to_bits,
)
from wnn2hdl.ir.pixels import pixel_bits, pixels_of_codes
from wnn2hdl.ir.relational import Relational, occurring
from wnn2hdl.ir.wires import Bits

BLOCK_WINDOWS = 10_240
"""Windows that a block or a neighbourhood is simulated on: every cared-for code of it several times."""

COMPARED_PIXELS = 4096
"""Pixels that a classifier which compares channels is simulated on, at least."""

_SEED = 0


def pixel(encoder: PixelEncoder, care: NDArray[np.bool_]) -> dict[str, Bits]:
    """A pixel of every cared-for code; several where comparisons make codes that are few."""
    codes = np.flatnonzero(care & occurring(encoder))
    if isinstance(encoder, Relational):
        codes = np.resize(codes, max(len(codes), COMPARED_PIXELS))
    return {"rgb": pixel_bits(pixels_of_codes(encoder, codes, np.random.default_rng(_SEED)))}


def edge(care: NDArray[np.bool_]) -> dict[str, Bits]:
    """Every cared-for binary window."""
    return {"bits": codes_to_bits(np.flatnonzero(care), WINDOW_BITS)}


def match() -> dict[str, Bits]:
    """All 2**18 pairs of binary windows."""
    bits, reference = np.divmod(np.arange(WINDOW_CODES**2), WINDOW_CODES)
    return {
        "bits": codes_to_bits(bits, WINDOW_BITS),
        "reference_bits": codes_to_bits(reference, WINDOW_BITS),
    }


def block(
    model: WisardModel, encoder: PixelEncoder, pixel_care: NDArray[np.bool_], window_care: NDArray[np.bool_]
) -> dict[str, Bits]:
    """`BLOCK_WINDOWS` windows: each cared-for binary window in turn, made of random pixels of its classes.

    Args:
        model: gives the class of a pixel.
        encoder: of the model.
        pixel_care: bool ``[2**encoder.width]``.
        window_care: bool ``[512]``.
    """
    rng = np.random.default_rng(_SEED)
    codes = np.flatnonzero(pixel_care & occurring(encoder))
    foreground = model.evaluate(codes_to_bits(codes, encoder.width)) != 0
    pools = {True: codes[foreground], False: codes[~foreground]}
    if not all(map(len, pools.values())):
        # Only one class occurs: there is one binary window, whatever the care set of windows says.
        chosen = codes[rng.integers(len(codes), size=(BLOCK_WINDOWS, WINDOW_BITS))]
    else:
        wanted = codes_to_bits(np.resize(np.flatnonzero(window_care), BLOCK_WINDOWS), WINDOW_BITS)
        draws = {kind: pool[rng.integers(len(pool), size=wanted.shape)] for kind, pool in pools.items()}
        chosen = np.where(wanted, draws[True], draws[False])
    return {"window": pixel_bits(pixels_of_codes(encoder, chosen, rng))}


def with_references(window: dict[str, Bits], bits: Bits) -> dict[str, Bits]:
    """Windows with ``reference_bits`` that equal their bits, differ in one, complement them, or are random.

    Args:
        window: the windows.
        bits: the model's answer for each of their pixels, bool ``[samples, 9]``.
    """
    rng = np.random.default_rng(_SEED)
    count = len(bits)
    flips = np.select(
        [np.arange(count) % 4 == kind for kind in range(3)],
        [
            np.zeros(count, dtype=np.int64),
            1 << rng.integers(WINDOW_BITS, size=count),
            np.full(count, WINDOW_CODES - 1),
        ],
        rng.integers(WINDOW_CODES, size=count),
    )
    return window | {"reference_bits": bits ^ codes_to_bits(flips, WINDOW_BITS)}


def neighbourhood(encoder: Neighbourhood, care: NDArray[np.bool_]) -> dict[str, Bits]:
    """`BLOCK_WINDOWS` windows whose codes are the cared-for ones in turn, where a window can have them."""
    rng = np.random.default_rng(_SEED)
    taps: dict[int, list[int]] = {}
    for position, tap in enumerate(encoder.taps):
        taps.setdefault(encoder.size * tap.row + tap.column, []).append(position)
    pools = {place: _pools([encoder.taps[position] for position in taps[place]]) for place in taps}
    cared = codes_to_bits(np.flatnonzero(care), encoder.width)
    possible = np.ones(len(cared), dtype=np.bool_)
    for place, positions in taps.items():
        possible &= np.isin(bits_to_codes(cared[:, positions]), list(pools[place][1]))
    wanted = np.resize(cared[possible], (BLOCK_WINDOWS, encoder.width))
    shape = (len(wanted), encoder.size**2, len(CHANNELS))
    windows = rng.integers(0, 256, size=shape, dtype=np.uint8)
    for place, positions in taps.items():
        bits, codes = pools[place]
        answers = bits_to_codes(wanted[:, positions])
        for answer, pool in codes.items():
            chosen = np.flatnonzero(answers == answer)
            drawn = pool[rng.integers(len(pool), size=len(chosen))]
            windows[chosen, place] = pixels_of_codes(bits, drawn, rng)
    return {"window": pixel_bits(windows)}


def taps(encoder: Neighbourhood) -> dict[str, Bits]:
    """A pixel of every code of every table of a neighbourhood."""
    rng = np.random.default_rng(_SEED)
    pixels = [pixels_of_codes(tap.pixel, np.arange(1 << tap.pixel.width), rng) for tap in encoder.tables]
    return {"rgb": pixel_bits(np.concatenate(pixels))}


def pixels() -> dict[str, Bits]:
    """`BLOCK_WINDOWS` pixels, a half of them of nearly equal channels."""
    rng = np.random.default_rng(_SEED)
    drawn = rng.integers(0, 256, size=(BLOCK_WINDOWS, len(CHANNELS)))
    near = drawn[:, :1] + rng.integers(-16, 17, size=drawn.shape)
    half = np.arange(BLOCK_WINDOWS)[:, np.newaxis] % 2 > 0
    return {"rgb": pixel_bits(np.where(half, np.clip(near, 0, 255), drawn).astype(np.uint8))}


def counts(encoder: Context) -> dict[str, Bits]:
    """`BLOCK_WINDOWS` counts, a half of them at thresholds or one below."""
    rng = np.random.default_rng(_SEED)
    words = []
    for sum_of, width in zip(encoder.sums, encoder.widths, strict=True):
        least = [count.least for count in encoder.counts if (count.plane, count.size) == sum_of]
        near = rng.choice(least, BLOCK_WINDOWS) - rng.integers(2, size=BLOCK_WINDOWS)
        anywhere = rng.integers(sum_of[1] ** 2 + 1, size=BLOCK_WINDOWS)
        words.append(codes_to_bits(np.where(rng.random(BLOCK_WINDOWS) < 1 / 2, near, anywhere), width))
    return {"counts": np.concatenate(words, axis=1)}


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
