"""How often a model of feature vectors names the class that a table shows."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.measures import confusion_of
from wnn2hdl.ir import FeatureEncoder, WisardModel
from wnn2hdl.ir.models import AnyModel, ClassifierModel, LogicModel, load_model

VectorClassifier = WisardModel | ClassifierModel

SCALER = "scaler"
"""How an imported model says that its features were scaled (see `wnn2hdl.importers.dwn`)."""


def load_vector_classifier(path: Path) -> VectorClassifier:
    """The classifier of feature vectors in a model file; raises InputError for any other file."""
    return require_vector_classifier(load_model(path), path)


def require_vector_classifier(model: AnyModel, path: Path | str) -> VectorClassifier:
    """A model that classifies feature vectors, as it is given; raises InputError for all others."""
    if isinstance(model, LogicModel) or not isinstance(model.encoder, FeatureEncoder):
        raise InputError(
            "the model does not classify feature vectors",
            value=f"{path} (kind {model.kind})",
            hint="measure a model of pixels on pictures and masks",
        )
    return model


def scaled(model: VectorClassifier, table: FeatureTable, raw: bool | None) -> NDArray[np.float64]:
    """A table's features as the model compares them.

    Args:
        model: what will read them.
        table: the samples.
        raw: whether they still have to be scaled; None if that was not said.

    Raises:
        InputError: the model's features are scaled and nothing was said; or it knows of no scaling for raw
            ones, or of one for another number of features.
    """
    known = None if isinstance(model, WisardModel) else model.origin.get(SCALER)
    if known is None:
        if raw:
            raise InputError(
                "the model records no scaling", value="--raw", hint="scale the table and leave --raw out"
            )
        return table.features
    if raw is None:
        raise InputError(
            "the model's features are scaled, and it is not said whether the table's are",
            hint="give --scaled if they are, --raw if they are not",
        )
    if not raw:
        return table.features
    mean, scale = np.asarray(known["mean"]), np.asarray(known["scale"])
    if mean.shape != scale.shape or mean.shape != table.features.shape[1:]:
        raise InputError("the recorded scaling is for another number of features", value=len(mean))
    return np.asarray((table.features - mean) / scale)


def true_classes(classes: tuple[str, ...], table: FeatureTable) -> NDArray[np.int64]:
    """The index of each row's class, int64 ``[samples]``; raises InputError for a label of no class."""
    index = {name: position for position, name in enumerate(classes)}
    foreign = sorted(set(table.labels) - index.keys())
    if foreign:
        raise InputError(
            "the model has no class for a label",
            value=foreign[0],
            hint=f"it has {', '.join(classes[:20])}",
        )
    return np.array([index[name] for name in table.labels])


def row_answers(model: VectorClassifier, table: FeatureTable, raw: bool | None) -> NDArray[np.int64]:
    """The index of the class that a model answers for each row; raises as `feature_answers` and `scaled`."""
    return feature_answers(model, scaled(model, table, raw))


def feature_answers(model: VectorClassifier, features: NDArray[np.float64]) -> NDArray[np.int64]:
    """The index of the class that a model answers for features ``[samples, features]``: int64 ``[samples]``.

    Raises:
        InputError: as `feature_bits`.
    """
    return model.evaluate(feature_bits(model, features))


def feature_bits(model: VectorClassifier, features: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The input bits of a model for features ``[samples, features]``: bool ``[samples, width]``.

    Raises:
        InputError: there are more or fewer features than the model reads, or they are none that it can read.
    """
    encoder = model.encoder
    assert isinstance(encoder, FeatureEncoder)
    if features.shape[1] != encoder.features:
        raise InputError(
            "the table has another number of features than the model reads",
            value=f"{features.shape[1]}, not {encoder.features}",
        )
    try:
        return encoder.bits(features)
    except ValueError as error:
        raise InputError("the model cannot read the features", value=error) from error


def row_confusion(model: VectorClassifier, table: FeatureTable, raw: bool | None) -> NDArray[np.int64]:
    """Samples by true class and a model's answer; raises as `true_classes` and `row_answers`."""
    truth = true_classes(model.classes, table)
    return confusion_of(truth, row_answers(model, table, raw), len(model.classes))
