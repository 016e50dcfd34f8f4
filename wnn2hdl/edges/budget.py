"""Edge filters learned under a LUT budget: the best agreement with Canny of all that fit, as far as found.

A filter of ``t + 1`` LUTs is a function ``f(g1(A), … gt(A), B)``: A is at most six bits of the window, B the
``6 - t`` others that f reads, and together they are all nine. So the rows of the chart A x B get one of
``2**t`` labels, and f answers for each label and B. Given the labels the best f is known, and given f the
best labels, for any weights of the windows; the weights are the gains in F1 beside the patterns at hand.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.edges.evidence import Evidence, gather
from wnn2hdl.edges.learning import FLAT, MOST_PATTERNS
from wnn2hdl.errors import InputError
from wnn2hdl.ir import LUT_INPUTS, WINDOW_BITS, WINDOW_CODES, EdgeFilter, bits_to_codes, codes_to_bits

MOST_LUTS = 3

NEVER = -1e6
"""The weight of a window of one colour: no gain in F1 makes up for it."""

FINALISTS = 24
"""Charts that are refined by the true F1."""

RANDOM_STARTS = 3
"""Random labellings that each chart starts from, beside one by the rows' weights."""

CAUTION = (0.0, 1e-4, 1e-3, 1e-2)
"""What leaving the patterns at hand costs in F1 per window, in turn: gains hold for small changes only."""


@dataclass(frozen=True, eq=False)
class _Chart:
    """Which bits the inner LUTs and the last LUT read.

    Attributes:
        labels: how many values the inner LUTs can hand on, ``2**t``.
        row: int64 ``[512]``, the value of A for each window.
        column: int64 ``[512]``, the value of B for each window.
    """

    labels: int
    row: NDArray[np.int64]
    column: NDArray[np.int64]

    @property
    def rows(self) -> int:
        return int(self.row.max()) + 1

    @property
    def columns(self) -> int:
        return int(self.column.max()) + 1

    def best_f(
        self, label: NDArray[np.int64], weights: NDArray[np.float64], count: int | None
    ) -> NDArray[np.bool_] | None:
        """The best f, bool ``[labels, columns]``, for labels int64 ``[rows]``; None if no f has the count."""
        cell = label[self.row] * self.columns + self.column
        cells = self.labels * self.columns
        gain = np.bincount(cell, weights, cells).astype(np.float64)
        values = np.stack([np.zeros(cells), gain], axis=1)
        sizes = np.stack([np.zeros(cells, np.int64), np.bincount(cell, minlength=cells)], axis=1)
        chosen = _choose(values, sizes, count)
        return None if chosen is None else (chosen == 1).reshape(self.labels, self.columns)

    def best_labels(
        self, f: NDArray[np.bool_], weights: NDArray[np.float64], count: int | None
    ) -> NDArray[np.int64] | None:
        """The best labels, int64 ``[rows]``, for an f; None if no labels give the count."""
        on = f[:, self.column]
        gains = [np.bincount(self.row, weights * flags, self.rows) for flags in on]
        values = np.stack(gains, axis=1).astype(np.float64)
        sizes = np.stack([np.bincount(self.row[flags], minlength=self.rows) for flags in on], axis=1)
        return _choose(values, sizes, count)

    def patterns(self, label: NDArray[np.int64], f: NDArray[np.bool_]) -> NDArray[np.bool_]:
        return f[label[self.row], self.column]

    def alternate(
        self, label: NDArray[np.int64], weights: NDArray[np.float64], count: int | None
    ) -> tuple[float, NDArray[np.int64], NDArray[np.bool_]] | None:
        """Improve f and the labels in turn; their weight and both; None if the count cannot be met."""
        best: tuple[float, NDArray[np.int64], NDArray[np.bool_]] | None = None
        while (f := self.best_f(label, weights, count)) is not None:
            score = float(weights[self.patterns(label, f)].sum())
            if best is not None and score <= best[0] + 1e-12:
                break
            best = score, label, f
            improved = self.best_labels(f, weights, count)
            if improved is None:
                break
            label = improved
        return best


def learned_under_budget(
    pictures: Iterable[tuple[NDArray[np.bool_], NDArray[np.bool_]]],
    luts: int,
    count: int | None = None,
    *,
    seed: int = 0,
) -> EdgeFilter:
    """Choose patterns that map to ``luts`` LUTs exactly, without don't-cares, with the highest F1 found.

    Args:
        pictures: as for `wnn2hdl.edges.learned`.
        luts: 1 to 3.
        count: how many patterns there shall be; as many as serve if left out. Windows that the pictures do
            not show cost nothing and fill the number up. One LUT holds multiples of 8 only.
        seed: decides the search's starts.

    Raises:
        InputError: another number of LUTs, a count that no filter of this many LUTs has, or no edge in any
            picture.
    """
    if not 1 <= luts <= MOST_LUTS:
        raise InputError("an edge filter is learned for 1 to 3 LUTs", value=luts, hint="choose 1, 2 or 3")
    if count is not None and not 1 <= count <= MOST_PATTERNS:
        raise InputError(f"an edge filter has 1 to {MOST_PATTERNS} patterns", value=count)
    evidence = gather(pictures)
    rng = np.random.default_rng(seed)
    weights = _weights(evidence, _ideal(evidence, count))
    found: list[tuple[float, int, _Chart, NDArray[np.int64]]] = []
    for chart in _charts(luts - 1):
        for label in _labellings(chart, weights, rng):
            # The count is left to the finalists: meeting it takes a hundred times as long.
            if (reached := chart.alternate(label, weights, None)) is not None:
                found.append((reached[0], -len(found), chart, reached[1]))
    found.sort(key=lambda entry: entry[:2], reverse=True)
    best: tuple[float, NDArray[np.bool_]] | None = None
    for _, _, chart, label in found[:FINALISTS]:
        refined = _refine(evidence, chart, label, weights, count)
        if refined is not None and (best is None or refined[0] > best[0]):
            best = refined
    if best is None:
        raise InputError(
            f"no edge filter of {luts} LUTs with this number of patterns was found",
            value=count,
            hint="ask for more LUTs or another number of patterns",
        )
    return EdgeFilter(f"learned-{luts}-lut", best[1])


def _refine(
    evidence: Evidence,
    chart: _Chart,
    label: NDArray[np.int64],
    weights: NDArray[np.float64],
    count: int | None,
) -> tuple[float, NDArray[np.bool_]] | None:
    """Take the gains again at each filter found, until no step raises the true F1."""
    reached = chart.alternate(label, weights, count)
    if reached is None:
        return None
    _, label, f = reached
    patterns = chart.patterns(label, f)
    f1 = evidence.f1(patterns)
    caution = iter(CAUTION)
    price = next(caution, None)
    while price is not None:
        staying = np.where(patterns, price, -price)
        step = chart.alternate(label, _weights(evidence, patterns) + staying, count)
        assert step is not None  # the labels at hand have an f of that count
        trial = chart.patterns(step[1], step[2])
        if (trial_f1 := evidence.f1(trial)) > f1:
            f1, patterns, label = trial_f1, trial, step[1]
        else:
            price = next(caution, None)
    return f1, patterns


def _ideal(evidence: Evidence, count: int | None) -> NDArray[np.bool_]:
    """The patterns that would be chosen without regard to LUTs, one flip at a time."""
    patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
    while True:
        gain = _weights(evidence, patterns)
        if count is not None and patterns.sum() < count:
            gain[patterns] = np.inf
            flip = int(np.where(patterns, -np.inf, gain).argmax())
        else:
            flip = int(np.where(patterns, -gain, gain).argmax())
            if (-gain if patterns[flip] else gain)[flip] <= 0 or count is not None:
                return patterns
        patterns[flip] = not patterns[flip]


def _weights(evidence: Evidence, patterns: NDArray[np.bool_]) -> NDArray[np.float64]:
    weights = evidence.gains(patterns)
    weights[list(FLAT)] = NEVER
    return weights


def _charts(wires: int) -> Iterator[_Chart]:
    """Every way to distribute the nine bits; A and B overlap as far as they can, which excludes nothing."""
    bits = codes_to_bits(np.arange(WINDOW_CODES), WINDOW_BITS)
    for b in combinations(range(WINDOW_BITS), LUT_INPUTS - wires):
        rest = tuple(x for x in range(WINDOW_BITS) if x not in b)
        for both in combinations(b, LUT_INPUTS - len(rest) if wires else 0):
            row, column = bits_to_codes(bits[:, rest + both]), bits_to_codes(bits[:, b])
            yield _Chart(1 << wires, row, column)


def _labellings(
    chart: _Chart, weights: NDArray[np.float64], rng: np.random.Generator
) -> Iterator[NDArray[np.int64]]:
    if chart.labels == 1:
        yield np.zeros(chart.rows, dtype=np.int64)
        return
    order = np.argsort(np.bincount(chart.row, weights), kind="stable")
    yield np.argsort(order, kind="stable") * chart.labels // chart.rows
    for _ in range(RANDOM_STARTS):
        yield rng.integers(chart.labels, size=chart.rows)


def _choose(
    values: NDArray[np.float64], sizes: NDArray[np.int64], total: int | None
) -> NDArray[np.int64] | None:
    """One option for each item, so that the values' sum is greatest and the sizes' sum is ``total``.

    Exact: without a total each item takes its best option; with one, by dynamic programming over the sizes.

    Args:
        values: float64 ``[items, options]``.
        sizes: int64 ``[items, options]``, none negative.
        total: the wanted sum of sizes, or None.

    Returns:
        int64 ``[items]``, the option of each item, the lowest among equals; None if no choice has the total.
    """
    if total is None:
        return np.asarray(values.argmax(axis=1))
    best = np.full(total + 1, -np.inf)
    best[0] = 0.0
    taken = np.empty((len(values), total + 1), dtype=np.int64)
    for item, (value, size) in enumerate(zip(values, sizes.tolist(), strict=True)):
        reached = np.full((len(size), total + 1), -np.inf)
        for option, more in enumerate(size):
            if more <= total:
                reached[option, more:] = best[: total + 1 - more] + value[option]
        taken[item] = reached.argmax(axis=0)
        best = reached.max(axis=0)
    if best[total] == -np.inf:
        return None
    options = np.empty(len(values), dtype=np.int64)
    left = total
    for item in reversed(range(len(values))):
        options[item] = taken[item, left]
        left -= int(sizes[item, options[item]])
    return options
