"""What answers for the pixels of a picture: a model, or the circuit that was made of it."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import COLOURS, PictureEncoder, WisardModel, codes_to_bits
from wnn2hdl.pipeline.design import Design
from wnn2hdl.pipeline.evaluation import circuit_answers
from wnn2hdl.pipeline.folder import failure
from wnn2hdl.pipeline.training import picture_encoder
from wnn2hdl.pipeline.verification import open_build


class PictureClassifier(Protocol):
    """A classifier of every pixel of a picture; it can be pickled, and used by several threads at once."""

    @property
    def classes(self) -> tuple[str, ...]:
        """Class names, the background first."""

    @property
    def halo(self) -> int:
        """How many pixels it looks beyond the one it classifies, on each side."""

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Class index of every pixel that has its halo in the picture.

        Args:
            picture: uint8 ``[height, width, 3]``: red, green, blue.

        Returns:
            uint8 ``[height - 2 * halo, width - 2 * halo]``.
        """

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """What `classify` returns, and which of these pixels the training or the care set knows, bool."""


@dataclass(frozen=True, eq=False)
class PixelTable:
    """A classifier that looks a pixel up, or a neighbourhood.

    Attributes:
        classes: class names, the background first.
        encoder: what makes codes of pixels or neighbourhoods.
        answers: uint8 ``[2**width]``, class index of each code.
        care: bool ``[2**width]``, the codes that the circuit was made for, or that the training may have
            seen.
        colours: bool ``[2**COLOURS.width]``, colours that the training saw; None if that is not known.
    """

    classes: tuple[str, ...]
    encoder: PictureEncoder
    answers: NDArray[np.uint8]
    care: NDArray[np.bool_]
    colours: NDArray[np.bool_] | None = None

    @property
    def halo(self) -> int:
        """See `PictureClassifier.halo`."""
        return self.encoder.halo

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """See `PictureClassifier.classify`."""
        return np.take(self.answers, self.encoder.codes(picture))

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """See `PictureClassifier.answer`."""
        codes = self.encoder.codes(picture)
        known = np.ones(codes.shape, dtype=np.bool_) if self.care.all() else np.take(self.care, codes)
        if self.colours is not None:
            height, width = codes.shape
            middle = picture[self.halo : self.halo + height, self.halo : self.halo + width]
            # Codes of the default encoder are those of colours.
            colours = codes if self.encoder == COLOURS else COLOURS.codes(middle)
            known &= np.take(self.colours, colours)
        return np.take(self.answers, codes), known


def open_classifier(path: Path) -> PictureClassifier:
    """The classifier in a model file; or the circuit of a build folder, cared for or not.

    A circuit knows the pixels in its care set that have colours its model was trained on.

    Raises:
        ModelFileError: the file is missing, damaged or no model.
        InputError: the folder is no build or a failed one, or the model reads no pixels.
    """
    if reason := failure(path):
        raise InputError(f"the build failed: {reason}", value=path, mend="compile the model again")
    if path.is_dir():
        design = open_build(path)[0]
        return replace(circuit_classifier(design), colours=_colours(design.model))
    return model_classifier(WisardModel.load(path))


def circuit_classifier(design: Design) -> PixelTable:
    """The classifier that a design's circuit is, cared for or not; it knows what is in its care set."""
    encoder, answers = picture_encoder(design.model), circuit_answers(design.decision)
    # Three classes take two bits, so a circuit may answer a fourth where it is free: taken for the last one.
    answers = np.minimum(answers, len(design.model.classes) - 1)
    care = design.specification.care
    return PixelTable(design.model.classes, encoder, answers.astype(np.uint8), care)


def model_classifier(model: WisardModel) -> PixelTable:
    """The classifier that a model is; raises InputError if it reads no pixels."""
    encoder = picture_encoder(model)
    answers = model.evaluate_all_codes().astype(np.uint8)
    return PixelTable(model.classes, encoder, answers, familiar_codes(model), _colours(model))


def _colours(model: WisardModel) -> NDArray[np.bool_] | None:
    if model.colours is None:
        return None
    return np.isin(np.arange(1 << COLOURS.width), model.colours)


def familiar_codes(model: WisardModel) -> NDArray[np.bool_]:
    """Codes that the training may have seen, bool ``[2**encoder.width]``.

    A code seen in training has a count in every RAM of its class's discriminator. So a code that misses one
    in every class was never seen; one that has them all may be new all the same, put together from parts of
    others.
    """
    bits = codes_to_bits(np.arange(1 << model.encoder.width), model.encoder.width)
    return np.asarray((model.responses(bits, threshold=1) == model.rams).any(axis=1))
