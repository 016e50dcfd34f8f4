"""The thermometer as a scikit-learn transformer."""

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from wnn2hdl.encode.thermometer import Spacing, fit_thermometer


class ThermometerEncoder(TransformerMixin, BaseEstimator):
    """`fit_thermometer` as a scikit-learn transformer: numbers in, the bits of a `WisardClassifier` out.

    Args:
        bits: thresholds wanted for each feature.
        spacing: where they lie.

    Attributes:
        thermometer_: the fitted encoder.
    """

    def __init__(self, bits: int = 8, spacing: Spacing = "quantiles") -> None:
        self.bits = bits
        self.spacing = spacing

    def fit(self, X: ArrayLike, y: object = None) -> Self:  # noqa: ARG002 - the interface passes y
        """Fit the thresholds to ``X``, finite numbers ``[samples, features]``."""
        array = validate_data(self, X, dtype=np.float64, ensure_min_samples=2)
        self.thermometer_ = fit_thermometer(array, self.bits, self.spacing)
        return self

    def transform(self, X: ArrayLike) -> NDArray[np.bool_]:
        """Bits of ``X``: bool ``[samples, thermometer_.width]``."""
        check_is_fitted(self)
        return self.thermometer_.bits(validate_data(self, X, dtype=np.float64, reset=False))

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.transformer_tags.preserves_dtype = []
        return tags

    def get_feature_names_out(self, input_features: object = None) -> NDArray[Any]:  # noqa: ARG002
        """Names of the bits, as in `Thermometer.names`."""
        check_is_fitted(self)
        return np.asarray(self.thermometer_.names, dtype=object)
