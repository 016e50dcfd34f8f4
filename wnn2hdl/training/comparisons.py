"""Comparisons of channels, and bits, that classify best within a few LUTs whatever the light.

Candidates are comparisons of two channels with small weights and few bits, and the channels' highest bits.
They are added one by one: of all comparisons and offsets that the LUTs pay for, the one with which a table
over what was chosen is right most often, on training pixels under varied light. What is right are the labels,
or what a smooth classifier of any cost makes of them, which says more of other images where ratios tell the
classes apart. What a comparison costs is what it is mapped to.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from itertools import combinations, product
from math import gcd

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import (
    CHANNELS,
    LUT_INPUTS,
    PIXEL_BIT_NAMES,
    Comparison,
    Relational,
    TruthTable,
    WisardModel,
)
from wnn2hdl.ir.relational import Weighted, pixel_codes
from wnn2hdl.minimise import map_luts
from wnn2hdl.training.bitselect import Histogram, look_up_table
from wnn2hdl.training.bitselect.drift import unpacked
from wnn2hdl.training.bitselect.reference import fit_ratio_reference
from wnn2hdl.training.light import varied
from wnn2hdl.wisard import require_every_class

FEWEST_LUTS = 4
"""A comparison that follows a ratio takes about as many."""

PIXELS = 1000
"""Training pixels drawn from each image; more changed nothing."""

COPIES = 4
"""How often each is seen, each time under other light."""

RATIOS = ((1, 1), (2, 1), (3, 1), (3, 2), (4, 3), (5, 3), (5, 4), (8, 5), (8, 7))
"""Weights of two channels that are compared, either way round."""

LOWEST = ((0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2), (2, 3), (1, 3), (3, 3))
"""Lowest bits of two channels that are compared."""

HIGHEST = (7, 6)
"""Highest bits of two channels that are compared; with 6, the table reads bit 7 of each by itself, so that
bright pixels do not count as dark ones."""

MOST_BITS = 13
"""Bits that a comparison reads: up to here it takes 4 to 6 LUTs, with one bit more 9."""

LEAST_GAIN = 1e-4
"""Share of the training pixels that another comparison is expected to put right."""

PRIOR = 1e-6
"""Weight of all colours together over that of the training pixels: on codes that these do not have, the table
answers as the first comparison does when it reads all bits."""

_TRIES = 8
"""Additions that are mapped for each that is chosen, the best ones first."""


@dataclass(frozen=True, eq=False)
class LitPixels:
    """Training pixels under varied light.

    Attributes:
        pixels: uint8 ``[n, 3]``.
        sign: by how much the second class is more probable than the first, -1 to 1, ``[n]``; a label is sure.
    """

    pixels: NDArray[np.uint8]
    sign: NDArray[np.float64]


@dataclass(frozen=True)
class _Addition:
    """Bits that may be added, a comparison the last, and the share of pixels that one expects to be right."""

    right: float
    names: tuple[str, ...]


def select_comparisons(
    images: Sequence[Histogram], classes: tuple[str, ...], *, luts: int, seed: int, smooth: bool
) -> WisardModel:
    """Choose comparisons and bits, and a table over them, that together map to at most ``luts`` LUTs.

    Args:
        images: each training image's colours; all of them weigh the same.
        classes: two class names, the background first.
        luts: at least `FEWEST_LUTS`.
        seed: of the pixels that are drawn and their light.
        smooth: agree with `fit_ratio_reference`, not with the labels.

    Returns:
        A model of one RAM per class that reads every chosen bit (see `look_up_table`).

    Raises:
        InputError: not two classes, too few LUTs, or a class without pixels.
    """
    if len(classes) != 2 or luts < FEWEST_LUTS:
        raise InputError(
            f"comparisons separate two classes and take {FEWEST_LUTS} LUTs or more",
            value=f"{len(classes)} classes, {luts} LUTs",
            hint="train another classifier",
        )
    require_every_class(classes, (any(image.counts[i].any() for image in images) for i in (0, 1)))
    training = draw_pixels(images, np.random.default_rng(seed), smooth=smooth)
    chosen: tuple[str, ...] = ()
    right = 0.0
    while found := _affordable(training, chosen, luts):
        if chosen and found.right < right + LEAST_GAIN:
            break
        chosen, right = chosen + found.names, found.right
    record = {"method": "comparisons", "luts": luts, "smooth": smooth, "seed": seed, "images": len(images)}
    return look_up_table(Relational(chosen), classes, _answers(training, chosen), record)


def draw_pixels(images: Sequence[Histogram], rng: np.random.Generator, *, smooth: bool) -> LitPixels:
    """`PIXELS` of each image of two classes, `COPIES` times each; ``smooth`` as in `select_comparisons`."""
    pixels, labels = [], []
    for image in images:
        counts = image.counts.ravel()
        drawn = rng.choice(len(counts), PIXELS, p=counts / counts.sum())
        colours = unpacked(image.colours.astype(np.int64)).astype(np.uint8)[drawn % len(image.colours)]
        pixels += [varied(colours, rng) for _ in range(COPIES)]
        labels += [(drawn >= len(image.colours)).astype(np.int64)] * COPIES
    lit, owners = np.concatenate(pixels), np.concatenate(labels)
    # So rare a class that none of its pixels was drawn leaves nothing to fit.
    if smooth and owners.any() and not owners.all():
        return LitPixels(lit, 2 * fit_ratio_reference(lit, owners)(lit) - 1)
    return LitPixels(lit, np.where(owners == 1, 1.0, -1.0))


def _affordable(training: LitPixels, chosen: tuple[str, ...], luts: int) -> _Addition | None:
    """The best addition that the LUTs pay for; None if none of the best few can be paid for."""
    codes: dict[tuple[str, ...], NDArray[np.int64]] = {}
    additions = []
    for shape in _shapes():
        above = tuple(
            bit
            for term in shape.left + shape.right
            for bit in [f"{term.channel}7"]
            if term.high < 7 and bit not in chosen
        )
        width = len(chosen) + len(above) + 1
        if width > LUT_INPUTS or _least_cost(shape) + (width > 1) > luts:
            continue
        if above not in codes:
            codes[above] = pixel_codes(chosen + above, training.pixels).astype(np.int64)
        additions.append(_best_offset(training, codes[above], shape, above))
    ranked = sorted(additions, key=lambda addition: -addition.right)
    # A threshold of one channel is cheap enough for any budget.
    thresholds = [addition for addition in ranked if _is_threshold(addition.names[-1])]
    tries = [*ranked[:_TRIES], *thresholds]
    return next((addition for addition in tries if _luts(chosen + addition.names) <= luts), None)


@cache
def _shapes() -> tuple[Comparison, ...]:
    """Comparisons without their offsets."""
    found = dict.fromkeys(Comparison((Weighted(channel),)) for channel in CHANNELS)
    for (one, other), ratio, lows, high in product(combinations(CHANNELS, 2), RATIOS, LOWEST, HIGHEST):
        for weights in (ratio, ratio[::-1]):
            left, right = (weight << low for weight, low in zip(weights, lows, strict=True))
            shared = gcd(left, right)
            comparison = Comparison(
                (Weighted(one, left // shared, lows[0], high),),
                (Weighted(other, right // shared, lows[1], high),),
            )
            if len(comparison.bits) <= MOST_BITS:
                found[comparison] = None
    return tuple(found)


def _best_offset(
    training: LitPixels, code: NDArray[np.int64], shape: Comparison, above: tuple[str, ...]
) -> _Addition:
    """The offset with which a comparison helps most beside what the code holds."""
    slack = shape.slack(training.pixels)
    lowest, codes = int(slack.min()), int(code.max()) + 1
    levels = int(slack.max()) - lowest + 1
    masses = np.bincount(code * levels + (slack - lowest), training.sign, codes * levels)
    below = masses.reshape(codes, levels).cumsum(axis=1)
    scores = (np.abs(below) + np.abs(below[:, -1:] - below)).sum(axis=0)
    best = int(scores.argmax())
    name = str(Comparison(shape.left, shape.right, lowest + best + 1))
    return _Addition(float((1 + scores[best] / len(code)) / 2), (*above, name))


def _answers(training: LitPixels, names: tuple[str, ...]) -> NDArray[np.int64]:
    """The class of each code: int64 ``[2**len(names)]``."""
    size = 1 << len(names)
    masses = np.bincount(pixel_codes(names, training.pixels), training.sign, size)
    levels = np.arange(2, 256, 4, dtype=np.uint8)
    colours = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    first = next(Comparison.parse(name) for name in names if name not in PIXEL_BIT_NAMES)
    left, right = (tuple(replace(term, high=7) for term in side) for side in (first.left, first.right))
    whole = Comparison(left, right, first.offset)
    with_first = np.bincount(first.evaluate(training.pixels), training.sign, 2)
    sign = np.where(whole.evaluate(colours), 1.0, -1.0)
    sign *= np.sign(with_first[1] - with_first[0])
    prior = np.bincount(pixel_codes(names, colours), sign, size) / len(colours)
    return np.asarray(masses + PRIOR * len(training.sign) * prior > 0).astype(np.int64)


def _is_threshold(name: str) -> bool:
    return not Comparison.parse(name).right


def _least_cost(comparison: Comparison) -> int:
    """LUTs that a function of so many bits takes at least."""
    return -(-(len(comparison.bits) - 1) // (LUT_INPUTS - 1))


def _luts(names: tuple[str, ...]) -> int:
    """LUTs of comparisons, and of a table over them and bits; one bit alone needs no table."""
    return sum(_cost(name) for name in names if name not in PIXEL_BIT_NAMES) + (len(names) > 1)


@lru_cache(maxsize=1024)
def _cost(name: str) -> int:
    """LUTs of a comparison, at most: more effort may find fewer."""
    comparison = Comparison.parse(name)
    table = TruthTable.exact(comparison.bits, ("o",), comparison.table()[:, np.newaxis])
    return len(map_luts(table, effort=0).network.luts)
