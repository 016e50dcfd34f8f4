"""Support reduction: the fewest inputs that still tell the cared-for ON codes from the OFF codes apart."""

import numpy as np
from numpy.typing import NDArray

Flags = NDArray[np.bool_]


def differences(on: Flags, off: Flags) -> Flags:
    """Which XORs of an ON code and an OFF code occur, bool ``[2**n]``; the XOR convolution of the two sets.

    Args:
        on: bool ``[2**n]``, indexed by code.
        off: bool ``[2**n]``, disjoint from ``on``.
    """
    # Counts stay below 2**20 * 2**20 * 2**20 for the widest table, so int64 is exact.
    product = _walsh_hadamard(on.astype(np.int64)) * _walsh_hadamard(off.astype(np.int64))
    return np.not_equal(_walsh_hadamard(product), 0)


def minimum_supports(on: Flags, off: Flags) -> list[int]:
    """All smallest sets of inputs on which the function can be defined.

    A set is sufficient if no ON code differs from an OFF code outside of it only. All ``2**n`` sets are
    decided at once by a subset transform of the differences, so the result is exact at any width of a table.

    Args:
        on: bool ``[2**n]``, or ``[2**n, outputs]``: the set then serves all outputs.
        off: as ``on``.

    Returns:
        Masks of inputs, ascending; each has the same, smallest number of bits. ``[0]`` for a constant.
    """
    columns = zip(np.atleast_2d(on.T), np.atleast_2d(off.T), strict=True)
    blocked = np.zeros(on.shape[0], dtype=np.bool_)
    for one, other in columns:
        blocked |= differences(one, other)
    width = on.shape[0].bit_length() - 1
    for position in range(width):  # blocked[set]: some difference lies wholly inside the set
        halves = blocked.reshape(-1, 2, 1 << position)
        halves[:, 1] |= halves[:, 0]
    sufficient = np.flatnonzero(~blocked[::-1])  # the complement of a set is its mirror image
    sizes = np.bitwise_count(sufficient)
    return [int(mask) for mask in sufficient[sizes == sizes.min()]]


def restrict(flags: Flags, support: int) -> Flags:
    """Project a set of codes onto some of its inputs, in their order: bool ``[2**bits(support)]``."""
    width = flags.shape[0].bit_length() - 1
    dropped = tuple(width - 1 - position for position in range(width) if not support >> position & 1)
    return flags.reshape((2,) * width).any(axis=dropped).reshape(-1)


def members(support: int) -> tuple[int, ...]:
    """The positions of a mask's bits, ascending."""
    return tuple(position for position in range(support.bit_length()) if support >> position & 1)


def _walsh_hadamard(values: NDArray[np.int64]) -> NDArray[np.int64]:
    result = values.copy()
    half = 1
    while half < len(result):
        pairs = result.reshape(-1, 2, half)
        low, high = pairs[:, 0] + pairs[:, 1], pairs[:, 0] - pairs[:, 1]
        pairs[:, 0], pairs[:, 1] = low, high
        half *= 2
    return result
