"""Networks of 6-input tables over the bits of one pixel, learned by gradient, beside the search of `train`.

    python benchmarks/pixel_networks.py IMAGES MASKS [--seed 0]

Five folds by image, as in `benchmarks/light.py`. A network may read the three highest bits of each channel
and thermometers of R/B, R/G and G/B, each threshold of which is the comparison of at most 13 bits that
agrees with it on most training pixels. Wiring and tables are trained by gradient with what a bit costs in
the loss, from the verdicts of the reference that the search aims at. Of networks of several sizes and prices
of a bit it takes the one that agrees with these on most training pixels and maps to so many LUTs at most.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from benchmarks.scenes import scene_parser
from wnn2hdl.dataset import CLASSES, ColourHistogram, colour_histogram, from_masks
from wnn2hdl.ir import CHANNELS, LUT_INPUTS, BitSelect, Comparison, Relational, WisardModel, codes_to_bits
from wnn2hdl.ir.relational import Weighted, pixel_codes
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bitselect import look_up_table
from wnn2hdl.training.budget import pixel_luts
from wnn2hdl.training.comparisons import LOWEST, RATIOS, draw_pixels, select_comparisons
from wnn2hdl.training.crossval import EXPOSURES, shares_right
from wnn2hdl.training.gradient.layer import VotingLayer
from wnn2hdl.training.gradient.samples import Samples
from wnn2hdl.training.gradient.training import Recipe, Training

BUDGETS = (10, 20, 30)
PAIRS = (("R", "B"), ("R", "G"), ("G", "B"))
LEVELS = 15
"""Thresholds of each ratio, at its quantiles."""

NODES = (1, 2, 4)
"""Tables that vote for one class."""

PRICES = (1.0, 4.0, 16.0, 64.0)
EPOCHS = 10
EVERY = 4
"""One of so many training pixels is used: more changed nothing."""

COMPARED = 13
"""Bits of a comparison, at most."""

MOST_BITS = 10
"""Bits that a network reads at most; those that read more take more LUTs than any of `BUDGETS`."""


Bits = tuple[str, ...]
"""Names of bits, see `wnn2hdl.ir.Relational`."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A trained network as a table over the bits that it reads.

    Attributes:
        model: the table.
        luts: what it maps to.
        right: share of the training pixels on which it agrees with the reference.
    """

    model: WisardModel
    luts: int
    right: float


def main() -> None:
    """Print the table."""
    given = scene_parser(__doc__).parse_args()
    images = [colour_histogram(image, len(CLASSES)) for image in from_masks(given.images, given.masks)]
    networks = lru_cache(lambda chosen: candidates([images[i] for i in chosen], given.seed))
    columns = [*(f"x{exposure:g}" for exposure in EXPOSURES), "worst", "LUTs per pixel in the folds"]
    print(head(["classifier", *columns]))
    for budget in BUDGETS:
        for name in ("comparisons by search", "network by gradient"):
            found: list[WisardModel] = []

            def train(chosen: Sequence[int], name: str = name, budget: int = budget) -> WisardModel:
                if name == "network by gradient":
                    model = most_accurate(networks(tuple(chosen)), budget)
                else:
                    model = select_comparisons(
                        [images[i] for i in chosen], CLASSES, luts=budget, seed=given.seed, smooth=True
                    )
                found.append(model)  # noqa: B023  # is read before the next round
                return model

            shares = shares_right(images, train)
            means = [f"{mean:.4f}" for mean in shares.mean(axis=0)]
            needed = ", ".join(str(pixel_luts(model)) for model in found)
            print(row([f"{name}, {budget} LUTs", *means, f"{shares.min():.3f}", needed]), flush=True)


def candidates(images: Sequence[ColourHistogram], seed: int) -> list[Candidate]:
    """Networks of all `NODES` and `PRICES` that read `MOST_BITS` bits at most."""
    training = draw_pixels(images, np.random.default_rng(seed), smooth=True)
    pixels, verdicts = training.pixels[::EVERY], (training.sign[::EVERY] > 0).astype(np.int64)
    names = (*(f"{channel}{bit}" for channel in CHANNELS for bit in (7, 6, 5)), *thermometers(pixels))
    rows = np.stack([pixel_codes((name,), pixels) for name in names]).astype(np.uint8)
    luts = np.array([least_luts(name) for name in names], dtype=np.float32)
    found = []
    for nodes, price in product(NODES, PRICES):
        recipe = Recipe(EPOCHS, bit_price=price, seed=seed)
        process = Training(recipe, Samples([rows], verdicts, seed), luts, len(CLASSES), nodes)
        while not process.finished:
            if process.wiring and process.epoch >= recipe.wiring_epochs:
                process.freeze(process.layer)
            process.run_epoch()
        layer = process.layer
        if len(np.unique(layer.mapping)) <= MOST_BITS:
            model = tabulated(layer, names)
            right = float((layer.predict(rows) == verdicts).mean())
            found.append(Candidate(model, pixel_luts(model), right))
    return found


def thermometers(
    pixels: NDArray[np.uint8], pairs: Sequence[tuple[str, str]] = PAIRS, levels: int = LEVELS
) -> Bits:
    """Comparisons that stand for thresholds of ratios of channels, ``levels`` of each pair."""
    found: dict[str, None] = {}
    share = (np.arange(levels) + 1) / (levels + 1)
    for one, other in pairs:
        level = pixels[:, [CHANNELS.index(one), CHANNELS.index(other)]] + 0.5
        ratio = level[:, 0] / level[:, 1]
        above = ratio >= np.quantile(ratio, share)[:, np.newaxis]
        best = np.zeros(levels)
        names = [""] * levels
        for weights, lows in product({pair[::step] for pair in RATIOS for step in (1, -1)}, LOWEST):
            left, right = (
                Weighted(channel, weight << low, low)
                for channel, weight, low in zip((one, other), weights, lows, strict=True)
            )
            shape = Comparison((left,), (right,))
            if len(shape.bits) > COMPARED:
                continue
            slack = shape.slack(pixels)
            # With an offset at the same quantile, the comparison is as often true as the threshold.
            for place, offset in enumerate(np.quantile(slack, share).astype(np.int64)):
                agreed = float(((slack >= offset) == above[place]).mean())
                if agreed > best[place]:
                    best[place], names[place] = agreed, str(Comparison((left,), (right,), int(offset)))
        found |= dict.fromkeys(names)
    return tuple(found)


def least_luts(name: str) -> int:
    """LUTs that a bit takes at least: none for a bit as it is."""
    if ">=" not in name:
        return 0
    return -(-(len(Comparison.parse(name).bits) - 1) // (LUT_INPUTS - 1))


def tabulated(layer: VotingLayer, names: Bits) -> WisardModel:
    """A network as a table over the bits that it reads."""
    read = np.unique(layer.mapping)
    codes = codes_to_bits(np.arange(1 << len(read)), len(read)).T.astype(np.uint8)
    answers = VotingLayer(np.searchsorted(read, layer.mapping), layer.weights, layer.classes).predict(codes)
    kept = tuple(names[place] for place in read)
    compares = any(">=" in name for name in kept)
    return look_up_table(Relational(kept) if compares else BitSelect(kept), CLASSES, answers, {})


def most_accurate(networks: Sequence[Candidate], budget: int) -> WisardModel:
    """The network of at most so many LUTs that agrees best with the reference."""
    return max((one for one in networks if one.luts <= budget), key=lambda one: one.right).model


if __name__ == "__main__":
    main()
