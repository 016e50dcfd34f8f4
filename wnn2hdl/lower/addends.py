"""Tables of whole numbers as sums: input bits with weights, and tables of one bit for what these leave.

A table that rises or falls with its word is mostly a weighted sum of the word's bits, which cost no look-up
table. The weights are those that leave the least to tables and to the sum; the constant is the one with which
the tables of what is left read the fewest inputs.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS

_ADDED = (1.0, 1.5)
"""LUTs that a bit costs in the sum: a counter takes as many LUTs as it takes bits away. A search with a
higher cost ends elsewhere, and sometimes better."""

_SCALES = (1, -1, 3, -3)
"""Weights that are tried are powers of two times these."""

_MAX_PAIRED = 8
"""Input bits up to which weights are changed two at a time."""

_MAX_SHIFTS = 64
"""Constants that are tried."""


@dataclass(frozen=True, eq=False)
class Addends:
    """A table as a sum of ``constant``, the weights of set input bits, and ``2**place`` for each set column.

    Attributes:
        constant: what is added to every sum.
        weights: of each input bit, of either sign.
        columns: bool ``[2**n, places]``, a table of one bit for each power of two; constant ones are among
            them.
    """

    constant: int
    weights: tuple[int, ...]
    columns: NDArray[np.bool_]


def addends(values: NDArray[np.int64], care: NDArray[np.bool_]) -> Addends:
    """A table as a sum that takes few LUTs.

    Args:
        values: int64 ``[2**n]``.
        care: bool ``[2**n]``, the codes that occur, at least one; on others the sum may be anything.
    """
    width = len(values).bit_length() - 1
    bits = np.arange(len(values))[:, np.newaxis] >> np.arange(width) & 1
    search = [_Search(values[care], bits[care], added) for added in _ADDED]
    weights = {tuple(each.improved(start).tolist()) for each in search for start in each.starts()}
    found = [_parted(values - bits @ np.array(each), care, each) for each in sorted(weights)]
    return min(found, key=lambda pair: pair[0])[1]


def _parted(
    left: NDArray[np.int64], care: NDArray[np.bool_], weights: tuple[int, ...]
) -> tuple[float, Addends]:
    """What is left as columns, with the constant that makes them cheapest; and the LUTs of tables and sum."""
    lowest, highest = int(left[care].min()), int(left[care].max())
    places = (highest - lowest).bit_length()
    slack = (1 << places) - 1 - (highest - lowest)
    shifts = np.unique(np.linspace(0, slack, min(slack + 1, _MAX_SHIFTS)).astype(np.int64))
    moved = np.where(care, left - lowest, 0) + shifts[:, np.newaxis]
    columns = (moved[..., np.newaxis] >> np.arange(places) & 1).astype(np.bool_)
    costs = _tables(columns, care).sum(axis=1)
    best = int(costs.argmin())
    added = sum(_digits(weight) for weight in weights)
    parts = Addends(lowest - int(shifts[best]), weights, columns[best])
    return float(costs[best]) + added * _ADDED[0], parts


def _tables(columns: NDArray[np.bool_], care: NDArray[np.bool_]) -> NDArray[np.float64]:
    """LUTs of columns, bool ``[shifts, 2**n, places]``, with those of adding them: ``[shifts, places]``."""
    shifts, size, places = columns.shape
    reads = np.zeros((shifts, places), dtype=np.int64)
    for position in range(size.bit_length() - 1):
        halves = columns.reshape(shifts, size >> position + 1, 2, 1 << position, places)
        both = np.asarray(care.reshape(-1, 2, 1 << position).all(axis=1))
        differ = np.asarray(halves[:, :, 0] != halves[:, :, 1])
        reads += (differ & both[..., np.newaxis]).any(axis=(1, 2))
    return np.where(reads == 0, 0, np.vectorize(_table, otypes=[float])(reads) + _ADDED[0])


@dataclass(frozen=True, eq=False)
class _Search:
    """The search for weights that leave a small range to tables.

    Attributes:
        values: int64 ``[codes]``, the table at the codes that occur.
        bits: int64 ``[codes, n]``, their bits.
        added: LUTs that a bit costs in the sum.
    """

    values: NDArray[np.int64]
    bits: NDArray[np.int64]
    added: float

    @property
    def steps(self) -> NDArray[np.int64]:
        """Weights that are tried."""
        places = range(int(np.ptp(self.values)).bit_length())
        return np.array(sorted({0, *(scale * (1 << place) for place in places for scale in _SCALES)}))

    def starts(self) -> list[NDArray[np.int64]]:
        """No weights, and for each bit the weight nearest to what it changes on the average."""
        near = np.zeros(self.bits.shape[1], dtype=np.int64)
        for position, column in enumerate(self.bits.T == 1):
            if column.any() and not column.all():
                slope = self.values[column].mean() - self.values[~column].mean()
                near[position] = self.steps[np.abs(self.steps - slope).argmin()]
        return [np.zeros_like(near), near]

    def improved(self, weights: NDArray[np.int64]) -> NDArray[np.int64]:
        """Change the weights of one bit, or of two, as long as that makes the sum cheaper."""
        width, steps = self.bits.shape[1], self.steps
        digits = np.array([_digits(step) for step in steps.tolist()])
        sizes = (1, 2) if width <= _MAX_PAIRED else (1,)
        best = np.inf
        while True:
            moves = []
            for positions in (each for size in sizes for each in combinations(range(width), size)):
                others = weights.copy()
                others[list(positions)] = 0
                left = self.values - self.bits @ others
                added = np.array(sum(map(_digits, others.tolist())))
                for position in positions:
                    left = left[..., np.newaxis, :] - steps[:, np.newaxis] * self.bits[:, position]
                    added = added[..., np.newaxis] + digits
                costs = self._costs(np.ptp(left, axis=-1), added)
                place = np.unravel_index(costs.argmin(), costs.shape)
                moves.append((float(costs[place]), positions, [int(steps[i]) for i in place]))
            cost, positions, chosen = min(moves, default=(best, (), []))
            if cost >= best:
                return weights
            best, weights = cost, weights.copy()
            weights[list(positions)] = chosen

    def _costs(self, left: NDArray[np.int64], added: NDArray[np.int64]) -> NDArray[np.float64]:
        """LUTs of tables that hold numbers from 0 to ``left``, and of adding these and ``added`` bits."""
        places = np.ceil(np.log2(left + 1))
        # The last term settles ties: the smaller a range, the more bits of it may turn out to be equal.
        return np.asarray(
            places * (_table(self.bits.shape[1]) + self.added) + added * self.added + left * 1e-6
        )


def _table(inputs: int) -> float:
    """LUTs of a table of one bit."""
    if inputs < 2:
        return 0.0
    return 0.5 if inputs < LUT_INPUTS else float(1 << (inputs - LUT_INPUTS))


def _digits(weight: int) -> int:
    """Powers of two, added or subtracted, that make a weight."""
    size = abs(weight)
    return (3 * size ^ size).bit_count()
