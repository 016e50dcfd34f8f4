"""Training of classifiers that count in the squares around a pixel which pixels have a bit set.

A classifier reads two bits of the pixel and two sums over squares, each with three thresholds. All bits are
ratios of channels, in which light cancels. They are chosen one after the other: of all ratios the one with
which a logistic regression on the bits is right most often on images that it was not fitted on. The table is
the regression's answer for each code: counted majorities follow single images more closely, and were less
accurate on others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.ir import CHANNELS, Comparison, Context, WisardModel, all_codes, codes_to_bits
from wnn2hdl.ir.context import SIZES, Count, box_sums
from wnn2hdl.ir.relational import Weighted
from wnn2hdl.progress import Progress, reported
from wnn2hdl.training.bitselect import look_up_table
from wnn2hdl.training.budget import LIGHT, NESTED
from wnn2hdl.training.crossval import pictures_cross_validated
from wnn2hdl.training.folds import fold_count
from wnn2hdl.training.light import varied
from wnn2hdl.training.promise import light_figures
from wnn2hdl.wisard import require_every_class, require_two_classes

RATIOS = ((1, 1), (5, 4), (4, 3), (3, 2), (7, 4), (2, 1))
"""Weights of two channels that are compared, either way round; more of them were chosen from less well."""

LOWEST = 1
"""The lowest bit of a channel that is compared: a ratio takes 4 to 13 LUTs, with all bits 6 to 21."""

SHARES = (0.25, 0.5, 0.75)
"""Thresholds of a sum, as shares of the square; five were no more accurate than these three."""

COPIES = 4
"""How often each image is seen, each time under other light and in another place."""

PIXELS = 1000
"""Pixels drawn from each copy."""

TILE = 256
"""Rows and columns of a copy, beyond the reach of the squares."""

RIDGE = 1.0
"""Strength of the regression's penalty, for weights of one for each training pixel."""

_STEPS = 8
"""Newton steps of the regression."""


@dataclass(frozen=True, eq=False)
class _Samples:
    """Training pixels of one image.

    Attributes:
        own: bool ``[planes, n]``, the pixel's own bit of each of `_planes`.
        sums: uint16 ``[planes, n]``, how many pixels of the square have it set.
        labels: uint8 ``[n]``.
    """

    own: NDArray[np.bool_]
    sums: NDArray[np.uint16]
    labels: NDArray[np.uint8]


def train_context(dataset: Dataset, size: int, *, seed: int, progress: Progress) -> WisardModel:
    """The classifier that reads two bits of a pixel and two sums over the square around it by one table.

    What it promises is nested: the whole choice is made once more inside each fold, for the images outside.

    Args:
        dataset: whole images, three at least; one is in memory at a time.
        size: rows and columns of the square, of `wnn2hdl.ir.context.SIZES`.
        seed: of the pixels that are drawn and their light.
        progress: called with each image read, and with each fold.

    Raises:
        InputError: an image cannot be read, is smaller than a square or labelled in part only, a class has no
            pixel, there are not two classes or fewer than three images, or no such size.
    """
    if size not in SIZES:
        raise InputError(
            "there is no such context", value=size, hint=f"choose one of {', '.join(map(str, SIZES))}"
        )
    require_two_classes(dataset.classes, "context")
    if len(dataset) < 3:
        raise InputError("context is chosen on three images at least", value=len(dataset), hint="give more")
    samples = [
        _draw(image, size, np.random.default_rng([seed, position]))
        for position, image in enumerate(reported(dataset, "reading images", len(dataset), progress))
    ]
    require_every_class(
        dataset.classes, (any((image.labels == owner).any() for image in samples) for owner in (0, 1))
    )
    model = _choose(samples, size, dataset.classes, seed)
    inside = []

    def choose(others: Sequence[int]) -> WisardModel:
        chosen = _choose([samples[i] for i in others], size, dataset.classes, seed)
        inside.append(" ".join(_encoder(chosen).planes))
        return chosen

    judged = pictures_cross_validated(dataset, choose, "choosing in each fold", progress)
    figures: dict[str, Any] = {NESTED: inside, LIGHT: light_figures(judged), "images": list(dataset.names)}
    return replace(model, training={**model.training, **figures})


def _encoder(model: WisardModel) -> Context:
    assert isinstance(model.encoder, Context)
    return model.encoder


@cache
def _planes() -> tuple[Comparison, ...]:
    """Ratios of two channels; what the low bits would add is replaced by its mean."""
    found = []
    for one, other in combinations(CHANNELS, 2):
        for left, right in dict.fromkeys((*RATIOS, *(ratio[::-1] for ratio in RATIOS))):
            offset = round((right - left) * ((1 << LOWEST) - 1) / 2 / (1 << LOWEST))
            found.append(
                Comparison((Weighted(one, left, LOWEST),), (Weighted(other, right, LOWEST),), offset)
            )
    return tuple(found)


def _draw(image: LabelledImage, size: int, rng: np.random.Generator) -> _Samples:
    """Pixels of some tiles of an image, each tile under light of its own.

    As many as `COPIES` times `PIXELS`, or fewer where hardly any labelled pixel sees data alone.
    """
    halo = size // 2
    picture, labels, usable = image.picture, image.label_picture, image.usable(halo)
    height, width = labels.shape
    if min(height, width) < size:
        raise InputError(
            "an image is smaller than the square",
            value=f"{image.name} of {width}x{height} pixels",
            hint="give larger ones, or a smaller square",
        )
    own, sums, drawn = [], [], []
    for _ in range(COPIES):
        side = TILE + 2 * halo
        top, left = (int(rng.integers(max(1, whole - side + 1))) for whole in (height, width))
        tile = picture[top : top + side, left : left + side]
        inner = slice(halo, tile.shape[0] - halo), slice(halo, tile.shape[1] - halo)
        places = np.argwhere(usable[top : top + side, left : left + side][inner])
        if not len(places):
            continue
        rows, columns = places[rng.integers(len(places), size=PIXELS)].T
        lit = varied(tile.reshape(-1, len(CHANNELS)), rng, together=True).reshape(tile.shape)
        planes = [plane.evaluate(lit) for plane in _planes()]
        own.append(np.stack([plane[inner][rows, columns] for plane in planes]))
        sums.append(np.stack([box_sums(plane, size)[rows, columns] for plane in planes]).astype(np.uint16))
        drawn.append(labels[top : top + side, left : left + side][inner][rows, columns])
    if not drawn:
        nothing = np.zeros((len(_planes()), 0))
        return _Samples(nothing.astype(np.bool_), nothing.astype(np.uint16), np.zeros(0, np.uint8))
    return _Samples(np.concatenate(own, axis=1), np.concatenate(sums, axis=1), np.concatenate(drawn))


def _choose(images: Sequence[_Samples], size: int, classes: tuple[str, ...], seed: int) -> WisardModel:
    """The best classifier on these images."""
    own = np.concatenate([image.own for image in images], axis=1)
    sums = np.concatenate([image.sums for image in images], axis=1)
    labels = np.concatenate([image.labels for image in images]).astype(np.int64)
    owners = np.repeat(np.arange(len(images)), [len(image.labels) for image in images])
    places = {str(plane): place for place, plane in enumerate(_planes())}

    def counted(counts: Sequence[Count]) -> NDArray[np.int64]:
        """Pixels by image, class and code of these bits: ``[images, 2, 2**bits]``."""
        keys = 2 * owners + labels << len(counts)
        for position, count in enumerate(counts):
            place = places[count.plane]
            bits = own[place] if count.size == 1 else sums[place] >= count.least
            keys += bits.astype(np.int64) << position
        shape = len(images), 2, 1 << len(counts)
        return np.bincount(keys, minlength=int(np.prod(shape))).reshape(shape)

    pixel = [(Count(plane),) for plane in places]
    square = [
        tuple(Count(plane, size, int(np.ceil(share * size**2))) for share in SHARES) for plane in places
    ]
    both = [one + more for one, more in zip(pixel, square, strict=True)]
    chosen: tuple[Count, ...] = ()
    for step in (both, square, pixel):
        tries = [chosen + bits for bits in step if not set(bits) & set(chosen)]
        chosen = max(tries, key=lambda bits: _right_outside(counted(bits)))
    answers = (_logits(counted(chosen).sum(axis=0)) > 0).astype(np.int64)
    record = {"method": "context", "size": size, "seed": seed}
    return look_up_table(Context(tuple(map(str, chosen))), classes, answers, record)


def _right_outside(counted: NDArray[np.int64]) -> float:
    """Share of the pixels that are right when each image is classified by a regression on others.

    Args:
        counted: pixels by image, class and code, ``[images, 2, 2**width]``; one image is its own judge.
    """
    folds = fold_count(len(counted))
    right = 0
    for fold in range(folds):
        outside = np.arange(len(counted)) % folds == fold
        answers = _logits(counted[~outside if folds > 1 else outside].sum(axis=0)) > 0
        right += np.where(answers, *counted[outside].sum(axis=0)[::-1]).sum()
    return float(right / counted.sum())


def _logits(counted: NDArray[np.int64]) -> NDArray[np.float64]:
    """What a logistic regression on the bits of a code answers for every code: float64 ``[2**width]``.

    Args:
        counted: pixels by class and code, ``[2, 2**width]``.
    """
    width = (counted.shape[1] - 1).bit_length()
    bits = codes_to_bits(all_codes(width), width)
    inputs = np.concatenate([np.ones((len(bits), 1)), bits], axis=1)
    total = counted.sum(axis=0)
    used = total > 0
    seen, pixels, ones = inputs[used], total[used], counted[1, used]
    penalty = np.diag([0.0, *[RIDGE] * width])
    weights = np.zeros(inputs.shape[1])
    for _ in range(_STEPS):
        chance = 1 / (1 + np.exp(-np.clip(seen @ weights, -30, 30)))
        gradient = seen.T @ (ones - pixels * chance) - penalty @ weights
        curvature = (seen.T * (pixels * chance * (1 - chance))) @ seen + penalty
        # The constant of a training without one of the classes has no curvature.
        weights += np.linalg.solve(curvature + 1e-6 * np.eye(len(curvature)), gradient)
    return np.asarray(inputs @ weights)
