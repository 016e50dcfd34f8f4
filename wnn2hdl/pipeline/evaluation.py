"""How often a model, or the circuit made of it, names the class that the mask shows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset
from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, LutNetwork, bits_to_codes
from wnn2hdl.pipeline.training import Progress


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The outcome over a set of labelled images.

    Attributes:
        names: the images.
        confusion: int64 ``[images, classes, classes]``, pixels by true class (rows) and answer (columns).
        codes: int64 ``[2**width]``, pixels of each code over all images.
    """

    names: tuple[str, ...]
    confusion: NDArray[np.int64]
    codes: NDArray[np.int64]

    @property
    def accuracy(self) -> float:
        """Share of all pixels that are right, 0 to 1."""
        total = self.confusion.sum(axis=0)
        return float(np.trace(total) / total.sum())

    @property
    def accuracies(self) -> dict[str, float]:
        """The same for each image."""
        right = np.trace(self.confusion, axis1=1, axis2=2)
        return {
            name: float(r / n)
            for name, r, n in zip(self.names, right, self.confusion.sum(axis=(1, 2)), strict=True)
        }


def evaluate(
    answers: NDArray[np.integer], encoder: BitSelect, dataset: Dataset, progress: Progress
) -> Evaluation:
    """Compare a classifier's answers with the labels of images.

    Args:
        answers: class index for every code, ``[2**encoder.width]``: a pixel classifier is this table.
        encoder: what makes codes of pixels.
        dataset: the images; one is in memory at a time.
        progress: told of each image read.

    Raises:
        InputError: an image cannot be read, or a label is none of the classifier's classes.
    """
    classes = len(dataset.classes)
    if answers.max() >= classes:
        raise InputError(
            "the model has more classes than the masks",
            value=f"{answers.max() + 1} and {classes}",
            mend="give masks with a palette of the model's classes",
        )
    confusion = np.zeros((len(dataset), classes, classes), dtype=np.int64)
    seen = np.zeros(len(answers), dtype=np.int64)
    for position, image in enumerate(dataset):
        codes = encoder.codes(image.pixels)
        seen += np.bincount(codes, minlength=len(answers))
        cells = image.labels.astype(np.int64) * classes + answers[codes]
        confusion[position] = np.bincount(cells, minlength=classes**2).reshape(classes, classes)
        progress("evaluating images", position + 1, len(dataset))
    return Evaluation(dataset.names, confusion, seen)


def circuit_answers(network: LutNetwork) -> NDArray[np.int64]:
    """Class index for every code as the circuit computes it, cared for or not: int64 ``[2**width]``."""
    return bits_to_codes(network.evaluate(np.arange(1 << len(network.inputs))))
