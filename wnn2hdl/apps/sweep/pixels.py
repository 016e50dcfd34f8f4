"""What every trial looks at: sampled training pixels, held-out pixels, colours of the training imagery."""

import functools
import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import ColourHistogram, Dataset, colour_histogram, split
from wnn2hdl.errors import InputError
from wnn2hdl.ir import COLOURS, MAX_TABLE_INPUTS, BitSelect
from wnn2hdl.progress import Progress, reported

TRAINING_PIXELS = 20_000
"""Pixels drawn for training by default."""


@dataclass(frozen=True, eq=False)
class CodeCounts:
    """The pixel sets as an encoder sees them.

    Attributes:
        encoder: what made the codes.
        training: int64 ``[images, classes, 2**width]``, the sampled training pixels.
        held_out: int64 ``[classes, 2**width]``, all pixels of the held-out images.
        imagery: int64 ``[2**width]``, all pixels of the training images.
    """

    encoder: BitSelect
    training: NDArray[np.int64]
    held_out: NDArray[np.int64]
    imagery: NDArray[np.int64]


@dataclass(frozen=True)
class PixelSets:
    """Pixels as colours, so that any choice of pixel bits can be tried; small enough to send to a worker.

    Two are equal if their digests are. All colours are ``0xRRGGBB``.

    Attributes:
        classes: class names, the background first.
        training_images: names of the images trained on.
        held_out_images: names of the images that no trial is trained on.
        digest: SHA-256 of all that decides a trial's outcome, hexadecimal.
        sample: int64 ``[4, s]``: colour, image, class and number of each group of sampled training pixels.
        imagery: int64 ``[2, u]``: colour and number in all training images.
        held_out: int64 ``[1 + classes, v]``: colour, then its number in each class.
    """

    classes: tuple[str, ...]
    training_images: tuple[str, ...]
    held_out_images: tuple[str, ...]
    digest: str
    sample: NDArray[np.int64]
    imagery: NDArray[np.int64]
    held_out: NDArray[np.int64]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PixelSets) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    @property
    def pixels(self) -> int:
        """Sampled training pixels."""
        return int(self.sample[3].sum())


def draw(dataset: Dataset, *, pixels: int, seed: int, progress: Progress) -> PixelSets:
    """Split a data set by image, half to train on and half held out, and sample the training pixels.

    The sample is spread evenly over the training images and, within each, over the classes; where an image
    has too few pixels of a class, the others give more. One image is in memory at a time, and the colours of
    all.

    Args:
        dataset: at least two images.
        pixels: how many training pixels to draw; all there are if there are fewer.
        seed: of the draw.
        progress: called with each image read.

    Raises:
        InputError: fewer than two images, one that cannot be read, or a class that is missing on a side.
    """
    if len(dataset) < 2:
        raise InputError("a sweep needs images to hold out", value=f"{len(dataset)} image", hint="give two")
    trained, held = split(dataset.names, len(dataset) // 2)
    histograms = {
        image.name: colour_histogram(image, len(dataset.classes))
        for image in reported(dataset, "reading images", len(dataset), progress)
    }
    for side, names in (("training", trained), ("held-out", held)):
        totals = sum(histograms[name].counts.sum(axis=1) for name in names)
        for label, total in zip(dataset.classes, np.atleast_1d(totals), strict=True):
            if not total:
                raise InputError(
                    f"no pixel of the {side} images is labelled {label}",
                    value=f"{len(names)} images",
                    hint="add images that show every class",
                )
    sample = _sample([histograms[name] for name in trained], pixels, np.random.default_rng([seed, 0]))
    merged = _merge([histograms[name] for name in trained])
    imagery = np.stack([merged[0], merged[1:].sum(axis=0)])
    held_out = _merge([histograms[name] for name in held])
    digest = hashlib.sha256(repr((dataset.classes, len(trained))).encode())
    for array in (sample, imagery, held_out):
        digest.update(repr(array.shape).encode() + array.tobytes())
    return PixelSets(dataset.classes, trained, held, digest.hexdigest(), sample, imagery, held_out)


# A search changes the bits with every trial; a grid never does.
@functools.lru_cache(maxsize=4)
def code_counts(sets: PixelSets, bits: tuple[str, ...]) -> CodeCounts:
    """The sets as seen through the named pixel bits.

    Raises:
        InputError: too many bits for a table.
    """
    if len(bits) > MAX_TABLE_INPUTS:
        raise InputError(
            "too many input bits for one truth table",
            value=len(bits),
            hint=f"choose at most {MAX_TABLE_INPUTS}",
        )
    encoder = BitSelect(bits)
    classes, size = len(sets.classes), 1 << encoder.width
    codes = _codes(encoder, sets.sample[0])
    cells = (sets.sample[1] * classes + sets.sample[2]) * size + codes
    shape = (len(sets.training_images), classes, size)
    training = np.bincount(cells, sets.sample[3], int(np.prod(shape))).astype(np.int64).reshape(shape)
    imagery = np.bincount(_codes(encoder, sets.imagery[0]), sets.imagery[1], size).astype(np.int64)
    codes = _codes(encoder, sets.held_out[0])
    held_out = np.stack([np.bincount(codes, row, size).astype(np.int64) for row in sets.held_out[1:]])
    return CodeCounts(encoder, training, held_out, imagery)


def seen_colours(sets: PixelSets) -> NDArray[np.int64]:
    """What `WisardModel.colours` holds of a model that was trained on these images."""
    return np.flatnonzero(code_counts(sets, COLOURS.bits).imagery)


def _codes(encoder: BitSelect, colours: NDArray[np.int64]) -> NDArray[np.int64]:
    pixels = np.stack([colours >> 16, colours >> 8 & 255, colours & 255], axis=-1).astype(np.uint8)
    return encoder.codes(pixels).astype(np.int64)


def _sample(images: list[ColourHistogram], pixels: int, rng: np.random.Generator) -> NDArray[np.int64]:
    available = np.stack([image.counts.sum(axis=1) for image in images])
    shares = even_shares(available.ravel(), pixels).reshape(available.shape)
    groups = []
    for position, image in enumerate(images):
        for label, row in enumerate(image.counts):
            drawn = rng.multivariate_hypergeometric(row, shares[position, label], method="marginals")
            found = np.flatnonzero(drawn)
            fixed = np.full((2, len(found)), [[position], [label]])
            groups.append(np.vstack([image.colours[found], fixed, drawn[found]]).astype(np.int64))
    return np.concatenate(groups, axis=1)


def even_shares(available: NDArray[np.int64], total: int) -> NDArray[np.int64]:
    """Divide a total evenly, no one getting more than is available: int64, shaped as ``available``.

    What one lacks is spread over the others; the sum is ``total``, or all there is.
    """
    shares = np.zeros_like(available)
    left = min(total, int(available.sum()))
    # From the scarcest on, each takes its even part of what is left.
    for done, position in enumerate(np.argsort(available, kind="stable")):
        shares[position] = min(int(available[position]), left // (len(available) - done))
        left -= int(shares[position])
    return shares


def _merge(images: list[ColourHistogram]) -> NDArray[np.int64]:
    """Colours of all images, ascending, and their numbers in each class: int64 ``[1 + classes, u]``."""
    colours, place = np.unique(np.concatenate([image.colours for image in images]), return_inverse=True)
    counts = np.concatenate([image.counts for image in images], axis=1)
    summed = [np.bincount(place, row, len(colours)) for row in counts]
    return np.stack([colours, *summed]).astype(np.int64)
