"""Whether two architectures differ: Wilcoxon's tests with effect sizes and confidence intervals."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # loads its modules when they are used: statistics take half a second
from numpy.typing import NDArray

LEVEL = 0.05
"""Of significance; intervals cover 1 minus this."""

MIN_PAIRS = 10
"""Below this the signed-rank test has hardly any power (its smallest two-sided p for 5 pairs is 0.06)."""

_RESAMPLES = 9999


@dataclass(frozen=True)
class Comparison:
    """Two samples of accuracies compared.

    Attributes:
        test: ``signed-rank`` on pairs, or ``rank-sum``.
        sizes: how many values of each entered the test; the same number twice for pairs.
        p_value: two-sided.
        effect: rank-biserial correlation, -1 to 1: of the signed ranks, or of all pairs, the share in favour
            of the first minus the share in favour of the second (Kerby 2014).
        difference: mean of the first minus mean of the second.
        low: lower end of the bootstrap interval of the difference.
        high: upper end of the same interval.
    """

    test: str
    sizes: tuple[int, int]
    p_value: float
    effect: float
    difference: float
    low: float
    high: float


def compare(first: Mapping[int, float], second: Mapping[int, float]) -> Comparison:
    """Compare accuracies by mapping seed.

    Values of the same seed are paired: both architectures then drew from the same random numbers. Where fewer
    than `MIN_PAIRS` pairs exist, or pairing would leave out more than half of a sample, the rank-sum test
    takes all values.

    Args:
        first: accuracy by seed, at least one.
        second: the same of the other architecture.
    """
    common = sorted(first.keys() & second.keys())
    if len(common) >= MIN_PAIRS and 2 * len(common) >= max(len(first), len(second)):
        return _signed_rank(_values(first, common), _values(second, common))
    return _rank_sum(_values(first, sorted(first)), _values(second, sorted(second)))


def holm(p_values: Sequence[float]) -> tuple[float, ...]:
    """Holm's adjustment of several p values, in their order."""
    adjusted = np.empty(len(p_values))
    largest = 0.0
    for rank, position in enumerate(np.argsort(p_values, kind="stable")):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p_values[position]))
        adjusted[position] = largest
    return tuple(adjusted.tolist())


def _signed_rank(first: NDArray[np.float64], second: NDArray[np.float64]) -> Comparison:
    differences = first - second
    moved = differences[differences != 0]
    if len(moved):
        p_value = float(scipy.stats.wilcoxon(moved).pvalue)
        ranks = scipy.stats.rankdata(np.abs(moved))
        effect = float((ranks * np.sign(moved)).sum() / ranks.sum())
    else:
        p_value, effect = 1.0, 0.0
    low, high = _interval((differences,), lambda x, axis: x.mean(axis=axis))
    sizes = (len(first), len(second))
    return Comparison("signed-rank", sizes, p_value, effect, float(differences.mean()), low, high)


def _rank_sum(first: NDArray[np.float64], second: NDArray[np.float64]) -> Comparison:
    test = scipy.stats.mannwhitneyu(first, second, alternative="two-sided")
    effect = 2 * float(test.statistic) / (len(first) * len(second)) - 1
    low, high = _interval((first, second), lambda x, y, axis: x.mean(axis=axis) - y.mean(axis=axis))
    return Comparison(
        "rank-sum",
        (len(first), len(second)),
        float(test.pvalue),
        effect,
        float(first.mean() - second.mean()),
        low,
        high,
    )


def _interval(
    samples: tuple[NDArray[np.float64], ...], statistic: Callable[..., NDArray[np.float64]]
) -> tuple[float, float]:
    if min(len(sample) for sample in samples) < 2:
        value = float(statistic(*samples, axis=-1))
        return value, value
    found = scipy.stats.bootstrap(
        samples,
        statistic,
        n_resamples=_RESAMPLES,
        confidence_level=1 - LEVEL,
        method="percentile",
        vectorized=True,
        rng=np.random.default_rng(0),
    ).confidence_interval
    return float(found.low), float(found.high)


def _values(accuracies: Mapping[int, float], seeds: Sequence[int]) -> NDArray[np.float64]:
    return np.array([accuracies[seed] for seed in seeds])
