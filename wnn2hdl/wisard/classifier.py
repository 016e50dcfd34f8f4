"""`WisardClassifier`: the network as a scikit-learn estimator."""

from typing import Any, Literal, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from wnn2hdl.ir import MAX_TABLE_INPUTS, Encoder, WisardModel, all_codes, bits_to_codes, codes_to_bits
from wnn2hdl.ir.model import check_size
from wnn2hdl.wisard import rams as ram_work
from wnn2hdl.wisard.bleaching import choose_bleaching_for_samples
from wnn2hdl.wisard.mapping import draw_mapping


class WisardClassifier(ClassifierMixin, BaseEstimator):
    """One discriminator per class, trained one against all; the one with the most firing RAMs wins.

    The inputs are bits: ``X`` holds bools, or numbers that are all 0 or 1. Put an encoder in front of other
    features, such as `wnn2hdl.encode.ThermometerEncoder`. Ties go to the class that comes first in
    `classes_`.

    Args:
        address_bits: n, address bits of a RAM. Ignored if a mapping is given.
        rams: k, RAMs of a discriminator. Ignored if a mapping is given.
        mapping: which inputs each RAM reads: ``[k, n]``, or ``[classes, k, n]`` for one mapping per class;
            drawn by `draw_mapping` if left out.
        bleaching: the count from which a RAM fires, or ``"auto"``: the threshold with the best leave-one-out
            accuracy on the samples passed to `fit` or last passed to `partial_fit`.
        random_state: seed of the mapping.

    Attributes:
        classes_: the labels, ascending.
        mapping_: int64 ``[1 or classes, k, n]``; entry 0 is a RAM's least significant address bit.
        counts_: int64 ``[classes, k, 2**n]``, how often each address was seen.
        bleaching_: the threshold in use.
    """

    def __init__(
        self,
        address_bits: int = 4,
        rams: int = 16,
        mapping: ArrayLike | None = None,
        bleaching: int | Literal["auto"] = "auto",
        random_state: int = 0,
    ) -> None:
        self.address_bits = address_bits
        self.rams = rams
        self.mapping = mapping
        self.bleaching = bleaching
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Forget everything and train on bits ``X`` ``[samples, bits]`` with labels ``y`` ``[samples]``.

        Raises:
            ValueError: input that is not binary, one class only, or parameters that do not fit the input.
        """
        return self._train(*self._checked(X, y, reset=True), classes=None)

    def partial_fit(self, X: ArrayLike, y: ArrayLike, classes: ArrayLike | None = None) -> Self:
        """Train on more samples; the mapping and the counts of earlier calls stay.

        Args:
            X: bits, ``[samples, bits]``.
            y: labels, ``[samples]``.
            classes: all labels that will ever come; needed in the first call.

        Raises:
            ValueError: as `fit`; also no classes in the first call, other ones later, or an unknown label.
        """
        first = not hasattr(self, "counts_")
        if first and classes is None:
            raise ValueError("the first call of partial_fit needs classes, all labels that will come")
        if not first and classes is not None and not np.array_equal(np.unique(classes), self.classes_):
            raise ValueError(f"classes {classes} are not those of the first call: {self.classes_}")
        bits, labels = self._checked(X, y, reset=first)
        return self._train(bits, labels, classes=self.classes_ if classes is None else classes, reset=first)

    def responses(self, X: ArrayLike) -> NDArray[np.int64]:
        """Firing RAMs of each discriminator, int64 ``[samples, classes]``, each from 0 to k."""
        check_is_fitted(self)
        bits = _binary(validate_data(self, X, reset=False))
        width = bits.shape[1]
        if width <= MAX_TABLE_INPUTS and len(bits) > 1 << width:
            every_code = codes_to_bits(all_codes(width), width)
            return self._responses(every_code)[bits_to_codes(bits)]
        return self._responses(bits)

    def decision_function(self, X: ArrayLike) -> NDArray[np.int64]:
        """`responses`; for two classes, int64 ``[samples]``: the second class's less the first's."""
        responses = self.responses(X)
        return responses if len(self.classes_) > 2 else responses[:, 1] - responses[:, 0]

    def predict(self, X: ArrayLike) -> NDArray[Any]:
        """The label with the highest response, the first in `classes_` among equals."""
        winner = self.responses(X).argmax(axis=1)
        return cast("NDArray[Any]", self.classes_[winner])

    @property
    def saturation_(self) -> NDArray[np.float64]:
        """Share of each RAM's addresses that fire, ``[classes, k]``; a RAM at 1 carries no information."""
        check_is_fitted(self)
        return np.asarray((self.counts_ >= self.bleaching_).mean(axis=2))

    def model(self, encoder: Encoder) -> WisardModel:
        """The trained network as the compiler reads it.

        Args:
            encoder: what made the bits.

        Raises:
            ValueError: the encoder makes another number of bits than the classifier was trained on.
        """
        check_is_fitted(self)
        if encoder.width != self.n_features_in_:
            raise ValueError(
                f"the encoder makes {encoder.width} bits; the classifier was trained on {self.n_features_in_}"
            )
        names = tuple(str(label) for label in self.classes_)
        return WisardModel(encoder, names, self.mapping_, self.counts_, self.bleaching_)

    def _checked(self, X: ArrayLike, y: ArrayLike, *, reset: bool) -> tuple[NDArray[np.bool_], NDArray[Any]]:
        if self.bleaching != "auto" and not (
            isinstance(self.bleaching, int | np.integer) and self.bleaching >= 1
        ):
            raise ValueError(f"bleaching is {self.bleaching!r}; give 'auto' or a count of at least 1")
        least = self.address_bits if self.mapping is None else 1
        bits, labels = validate_data(self, X, y, reset=reset, ensure_min_features=least)
        check_classification_targets(labels)
        return _binary(bits), labels

    def _train(
        self, bits: NDArray[np.bool_], labels: NDArray[Any], classes: ArrayLike | None, *, reset: bool = True
    ) -> Self:
        if reset:
            self.classes_ = np.unique(labels if classes is None else classes)
            if len(self.classes_) < 2:
                raise ValueError(
                    f"there is one class only, {self.classes_.tolist()}; at least two are needed"
                )
            self.mapping_ = self._mapping(bits.shape[1])
            check_size(len(self.classes_), *self.mapping_.shape[1:])
            size = 1 << self.mapping_.shape[2]
            self.counts_ = np.zeros((len(self.classes_), self.mapping_.shape[1], size), dtype=np.int64)
        if unknown := set(np.unique(labels).tolist()) - set(self.classes_.tolist()):
            raise ValueError(f"labels {sorted(unknown)} are not among the classes {self.classes_}")
        patterns = [_patterns(bits[labels == label]) for label in self.classes_]
        for owner, (rows, weights) in enumerate(patterns):
            mapping = self.mapping_[owner % len(self.mapping_)][np.newaxis]
            for part in ram_work.chunks(len(rows), mapping.shape[1]):
                where = ram_work.addresses(rows[part], mapping)[0]
                self.counts_[owner] += ram_work.count(where, mapping.shape[2], weights[part])
        if self.bleaching == "auto":
            self.bleaching_ = choose_bleaching_for_samples(self.counts_, self.mapping_, patterns)
        else:
            self.bleaching_ = int(self.bleaching)
        return self

    def _mapping(self, width: int) -> NDArray[np.int64]:
        if self.mapping is None:
            return draw_mapping(width, self.rams, self.address_bits, self.random_state)
        given = np.array(self.mapping, dtype=np.int64)
        mapping = given[np.newaxis] if given.ndim == 2 else given
        if mapping.ndim != 3 or mapping.size == 0 or len(mapping) not in (1, len(self.classes_)):
            raise ValueError(f"the mapping has shape {given.shape}; it must be [k, n] or [classes, k, n]")
        if mapping.min() < 0 or mapping.max() >= width:
            raise ValueError(
                f"the mapping reads inputs {mapping.min()} to {mapping.max()}; there are {width}, from 0"
            )
        return mapping

    def _responses(self, bits: NDArray[np.bool_]) -> NDArray[np.int64]:
        fires = self.counts_ >= self.bleaching_
        result = np.empty((len(bits), len(fires)), dtype=np.int64)
        for part in ram_work.chunks(len(bits), self.mapping_[..., 0].size + len(fires)):
            result[part] = ram_work.responses(fires, ram_work.addresses(bits[part], self.mapping_))
        return result


def _binary(array: NDArray[Any]) -> NDArray[np.bool_]:
    if array.dtype != np.bool_ and not ((array == 0) | (array == 1)).all():
        raise ValueError(
            "X must be binary: bools, or numbers that are all 0 or 1; encode other features first, "
            "for instance with wnn2hdl.encode.ThermometerEncoder"
        )
    return array.astype(np.bool_, copy=False)


def _patterns(bits: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """The patterns of one class and how often each occurs; narrow ones are put together by code."""
    width = bits.shape[1]
    if width > MAX_TABLE_INPUTS:
        return bits, np.ones(len(bits), dtype=np.int64)
    codes, weights = np.unique(bits_to_codes(bits), return_counts=True)
    return codes_to_bits(codes, width), weights.astype(np.int64)
