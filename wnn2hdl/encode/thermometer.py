"""Thermometers fitted to features that are not bytes."""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.fixed_point import MAX_WORD_BITS, FixedPoint

Spacing = Literal["quantiles", "uniform", "gaussian"]
"""Where thresholds lie: parts of equal size by number of samples, by range, or by a normal distribution."""


def fit_thermometer(
    features: ArrayLike, bits: int, spacing: Spacing = "quantiles", words: FixedPoint | None = None
) -> Thermometer:
    """A thermometer whose thresholds split each feature's samples into ``bits + 1`` parts.

    With ``quantiles`` the parts hold equally many samples. These thresholds are values that occur, taken at
    the quantiles ``1/(bits+1) … bits/(bits+1)``; where many samples share a value and quantiles fall
    together, they are spread over the distinct values instead. With ``uniform`` the parts are equally wide,
    from the lowest sample to the highest. With ``gaussian`` they are equally probable under a normal
    distribution of the samples' mean and standard deviation, as in BTHOWeN.

    No threshold is kept that no sample or every sample reaches: a constant feature gets none.

    Args:
        features: finite numbers, ``[samples, features]``.
        bits: thresholds wanted for each feature, at least 1.
        spacing: where the thresholds lie.
        words: the format in which hardware reads the features. They are turned into such words first, and
            thresholds become words by rounding up, which changes no answer.

    Raises:
        InputError: no samples, numbers that are not finite, no bits, or nothing but constant features.
    """
    columns = np.asarray(features, dtype=np.float64)
    if columns.ndim != 2 or columns.size == 0:
        raise InputError("features must be a filled array [samples, features]", value=columns.shape)
    if not np.isfinite(columns).all():
        raise InputError(
            "a feature is not finite", value="NaN or infinity", hint="drop or fill such samples first"
        )
    if bits < 1:
        raise InputError("a feature cannot have this number of bits", value=bits, hint="choose at least 1")
    if words is not None:
        columns = words.values(words.words(columns))
    thresholds = []
    for column in columns.T:
        levels = _PLACES[spacing](column, bits)
        if words is not None:
            levels = np.ldexp(np.ceil(np.ldexp(levels, words.fraction)), -words.fraction)
        distinct = np.unique(levels)
        kept = distinct[(distinct > column.min()) & (distinct <= column.max())]
        thresholds.append(tuple(kept.tolist()))
    if not any(thresholds):
        raise InputError(
            "every feature is constant", value=f"{columns.shape[1]} features", hint="give others"
        )
    return Thermometer(tuple(thresholds), input=words)


def whole_words(features: ArrayLike) -> FixedPoint | None:
    """The narrowest format without a fraction that holds all features, as ``UQ8.0``.

    Where thresholds are whole numbers among these, words of this format give every number its own bits,
    fractions and numbers outside of the range included: they are rounded down, and saturate.

    Args:
        features: finite numbers, ``[samples, features]``.

    Returns:
        None if a feature is not a whole number, or too large for a word.
    """
    numbers = np.asarray(features, dtype=np.float64)
    lowest, highest = float(numbers.min()), float(numbers.max())
    if not np.array_equal(np.floor(numbers), numbers):
        return None
    signed = lowest < 0
    bits = max(int(-lowest - 1 if signed else 0).bit_length(), int(max(highest, 0)).bit_length()) + signed
    return FixedPoint(max(bits, 1), 0, signed) if bits <= MAX_WORD_BITS else None


def _quantiles(column: NDArray[np.float64], bits: int) -> NDArray[np.float64]:
    """Rising thresholds of one feature, none of them its minimum: that bit would always be set."""
    above = np.unique(column)[1:]
    if len(above) > bits:
        levels = np.unique(np.quantile(column, _parts(bits), method="higher"))
        if len(levels) == bits and levels[0] >= above[0]:
            return levels
    spread = np.linspace(0, len(above) - 1, min(bits, len(above)))
    return above[np.round(spread).astype(np.int64)]


def _uniform(column: NDArray[np.float64], bits: int) -> NDArray[np.float64]:
    # Weighted, since the difference of two large numbers may be infinite.
    parts = _parts(bits)
    return np.asarray((1 - parts) * column.min() + parts * column.max())


def _gaussian(column: NDArray[np.float64], bits: int) -> NDArray[np.float64]:
    from scipy.stats import norm

    return np.asarray(column.mean() + column.std() * norm.ppf(_parts(bits)))


def _parts(bits: int) -> NDArray[np.float64]:
    return np.arange(1, bits + 1) / (bits + 1)


_PLACES = {"quantiles": _quantiles, "uniform": _uniform, "gaussian": _gaussian}
