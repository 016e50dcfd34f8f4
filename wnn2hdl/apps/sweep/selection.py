"""From trials to decisions: the surface of a grid, its peaks, the Pareto front, the chosen architecture."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.sweep.grid import Cell, Plan
from wnn2hdl.apps.sweep.statistics import LEVEL, Comparison, compare, holm
from wnn2hdl.apps.sweep.trial import Record

PEAKS = 3
"""Peaks of the surface that become finalists."""

REFERENCE_CELLS: tuple[Cell, ...] = ((4, 16), (5, 10))
"""The reference design's own finalists (accuracies 0.900 and 0.865 on its imagery); here they are finalists
wherever the grid has them."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Means over the valid trials of each architecture; NaN where there is none.

    Attributes:
        address_bits: of each row.
        rams: of each column.
        accuracy: float64 ``[rows, columns]``, of the classifiers on the held-out pixels.
        luts: float64 ``[rows, columns]``, per pixel.
        valid: int64 ``[rows, columns]``, valid trials, as ``saturated`` and ``failed`` count theirs.
    """

    address_bits: tuple[int, ...]
    rams: tuple[int, ...]
    accuracy: NDArray[np.float64]
    luts: NDArray[np.float64]
    valid: NDArray[np.int64]
    saturated: NDArray[np.int64]
    failed: NDArray[np.int64]

    def at(self, cell: Cell) -> tuple[float, float]:
        """Mean accuracy and mean LUTs of an architecture."""
        place = self.address_bits.index(cell[0]), self.rams.index(cell[1])
        return float(self.accuracy[place]), float(self.luts[place])


def surface(plan: Plan, records: Iterable[Record]) -> Surface:
    """Sum up a grid; one record is held at a time."""
    rows, columns = (tuple(sorted({cell[axis] for cell in plan.cells})) for axis in (0, 1))
    shape = (len(rows), len(columns))
    sums = np.zeros((2, *shape))
    counts = {status: np.zeros(shape, dtype=np.int64) for status in ("valid", "saturated", "failed")}
    for record in records:
        place = rows.index(record.address_bits), columns.index(record.rams)
        counts[record.status][place] += 1
        if record.status == "valid":
            sums[(slice(None), *place)] += classifier_accuracy(record), record.luts or 0
    valid = counts["valid"]
    means = np.divide(sums, valid, out=np.full_like(sums, np.nan), where=valid > 0)
    return Surface(rows, columns, means[0], means[1], valid, counts["saturated"], counts["failed"])


def peaks(found: Surface) -> tuple[Cell, ...]:
    """Architectures that none of their eight neighbours beats in mean accuracy, the most accurate first.

    An architecture is not a peak if most of its trials are saturated: what is left is a selection of lucky
    mappings.
    """
    trusted = 2 * found.valid >= found.valid + found.saturated + found.failed
    heights = np.where(trusted & (found.valid > 0), found.accuracy, -np.inf)
    padded = np.pad(heights, 1, constant_values=-np.inf)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).max(axis=(2, 3))
    places = np.argwhere((heights >= around) & np.isfinite(heights))
    ranked = sorted(places.tolist(), key=lambda place: (-heights[tuple(place)], place))
    return tuple((found.address_bits[row], found.rams[column]) for row, column in ranked)


def finalists(found: Surface, plan: Plan) -> tuple[Cell, ...]:
    """The highest peaks, then the reference design's own choices where the grid has them."""
    return tuple(dict.fromkeys((*peaks(found)[:PEAKS], *(x for x in REFERENCE_CELLS if x in plan.cells))))


def pareto_front(records: Iterable[Record]) -> tuple[Record, ...]:
    """Valid trials whose circuit no other equals or beats in both LUTs and accuracy, by rising LUTs."""
    best: dict[int, Record] = {}
    for record in records:
        if record.status == "valid" and record.luts is not None:
            known = best.get(record.luts)
            if known is None or _accuracy(record) > _accuracy(known):
                best[record.luts] = record
    front: list[Record] = []
    for luts in sorted(best):
        if not front or _accuracy(best[luts]) > _accuracy(front[-1]):
            front.append(best[luts])
    return tuple(front)


def hypervolume(front: Sequence[Record], luts: int) -> float:
    """The area that a front dominates, accuracy times log2(1 + LUTs), up to the number ``luts``.

    Accuracy counts from 0.5, a coin's toss, so that the area distinguishes fronts.
    """
    inside = [record for record in front if record.luts is not None and record.luts <= luts]
    edges = [math.log2(1 + (record.luts or 0)) for record in inside] + [math.log2(1 + luts)]
    return sum(
        max(0.0, _accuracy(record) - 0.5) * (right - left)
        for record, (left, right) in zip(inside, pairwise(edges), strict=True)
    )


@dataclass(frozen=True, eq=False)
class Finalist:
    """An architecture tried often.

    Attributes:
        cell: address bits and RAMs.
        accuracies: of the valid trials, by mapping seed.
        luts: of the same trials.
        saturated: how many were left out.
        best: the most accurate trial.
    """

    cell: Cell
    accuracies: Mapping[int, float]
    luts: tuple[int, ...]
    saturated: int
    best: Record

    @property
    def accuracy(self) -> float:
        """Mean."""
        return float(np.mean(list(self.accuracies.values())))


@dataclass(frozen=True, eq=False)
class Decision:
    """The chosen architecture.

    Attributes:
        finalists: the most accurate first.
        comparisons: for each pair of them the comparison and its p value after Holm's adjustment.
        chosen: one of the finalists.
        reasons: why, in words.
    """

    finalists: tuple[Finalist, ...]
    comparisons: Mapping[tuple[Cell, Cell], tuple[Comparison, float]]
    chosen: Finalist
    reasons: str


def collect(records: Iterable[Record]) -> tuple[Finalist, ...]:
    """The finalists among records, those without a valid trial left out."""
    groups: dict[Cell, list[Record]] = {}
    for record in records:
        groups.setdefault((record.address_bits, record.rams), []).append(record)
    result = []
    for cell, group in groups.items():
        valid = [record for record in group if record.status == "valid"]
        if valid:
            best = max(valid, key=lambda record: (classifier_accuracy(record), -(record.luts or 0)))
            accuracies = {record.seed: classifier_accuracy(record) for record in valid}
            luts = tuple(record.luts or 0 for record in valid)
            saturated = sum(record.status == "saturated" for record in group)
            result.append(Finalist(cell, accuracies, luts, saturated, best))
    return tuple(sorted(result, key=lambda finalist: (-finalist.accuracy, finalist.cell)))


def decide(entered: Sequence[Finalist]) -> Decision | None:
    """Choose the most accurate, or the smallest of those that are not shown to be less accurate."""
    if not entered:
        return None
    pairs = list(combinations(entered, 2))
    compared = [compare(one.accuracies, other.accuracies) for one, other in pairs]
    adjusted = holm([comparison.p_value for comparison in compared])
    comparisons = {
        (one.cell, other.cell): (comparison, p_value)
        for (one, other), comparison, p_value in zip(pairs, compared, adjusted, strict=True)
    }
    best = entered[0]
    equals = [best] + [x for x in entered[1:] if comparisons[best.cell, x.cell][1] >= LEVEL]
    chosen = min(equals, key=lambda finalist: (np.mean(finalist.luts), -finalist.accuracy))
    return Decision(tuple(entered), comparisons, chosen, _reasons(best, equals, chosen, comparisons))


def _reasons(
    best: Finalist,
    equals: Sequence[Finalist],
    chosen: Finalist,
    comparisons: Mapping[tuple[Cell, Cell], tuple[Comparison, float]],
) -> str:
    def figures(finalist: Finalist) -> str:
        return f"mean accuracy {finalist.accuracy:.4f}, {np.mean(finalist.luts):.1f} LUTs per pixel"

    beaten = [
        f"{label(other)} (p = {p_value:.2g}, effect {comparison.effect:+.2f})"
        for (one, other), (comparison, p_value) in comparisons.items()
        if one == best.cell and p_value < LEVEL
    ]
    text = f"{label(best.cell)}: the highest mean over {len(best.accuracies)} valid trials ({figures(best)})"
    text += f", significantly more accurate than {'; '.join(beaten)}." if beaten else "."
    others = [label(finalist.cell) for finalist in equals[1:]]
    if others:
        text += f" Not shown to differ from it: {'; '.join(others)}."
    if chosen is not best:
        text += f" The fewest LUTs of these: {label(chosen.cell)} ({figures(chosen)})."
    return f"{text} Chosen: {label(chosen.cell)}."


def label(cell: Cell) -> str:
    """``4 address bits, 16 RAMs``."""
    return f"{cell[0]} address bits, {cell[1]} RAMs"


def _accuracy(record: Record) -> float:
    """Accuracy of a valid trial's circuit."""
    assert record.circuit_accuracy is not None
    return record.circuit_accuracy


def classifier_accuracy(record: Record) -> float:
    """Accuracy of a valid trial's classifier."""
    assert record.accuracy is not None
    return record.accuracy
