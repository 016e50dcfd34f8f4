"""How right a build is on labelled data: its circuit, and the model that it was given."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.classifier import circuit_classifier, circuit_row_answers
from wnn2hdl.build.design import Design, require_picture_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset import Dataset, from_masks
from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import evaluate, require_same_classes
from wnn2hdl.evaluation.classifiers import PixelTable, model_classifier
from wnn2hdl.evaluation.light import REPORTED, brighter_figures, brighter_warning, light_curve
from wnn2hdl.evaluation.measures import accuracy, confusion_of, wilson
from wnn2hdl.evaluation.rows import require_vector_classifier, row_answers, true_classes
from wnn2hdl.images import MaskFormat, Palette
from wnn2hdl.ir.models import AnyModel
from wnn2hdl.progress import Progress
from wnn2hdl.report import LightFigures, RowFigures

SEED = 0
"""Of the bootstrap."""


@dataclass(frozen=True, eq=False)
class LabelledRows:
    """Labelled feature vectors, and what the model as it was given answers.

    Attributes:
        table: the rows.
        raw: whether their features still have to be scaled; None if the model records no scaling.
        truth: class index of each, int64 ``[samples]``.
        answers: the model's, int64 ``[samples]``.
    """

    table: FeatureTable
    raw: bool | None
    truth: NDArray[np.int64]
    answers: NDArray[np.int64]


@dataclass(frozen=True)
class Measured:
    """What labelled data show; None where there were none, or no classifier to show them."""

    accuracy: float | None = None
    model_accuracy: float | None = None
    coverage: float | None = None
    confusion: tuple[tuple[int, ...], ...] | None = None
    left_out: float | None = None
    light: LightFigures = field(default_factory=LightFigures)
    rows: RowFigures = field(default_factory=RowFigures)


def labelled_data(model: AnyModel, options: CompileOptions) -> Dataset | LabelledRows | None:
    """The labelled pictures or rows that the options name.

    Raises:
        InputError: half of what it takes is named, or both kinds; the data have other classes than the
            model, or the model cannot read them.
    """
    if options.test_table is not None:
        if options.test_images or options.test_masks or options.palette or options.ignore:
            raise InputError("--test-table has no pictures", hint="leave the options for pictures out")
        classifier = require_vector_classifier(model, "the model given")
        table = read_table(options.test_table, options.label)
        truth = true_classes(classifier.classes, table)
        return LabelledRows(table, options.raw, truth, row_answers(classifier, table, options.raw))
    if options.label is not None or options.raw is not None:
        raise InputError("--label and --raw or --scaled are for tables", hint="give --test-table too")
    pictures = _test_pictures(options)
    if pictures is not None:
        require_same_classes(require_picture_model(model).classes, pictures)
    return pictures


def _test_pictures(options: CompileOptions) -> Dataset | None:
    if options.test_images is None or options.test_masks is None:
        if options.test_images or options.test_masks:
            raise InputError(
                "these options go together", value="--test-images and --test-masks", hint="give both"
            )
        if options.palette or options.ignore:
            raise InputError("--palette and --ignore are for masks", hint="give --test-masks too")
        return None
    palette = Palette.read(options.palette) if options.palette else None
    masks = MaskFormat(palette, frozenset(options.ignore or ()))
    return from_masks(options.test_images, options.test_masks, masks, options.reading)


def measure(design: Design, data: Dataset | LabelledRows | None, progress: Progress) -> Measured:
    """Measure a design's circuit, and the model, on what `labelled_data` found."""
    if isinstance(data, LabelledRows):
        return _measure_rows(design, data)
    if data is None or not design.target.classifies:
        return Measured()
    classifier = circuit_classifier(design)
    circuit = evaluate(classifier, data, progress)
    model = evaluate(model_classifier(design.picture_model), data, progress)
    return Measured(
        circuit.accuracy,
        model.accuracy,
        circuit.coverage,
        tuple(map(tuple, circuit.confusion.sum(axis=0).tolist())),
        circuit.left_out_share,
        _measure_light(classifier, data, progress),
    )


def _measure_light(circuit: PixelTable, data: Dataset, progress: Progress) -> LightFigures:
    curves = {
        quantity: light_curve(circuit, data, quantity, values, progress)
        for quantity, values in REPORTED.items()
    }
    warning = brighter_warning(brighter_figures(curves["exposure"].shares, circuit.encoder))
    return LightFigures(
        {quantity: tuple(curve.figures(SEED)) for quantity, curve in curves.items()}, warning or None
    )


def _measure_rows(design: Design, rows: LabelledRows) -> Measured:
    answers = circuit_row_answers(design, rows.table, rows.raw)
    classes = len(require_vector_classifier(design.model, "the design's").classes)
    circuit, model = (confusion_of(rows.truth, found, classes) for found in (answers, rows.answers))
    return Measured(
        accuracy=float(accuracy(circuit)),
        model_accuracy=float(accuracy(model)),
        confusion=tuple(map(tuple, circuit.tolist())),
        rows=RowFigures(
            count=len(answers),
            interval=wilson(circuit),
            model_interval=wilson(model),
            changed=int((answers != rows.answers).sum()),
        ),
    )
