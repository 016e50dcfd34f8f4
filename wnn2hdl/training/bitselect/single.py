"""The best few bits, by looking at all choices."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Subset:
    """Some of the bits of a code, and the mass that remains when the others are summed over.

    Attributes:
        bits: positions of the bits, ascending.
        mass: int64 ``[2**len(bits)]``; bit ``i`` of the index is ``bits[i]``.
        score: the sum of the magnitudes of ``mass``: what the best table over these bits gets right less what
            it gets wrong.
    """

    bits: tuple[int, ...]
    mass: NDArray[np.int64]
    score: int


def best_subset(mass: NDArray[np.int64], size: int) -> Subset:
    """The ``size`` bits whose best table is the most accurate; exact.

    Args:
        mass: signed mass, int64 ``[2**width]``.
        size: bits to choose, at most ``width``.
    """
    width = len(mass).bit_length() - 1
    best = Subset((), mass, -1)

    # Bits are kept or summed over from the highest down; a path shares its sums with all that branch off it,
    # and the lowest bits of the index are those not yet decided.
    def visit(cells: NDArray[np.int64], kept: Sequence[int], undecided: int) -> None:
        nonlocal best
        surplus = len(kept) + undecided - size
        if surplus == 0:
            score = int(np.abs(cells).sum())
            if score > best.score:
                best = Subset((*range(undecided), *reversed(kept)), cells.ravel(), score)
            return
        halves = cells.reshape(1 << len(kept), 2, -1)
        visit(halves[:, 0] + halves[:, 1], kept, undecided - 1)
        if undecided > surplus:
            visit(cells, (*kept, undecided - 1), undecided - 1)

    visit(mass, (), width)
    return best
