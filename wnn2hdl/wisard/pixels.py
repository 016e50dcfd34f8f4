"""Pixel classifiers: trained on histograms of codes, answering from a table of all codes."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Encoder, WisardModel, codes_to_bits, pixel_encoder
from wnn2hdl.ir.model import check_size
from wnn2hdl.wisard.rams import addresses, class_counts


def train_histogram(
    histogram: NDArray[np.int64],
    encoder: Encoder,
    classes: tuple[str, ...],
    mapping: NDArray[np.int64],
    bleaching: int,
    training: dict[str, Any] | None = None,
) -> WisardModel:
    """Train on the number of times each code occurs, which is all that the RAMs can distinguish.

    The counts are those of training on the pixels one by one. They are not evened out between the classes:
    over 8 splits of 30 Sentinel-2 scenes by image, scaling the classes to equal totals lowered the mean
    accuracy on the held-out scenes from 85.0 % to 84.8 %.

    Args:
        histogram: int64 ``[classes, 2**encoder.width]``.
        encoder: what made the codes.
        classes: class names; the first is the background.
        mapping: int64 ``[1 or classes, k, n]``, as `draw_mapping` gives it.
        bleaching: the threshold, as `choose_bleaching` finds it.
        training: what to record in the model's `WisardModel.training`.

    Raises:
        InputError: a class has no pixels, or the discriminators are larger than a model may have them.
    """
    try:
        check_size(len(classes), *mapping.shape[1:])
    except ValueError as error:
        raise InputError(
            "too large a model", value=error, hint="choose fewer RAMs or address bits"
        ) from error
    require_every_class(classes, (pixels.any() for pixels in histogram))
    codes = np.flatnonzero(histogram.any(axis=0))
    where = addresses(codes_to_bits(codes, encoder.width), mapping)
    counts = class_counts(histogram[:, codes], where, mapping.shape[2])
    return WisardModel(encoder, classes, mapping, counts, bleaching, training or {})


def require_every_class(classes: Sequence[str], seen: Iterable[bool | np.bool_]) -> None:
    """Raise InputError unless each class, in the order of ``classes``, was ``seen`` in training pixels."""
    for name, found in zip(classes, seen, strict=True):
        if not found:
            raise InputError(
                "a class has no training pixels", value=name, hint="give images that show every class"
            )


def require_two_classes(classes: Sequence[str], what: str) -> None:
    """Raise InputError unless there are two classes, which is what can be separated by ``what``."""
    if len(classes) != 2:
        raise InputError(
            f"{what} separates two classes",
            value=", ".join(classes),
            hint="train discriminators for more, or merge classes",
        )


class PixelClassifier:
    """A pixel model as the table of all its answers.

    Args:
        model: one of single pixels.

    Attributes:
        table: uint8 ``[2**width]``, the winning class of each code.

    Raises:
        InputError: as `pixel_encoder`.
    """

    def __init__(self, model: WisardModel) -> None:
        encoder = pixel_encoder(model)
        self.table = model.evaluate_all_codes().astype(np.uint8)
        self._encoder = encoder

    def classify(self, image: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Class index of every pixel.

        Args:
            image: uint8 ``S + (3,)``.

        Returns:
            uint8 ``S``.
        """
        return np.take(self.table, self._encoder.codes(image))
