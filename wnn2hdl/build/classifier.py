"""The circuit of a build as a classifier of pictures, or of feature vectors."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.build.folder import failure
from wnn2hdl.build.verification import open_build
from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PixelTable, familiar_colours, model_classifier
from wnn2hdl.evaluation.rows import scaled
from wnn2hdl.ir import FeatureEncoder, WisardModel, all_codes, bits_to_codes, picture_encoder
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.lower.deforestation import DECISION


def open_classifier(path: Path) -> PixelTable:
    """The classifier in a model file; or the circuit of a build folder, cared for or not.

    A circuit knows the pixels in its care set that have colours its model was trained on.

    Raises:
        ModelFileError: the file is missing, damaged or no model.
        InputError: the folder is not a build or a failed one, or the model reads no pixels.
    """
    if path.is_dir():
        design = open_working_build(path)
        return replace(circuit_classifier(design), colours=familiar_colours(design.picture_model))
    return model_classifier(WisardModel.load(path))


def open_working_build(folder: Path) -> Design:
    """The design of a build.

    Raises:
        ModelFileError: one of its files is missing or damaged.
        InputError: the folder is not a build, or a failed one.
    """
    if reason := failure(folder):
        raise InputError(f"the build failed: {reason}", value=folder, hint="compile the model again")
    return open_build(folder)[0]


def circuit_classifier(design: Design) -> PixelTable:
    """The classifier that a design's circuit is, cared for or not; it knows what is in its care set."""
    care = design.care
    if care is None:
        raise InputError("a circuit without a classifier has no classes", value=design.target.name)
    model = design.picture_model
    # Three classes take two bits, so a circuit may answer a fourth where it is free: taken for the last one.
    answers = np.minimum(circuit_answers(design), len(model.classes) - 1).astype(np.uint8)
    cared = care.project(tuple(range(care.width)))
    return PixelTable(model.classes, picture_encoder(model), answers, cared)


def circuit_answers(design: Design) -> NDArray[np.int64]:
    """Class index for every code as the circuit computes it, cared for or not: int64 ``[2**width]``."""
    decision = next(table for table in design.circuit.tables().values() if table.name == DECISION)
    return bits_to_codes(decision.function.evaluate(all_codes(len(decision.function.inputs))))


def circuit_row_answers(design: Design, table: FeatureTable, raw: bool | None) -> NDArray[np.int64]:
    """Class index for every row of a table as the circuit computes it, through words: int64 ``[samples]``.

    Args:
        design: of a network of features.
        table: the rows, which the model can read.
        raw: whether the features still have to be scaled, see `wnn2hdl.evaluation.rows.scaled`.
    """
    model = design.model
    assert not isinstance(model, LogicModel)
    encoder = model.encoder
    assert isinstance(encoder, FeatureEncoder)
    inputs = {"features": encoder.port_bits(scaled(model, table, raw))}
    return bits_to_codes(design.circuit.evaluate(inputs)["class_bits"]).astype(np.int64)
