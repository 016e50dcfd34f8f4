"""The circuit of a build as a classifier of pictures."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.build.folder import failure
from wnn2hdl.build.verification import open_build
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PictureClassifier, PixelTable, familiar_colours, model_classifier
from wnn2hdl.ir import WisardModel, all_codes, bits_to_codes, picture_encoder
from wnn2hdl.lower.deforestation import DECISION


def open_classifier(path: Path) -> PictureClassifier:
    """The classifier in a model file; or the circuit of a build folder, cared for or not.

    A circuit knows the pixels in its care set that have colours its model was trained on.

    Raises:
        ModelFileError: the file is missing, damaged or no model.
        InputError: the folder is not a build or a failed one, or the model reads no pixels.
    """
    if reason := failure(path):
        raise InputError(f"the build failed: {reason}", value=path, hint="compile the model again")
    if path.is_dir():
        design = open_build(path)[0]
        return replace(circuit_classifier(design), colours=familiar_colours(design.picture_model))
    return model_classifier(WisardModel.load(path))


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
