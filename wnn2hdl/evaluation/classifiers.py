"""What answers for the pixels of a picture: a model, or any table of its codes."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import COLOURS, PictureEncoder, WisardModel, all_codes, codes_to_bits, picture_encoder


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


def model_classifier(model: WisardModel) -> PixelTable:
    """The classifier that a model is; raises InputError as `picture_encoder`."""
    encoder = picture_encoder(model)
    answers = model.evaluate_all_codes().astype(np.uint8)
    return PixelTable(model.classes, encoder, answers, familiar_codes(model), familiar_colours(model))


def familiar_colours(model: WisardModel) -> NDArray[np.bool_] | None:
    """Colours that the training saw, bool ``[2**COLOURS.width]``; None if the model does not record them."""
    if model.colours is None:
        return None
    return np.isin(np.arange(1 << COLOURS.width), model.colours)


def familiar_codes(model: WisardModel) -> NDArray[np.bool_]:
    """Codes that the training may have seen, bool ``[2**encoder.width]``.

    A code seen in training has a count in every RAM of its class's discriminator. So a code that misses one
    in every class was never seen; one that has them all may be new all the same, put together from parts of
    others.
    """
    bits = codes_to_bits(all_codes(model.encoder.width), model.encoder.width)
    return np.asarray((model.responses(bits, threshold=1) == model.rams).any(axis=1))
