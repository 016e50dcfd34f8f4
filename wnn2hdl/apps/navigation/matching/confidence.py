"""Below what confidence no fix is given, learnt from matches whose truth is known."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wnn2hdl.apps.navigation.matching.peaks import Match
from wnn2hdl.errors import InputError

RIGHT_M = 100.0
"""A fix is right if it is less than this away from the truth."""

WRONG_PSR = 4.0
"""What a wrong match's best position stands above the mean: 3.2 to 4.1 standard deviations are the medians on
two real flights, from windows of 191 x 191 m to whole maps."""


PSR_WEIGHT = 2.0
"""By how much the logarithm of a peak's odds of being right rises with each standard deviation."""


@dataclass(frozen=True)
class Acceptance:
    """From which confidence on a fix is given, and what to expect of that.

    Attributes:
        threshold: the least confidence.
        precision: expected share of right fixes among those that are given, 0 to 1.
        share: share of the calibration's frames that would be fixed, 0 to 1.
        doubted: expected share of right ones among matches below the threshold, 0 to 1.
    """

    threshold: float
    precision: float
    share: float
    doubted: float = 1.0

    def accepts(self, confidence: float) -> bool:
        """Whether a fix of this confidence is given."""
        return confidence >= self.threshold

    def trust(self, confidence: float) -> float:
        """The share of its weight that a match of this confidence keeps in a filter over the track."""
        return 1.0 if self.accepts(confidence) else self.doubted


def choose_threshold(
    confidences: Sequence[float],
    errors_m: Sequence[float],
    negatives: Sequence[float] = (),
    *,
    limit_m: float = RIGHT_M,
    precision: float = 0.95,
) -> Acceptance:
    """The lowest threshold from which on the fixes given are expected to be right often enough.

    A few frames cannot tell how often a wrong match is confident, but they tell, roughly, how many matches
    are wrong; matches known to be wrong are cheap, by what searches find where the truth is not. By
    Bayes' rule::

        expected precision = p R / (p R + (1 - p) F)

    with p the share of right frames, R the share of right ones above the threshold and F that of wrong ones,
    negatives included. p and F are pulled to the careful side by one imagined wrong match that is above every
    threshold, p by Laplace's rule: (right + 1) / (frames + 2). With no wrong match known at all, 18 right
    frames are needed for 95 %.

    Args:
        confidences: of matches whose truth is known.
        errors_m: their distances from the truth, metres.
        negatives: confidences of matches that are wrong for certain.
        limit_m: a fix is right if it is less than this away.
        precision: share of right fixes that is asked for.

    Returns:
        the acceptance; if no threshold is expected to reach the precision, the one that comes closest, so its
        ``precision`` must be looked at.

    Raises:
        InputError: no matches, or not as many errors as confidences.
    """
    if not confidences or len(confidences) != len(errors_m):
        raise InputError(
            "a threshold needs matches whose error is known",
            value=f"{len(confidences)} matches, {len(errors_m)} errors",
            hint="calibrate on at least one frame",
        )
    values = np.asarray(confidences, dtype=np.float64)
    good = np.asarray(errors_m, dtype=np.float64) < limit_m
    right = values[good]
    wrong = np.concatenate([values[~good], np.asarray(negatives, dtype=np.float64)])
    prior = (len(right) + 1) / (len(values) + 2)
    best = Acceptance(float("inf"), 0.0, 0.0)
    for threshold in np.unique(right):
        found = prior * np.mean(right >= threshold)
        false = (1 - prior) * (np.count_nonzero(wrong >= threshold) + 1) / (len(wrong) + 1)
        expected = Acceptance(
            float(threshold), float(found / (found + false)), float(np.mean(values >= threshold))
        )
        if expected.precision >= precision:
            return expected
        best = max(best, expected, key=lambda acceptance: acceptance.precision)
    return best


def peak_weights(match: Match) -> tuple[float, ...]:
    """How likely each peak is the right one, for a filter over the track; they sum to less than 1.

    A rule of thumb: weights are the exponential of `PSR_WEIGHT` times the peak's height in deviations of
    the score, and that none is right weighs as much as a peak `WRONG_PSR` deviations above the mean. Both
    numbers are what served a filter over the tracks of two real flights.
    """
    if match.std <= 0:
        return tuple(1 / (len(match.peaks) + 1) for _ in match.peaks)
    heights = [(peak.score - match.mean) / match.std for peak in match.peaks]
    odds = np.exp(PSR_WEIGHT * (np.asarray(heights) - heights[0]))
    total = float(odds.sum() + np.exp(min(PSR_WEIGHT * (WRONG_PSR - heights[0]), 30.0)))
    return tuple(float(one) / total for one in odds)
