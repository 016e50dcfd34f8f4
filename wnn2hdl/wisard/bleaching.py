"""Choosing the bleaching threshold on the training data alone.

Counts grow with the training data, and so does the best threshold: a million pixels saturate every RAM at
threshold 1. Two ways to judge a threshold on samples that the RAMs have not seen: by image, for pixels,
whose neighbours in the same image are nearly copies; by leaving out one sample at a time, for independent
samples.
"""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.wisard.rams import addresses, chunks, class_counts, winners

CANDIDATES = 64
"""Thresholds tried at most; answers change only at counts that occur, and these are quantiles of those."""

FOLDS = 5


def candidates(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Thresholds worth trying: 1, and quantiles of the distinct counts; int64, ascending, at most 65."""
    distinct = np.unique(counts[counts > 0])
    chosen = np.linspace(0, len(distinct) - 1, min(CANDIDATES, len(distinct))).round().astype(np.int64)
    return np.unique(np.concatenate([[1], distinct[chosen]]))


def choose_bleaching(histograms: NDArray[np.int64], mapping: NDArray[np.int64]) -> int:
    """The threshold with the best cross-validated accuracy, folds made of whole images.

    Image ``i`` belongs to fold ``i % 5``. The RAMs are trained on the other folds, and since they then hold
    fewer counts, a threshold is scaled by the share of the pixels they were trained on (rounded up). The
    threshold with the most pixels of the held-out images right wins, the lowest among equals. A single image
    is judged on itself.

    Args:
        histograms: int64 ``[images, classes, 2**width]``, how often each code occurs.
        mapping: int64 ``[1 or classes, k, n]``.

    Raises:
        InputError: there are no pixels.
    """
    codes = np.flatnonzero(histograms.any(axis=(0, 1)))
    if len(codes) == 0:
        raise InputError("there are no pixels to train on", hint="give labelled images")
    width = histograms.shape[2].bit_length() - 1
    where = addresses(codes_to_bits(codes, width), mapping)
    seen = histograms[:, :, codes]
    total = seen.sum(axis=0)
    thresholds = candidates(class_counts(total, where, mapping.shape[2]))
    folds = [total] if len(seen) == 1 else [seen[f::FOLDS].sum(axis=0) for f in range(min(FOLDS, len(seen)))]
    right = np.zeros(len(thresholds), dtype=np.int64)
    for held_out in folds:
        training = total - held_out if len(folds) > 1 else total
        scaled = _scaled(thresholds, int(training.sum()), int(total.sum()))
        winner = winners(class_counts(training, where, mapping.shape[2]), where, scaled)
        for index, pixels in enumerate(held_out):
            right += (winner == index) @ pixels
    return int(thresholds[right.argmax()])


def choose_bleaching_for_samples(
    counts: NDArray[np.int64],
    mapping: NDArray[np.int64],
    patterns: list[tuple[NDArray[np.bool_], NDArray[np.int64]]],
) -> int:
    """The threshold with the best leave-one-out accuracy; the lowest among equals.

    Leaving a sample out lowers the counts it made by one, all of them in its own class's discriminator.

    Args:
        counts: int64 ``[classes, k, 2**n]``, trained with these patterns (and perhaps more).
        mapping: int64 ``[1 or classes, k, n]``.
        patterns: for each class, its patterns, bool ``[S, width]``, and how often each occurs, int64 ``[S]``.
    """
    thresholds = candidates(counts)
    right = np.zeros(len(thresholds), dtype=np.int64)
    entries = max(mapping.shape[0] * mapping.shape[1], len(counts) * len(thresholds))
    for owner, (bits, weights) in enumerate(patterns):
        for part in chunks(len(bits), entries):
            winner = winners(counts, addresses(bits[part], mapping), thresholds, left_out=owner)
            right += (winner == owner) @ weights[part]
    return int(thresholds[right.argmax()])


def _scaled(thresholds: NDArray[np.int64], part: int, whole: int) -> NDArray[np.int64]:
    # Python's integers, since the product of two counts of a large scene overflows 64 bits.
    return np.array(
        [max(1, -(-threshold * part // whole)) for threshold in thresholds.tolist()], dtype=np.int64
    )
