"""Thermometers fitted to features that are not bytes."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer


def fit_thermometer(features: ArrayLike, bits: int) -> Thermometer:
    """A thermometer whose thresholds split each feature's samples into ``bits + 1`` parts of equal size.

    Thresholds are values that occur, taken at the quantiles ``1/(bits+1) … bits/(bits+1)``. Where many
    samples share a value and quantiles fall together, they are spread over the distinct values instead. So a
    feature with few distinct values gets one threshold for each but the lowest, a constant one gets none.

    Args:
        features: finite numbers, ``[samples, features]``.
        bits: thresholds wanted for each feature, at least 1.

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
    thresholds = tuple(tuple(_levels(column, bits).tolist()) for column in columns.T)
    if not any(thresholds):
        raise InputError(
            "every feature is constant", value=f"{columns.shape[1]} features", hint="give others"
        )
    return Thermometer(thresholds)


def _levels(column: NDArray[np.float64], bits: int) -> NDArray[np.float64]:
    """Rising thresholds of one feature, none of them its minimum: that bit would always be set."""
    above = np.unique(column)[1:]
    if len(above) > bits:
        parts = np.arange(1, bits + 1) / (bits + 1)
        levels = np.unique(np.quantile(column, parts, method="higher"))
        if len(levels) == bits and levels[0] >= above[0]:
            return levels
    spread = np.linspace(0, len(above) - 1, min(bits, len(above)))
    return above[np.round(spread).astype(np.int64)]
