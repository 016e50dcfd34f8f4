"""How often a model or a circuit is right."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.api.builds import Build
from wnn2hdl.api.models import Masks, Model, Pictures, feature_table, labelled
from wnn2hdl.api.progress import watched
from wnn2hdl.api.showing import Shown
from wnn2hdl.build.classifier import circuit_row_answers, open_classifier, open_working_build
from wnn2hdl.build.design import require_picture_model
from wnn2hdl.dataset import Dataset
from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.evaluation.accuracy import evaluate as compare
from wnn2hdl.evaluation.classifiers import PixelTable, model_classifier
from wnn2hdl.evaluation.measures import (
    ClassScores,
    accuracy,
    class_scores,
    confusion_of,
    defined,
    interval,
    kappa,
    wilson,
)
from wnn2hdl.evaluation.rows import require_vector_classifier, row_answers, true_classes
from wnn2hdl.progress import Progress


@dataclass(frozen=True, eq=False, repr=False)
class Measured(Shown):
    """How often answers are right.

    Attributes:
        classes: class names.
        confusion: int64 ``[classes, classes]``, pixels or rows by true class (rows) and answer (columns).
        interval: of the accuracy, which holds it with the probability 0.95 for other images (drawn again as
            wholes) or rows of the same kind; None of a single image.
    """

    classes: tuple[str, ...]
    confusion: NDArray[np.int64]
    interval: tuple[float, float] | None

    @property
    def accuracy(self) -> float:
        """Share that is right, 0 to 1."""
        return float(accuracy(self.confusion))

    @property
    def kappa(self) -> float | None:
        """Cohen's kappa; None where it is undefined."""
        return defined(kappa(self.confusion))

    @property
    def per_class(self) -> dict[str, ClassScores]:
        """Precision, recall, F1 and intersection over union of each class."""
        return dict(zip(self.classes, class_scores(self.confusion), strict=True))

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        return f"Accuracy {self.accuracy:.2%} of {int(self.confusion.sum()):,}"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        found = {}
        if self.interval is not None:
            found["interval, 95 %"] = f"{self.interval[0]:.2%} to {self.interval[1]:.2%}"
        if self.kappa is not None:
            found["kappa"] = f"{self.kappa:.4f}"
        scores = list(self.per_class.items())[:10]
        return found | {f"IoU of {name}": f"{one.iou:.4f}" for name, one in scores if one.iou is not None}


def evaluate(
    subject: Model | Build | Path | str,
    images: Pictures | Dataset,
    masks: Masks | None = None,
    *,
    seed: int = 0,
    progress: Progress | None = None,
) -> Measured:
    """Measure a classifier of pixels on labelled pictures.

    Args:
        subject: a model; or a build, whose circuit is measured; or the file or folder of one.
        images: as of `train`.
        masks: as of `train`.
        seed: of the resamples behind the interval.
        progress: called with each image; by default a line is shown where somebody watches.

    Raises:
        InputError: the subject reads no pixels, or the images or masks cannot be used.
    """
    with watched(progress) as report:
        found = compare(classifier(subject), labelled(images, masks), report)
    return Measured(found.classes, found.confusion.sum(axis=0), interval(found.confusion, accuracy, seed))


def evaluate_table(
    subject: Model | Build,
    features: ArrayLike | FeatureTable,
    labels: Sequence[str] | NDArray[np.generic] | None = None,
    *,
    raw: bool | None = None,
) -> Measured:
    """Measure a classifier of feature vectors.

    Args:
        subject: a model; or a build, whose circuit is measured through its words.
        features: finite numbers ``[samples, features]``; or a table that has the labels, too.
        labels: the class of each.
        raw: whether the features still have to be scaled as the model records; needed if it records that.

    Raises:
        InputError: the subject reads no features, or the rows do not fit it.
    """
    rows = feature_table(features, labels)
    design = open_working_build(subject.folder) if isinstance(subject, Build) else None
    network = subject.model if isinstance(subject, Model) else design.model if design else None
    assert network is not None
    model = require_vector_classifier(network, "the model given")
    truth = true_classes(model.classes, rows)
    answers = row_answers(model, rows, raw) if design is None else circuit_row_answers(design, rows, raw)
    confusion = confusion_of(truth, answers, len(model.classes))
    return Measured(model.classes, confusion, wilson(confusion))


def classifier(subject: Model | Build | Path | str) -> PixelTable:
    """The classifier of pixels that is meant; raises InputError if it is none."""
    if isinstance(subject, Model):
        return model_classifier(require_picture_model(subject.model))
    return open_classifier(subject.folder if isinstance(subject, Build) else Path(subject))
