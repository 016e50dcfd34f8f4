"""What answers for the pixels of a picture: a model, or the circuit that was made of it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import BitSelect, WisardModel, codes_to_bits
from wnn2hdl.pipeline.evaluation import circuit_answers
from wnn2hdl.pipeline.training import pixel_encoder
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

    def covered(self, picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Of the same pixels, those whose colours the training or the care set knows; the same shape."""


@dataclass(frozen=True, eq=False)
class PixelTable:
    """A classifier that looks at one pixel: two tables over its codes.

    Attributes:
        classes: class names, the background first.
        encoder: what makes codes of pixels.
        answers: uint8 ``[2**width]``, class index of each code.
        known: bool ``[2**width]``, codes that the training or the care set knows.
    """

    classes: tuple[str, ...]
    encoder: BitSelect
    answers: NDArray[np.uint8]
    known: NDArray[np.bool_]

    @property
    def halo(self) -> int:
        """None of the neighbours is looked at."""
        return 0

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """See `PictureClassifier.classify`."""
        return np.take(self.answers, self.encoder.codes(picture))

    def covered(self, picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """See `PictureClassifier.covered`."""
        return np.take(self.known, self.encoder.codes(picture))


def open_classifier(path: Path) -> PictureClassifier:
    """The classifier in a model file; or the circuit of a build folder, cared for or not.

    Raises:
        ModelFileError: the file is missing, damaged or no model.
        InputError: the folder is no build, or the model reads no pixels.
    """
    if path.is_dir():
        design, _, _ = open_build(path)
        encoder, answers = pixel_encoder(design.model), circuit_answers(design.pixel)
        known = design.specification.pixel_care
        return PixelTable(design.model.classes, encoder, answers.astype(np.uint8), known)
    return model_classifier(WisardModel.load(path))


def model_classifier(model: WisardModel) -> PictureClassifier:
    """The classifier that a model is; raises InputError if it reads no pixels."""
    encoder = pixel_encoder(model)
    answers = model.evaluate_all_codes().astype(np.uint8)
    return PixelTable(model.classes, encoder, answers, familiar_codes(model))


def familiar_codes(model: WisardModel) -> NDArray[np.bool_]:
    """Codes that the training may have seen, bool ``[2**encoder.width]``.

    A code seen in training has a count in every RAM of its class's discriminator. So a code that misses one
    in every class was never seen; one that has them all may be new all the same, put together from parts of
    others.
    """
    bits = codes_to_bits(np.arange(1 << model.encoder.width), model.encoder.width)
    return np.asarray((model.responses(bits, threshold=1) == model.rams).any(axis=1))
