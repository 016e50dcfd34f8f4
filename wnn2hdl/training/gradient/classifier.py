"""`LutNetworkClassifier`: networks of tables trained by gradient, as a scikit-learn estimator."""

from typing import Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.training.gradient.network import Architecture, train_network
from wnn2hdl.training.gradient.teacher import usual_made_up
from wnn2hdl.training.gradient.training import usual_recipe


class LutNetworkClassifier(ClassifierMixin, BaseEstimator):
    """One layer of 6-input look-up tables whose votes are counted class by class; the most votes win.

    Ties go to the class that comes first in `classes_`.

    Args:
        words: format of the words in which hardware reads the features, as ``Q3.12`` or ``UQ8.0``.
        max_luts: how many LUTs the whole compiled network may take, encoder and winner included; None for
            `nodes` for each class, whatever they cost.
        nodes: for each class, where there is no `max_luts`.
        levels: thresholds for each feature.
        grid: rows and columns of the picture whose pixels are the features, row by row; None for no picture.
        distortions: how often each picture is distorted for training; needs a grid.
        made_up: rows that are made up between the samples and labelled by a teacher; 0 for none, None for
            `usual_made_up`.
        epochs: passes over the training samples, made-up rows included; None for `enough_epochs`.
        heat: what votes are divided by in training, in units of the square root of the nodes for each class;
            None for `usual_heat`.
        validation: share of the samples, or of the made-up rows, that is kept for validation.
        random_state: seed of everything that is random.

    Attributes:
        classes_: the labels, ascending.
        model_: the trained `LutGroupModel`; save it with ``model_.save(path)``, and compile it.
        validation_: accuracy on the samples kept for validation, or how often the network agrees with its
            teacher on made-up rows; None if none were kept.
        teacher_: the `Teacher` that labelled made-up rows; None for none.
        luts_: LUTs of the whole network as counted; None without `max_luts`.
    """

    def __init__(
        self,
        words: str = "Q3.12",
        *,
        max_luts: int | None = None,
        nodes: int = 8,
        levels: int = 8,
        grid: tuple[int, int] | None = None,
        distortions: int = 0,
        made_up: int | None = None,
        epochs: int | None = None,
        heat: float | None = None,
        validation: float = 0.1,
        random_state: int = 0,
    ) -> None:
        self.words = words
        self.max_luts = max_luts
        self.nodes = nodes
        self.levels = levels
        self.grid = grid
        self.distortions = distortions
        self.made_up = made_up
        self.epochs = epochs
        self.heat = heat
        self.validation = validation
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Train on numbers ``X`` ``[samples, features]`` with labels ``y`` ``[samples]``.

        Raises:
            ValueError: features that are not finite, one class only, or no such format of words.
            InputError: the features cannot be told apart in this format, or nothing fits `max_luts`.
        """
        features, labels = validate_data(self, X, y, dtype=np.float64)
        check_classification_targets(labels)
        self.classes_, owners = np.unique(labels, return_inverse=True)
        if len(self.classes_) < 2:
            raise ValueError(f"there is one class only, {self.classes_.tolist()}; at least two are needed")
        rows = self.made_up
        if rows is None:
            rows = usual_made_up(len(owners), pictures=self.grid is not None)
        architecture = Architecture(
            words=FixedPoint.parse(self.words),
            nodes=self.nodes,
            max_luts=self.max_luts,
            levels=self.levels,
            grid=self.grid,
            distortions=self.distortions,
            made_up=rows,
            validation=self.validation,
        )
        recipe = usual_recipe(len(owners) + rows, epochs=self.epochs, heat=self.heat, seed=self.random_state)
        names = tuple(str(label) for label in self.classes_)
        trained = train_network(features, owners, names, architecture, recipe, lambda *_: None)
        self.model_ = trained.model
        self.validation_ = trained.validation
        self.luts_ = trained.luts
        self.teacher_ = trained.teacher
        return self

    def decision_function(self, X: ArrayLike) -> NDArray[np.int64]:
        """Votes for each class, int64 ``[samples, classes]``; for two, the second's less the first's."""
        votes = self._votes(X)
        return votes if len(self.classes_) > 2 else votes[:, 1] - votes[:, 0]

    def predict(self, X: ArrayLike) -> NDArray[Any]:
        """The label with the most votes, the first in `classes_` among equals."""
        winners = self._votes(X).argmax(axis=1)
        return cast("NDArray[Any]", self.classes_[winners])

    def _votes(self, X: ArrayLike) -> NDArray[np.int64]:
        check_is_fitted(self)
        features = validate_data(self, X, dtype=np.float64, reset=False)
        return self.model_.responses(self.model_.encoder.bits(features))
