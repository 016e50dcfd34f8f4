"""The work inside a WiSARD: addresses, counts and winners, on whole arrays.

Throughout, ``m`` is 1 (one mapping for all classes) or the number of classes, ``k`` the RAMs of a
discriminator, ``n`` the address bits of a RAM and ``S`` the patterns at hand.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

CHUNK_ENTRIES = 1 << 22
"""Entries of an array held at a time: some tens of megabytes, whatever the data's size."""


def chunks(patterns: int, entries: int) -> Iterator[slice]:
    """Slices of the patterns, in which arrays of ``entries`` per pattern stay below `CHUNK_ENTRIES`."""
    step = max(1, CHUNK_ENTRIES // entries)
    for start in range(0, patterns, step):
        yield slice(start, start + step)


def addresses(bits: NDArray[np.bool_], mapping: NDArray[np.int64]) -> NDArray[np.int64]:
    """Address of every RAM for every pattern.

    Args:
        bits: bool ``[S, width]``.
        mapping: int64 ``[m, k, n]``.

    Returns:
        int64 ``[m, k, S]``; address bit ``j`` is input ``mapping[…, j]``.
    """
    inputs = np.ascontiguousarray(bits.T)
    result = np.zeros((*mapping.shape[:2], len(bits)), dtype=np.int64)
    for position in range(mapping.shape[2]):
        result |= inputs[mapping[:, :, position]].astype(np.int64) << position
    return result


def count(
    where: NDArray[np.int64], address_bits: int, weights: NDArray[np.int64] | None = None
) -> NDArray[np.int64]:
    """How often each address of each RAM occurs.

    Args:
        where: int64 ``[k, S]``, the addresses of one class's patterns.
        address_bits: n.
        weights: int64 ``[S]``, occurrences of each pattern; 1 if left out. Their sum must be below 2**53, up
            to which the sums are exact.

    Returns:
        int64 ``[k, 2**n]``.
    """
    size = 1 << address_bits
    return np.stack([np.bincount(ram, weights, size).astype(np.int64) for ram in where])


def class_counts(
    histogram: NDArray[np.int64], where: NDArray[np.int64], address_bits: int
) -> NDArray[np.int64]:
    """RAM counts of each class.

    Args:
        histogram: int64 ``[classes, S]``, how often each pattern occurs in each class.
        where: int64 ``[m, k, S]``, the patterns' addresses.
        address_bits: n.

    Returns:
        int64 ``[classes, k, 2**n]``.
    """
    return np.stack(
        [count(where[owner % len(where)], address_bits, pixels) for owner, pixels in enumerate(histogram)]
    )


def responses(fires: NDArray[np.bool_], where: NDArray[np.int64]) -> NDArray[np.int64]:
    """Firing RAMs of each discriminator.

    Args:
        fires: bool ``[classes, k, 2**n]``.
        where: int64 ``[m, k, S]``.

    Returns:
        int64 ``[S, classes]``.
    """
    result = np.zeros((len(fires), where.shape[2]), dtype=np.int64)
    for owner, discriminator in enumerate(fires):
        for ram, address in zip(discriminator, where[owner % len(where)], strict=True):
            result[owner] += ram[address]
    return result.T


def winners(
    counts: NDArray[np.int64],
    where: NDArray[np.int64],
    thresholds: NDArray[np.int64],
    left_out: int | None = None,
) -> NDArray[np.int64]:
    """The winning class under each of several bleaching thresholds.

    Args:
        counts: int64 ``[classes, k, 2**n]``.
        where: int64 ``[m, k, S]``.
        thresholds: int64 ``[T]``, ascending.
        left_out: a class that was trained with each of these patterns; it answers as if it had seen the
            pattern at hand once less.

    Returns:
        int64 ``[T, S]``; ties go to the lowest class index.
    """
    patterns = where.shape[2]
    silent = np.empty((len(counts), patterns, len(thresholds)), dtype=np.int64)
    for owner, discriminator in enumerate(counts):
        known, seen = discriminator - (owner == left_out), where[owner % len(where)]
        if known.shape[1] > patterns:
            levels = np.searchsorted(thresholds, np.take_along_axis(known, seen, axis=1), side="right")
        else:
            levels = np.take_along_axis(np.searchsorted(thresholds, known, side="right"), seen, axis=1)
        silent[owner] = silent_rams(levels, len(thresholds))
    return np.asarray(silent.argmin(axis=0).T)


def silent_rams(levels: NDArray[np.int64], thresholds: int) -> NDArray[np.int64]:
    """How many RAMs of a discriminator stay silent under each of several thresholds.

    Args:
        levels: int64 ``[k, S]``, how many of the thresholds the count at each RAM's address reaches.
        thresholds: how many there are.

    Returns:
        int64 ``[S, thresholds]``, for thresholds that rise.
    """
    # Under threshold t a RAM is silent if its level is at most t, so one running sum over a histogram of
    # levels answers for all thresholds together.
    bins, patterns = thresholds + 1, levels.shape[1]
    places = levels + np.arange(patterns) * bins
    histogram = np.bincount(places.ravel(), minlength=patterns * bins).reshape(patterns, bins)
    return np.asarray(np.cumsum(histogram[:, :-1], axis=1))
