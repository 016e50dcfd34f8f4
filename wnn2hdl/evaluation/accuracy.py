"""How often a classifier of pictures, a model or a circuit, names the class that the mask shows."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.progress import Progress, reported


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The outcome over a set of labelled images.

    Attributes:
        names: the images.
        classes: class names, the background first.
        confusion: int64 ``[images, classes, classes]``, pixels by true class (rows) and answer (columns).
        covered: int64 ``[images]``, pixels whose colours the classifier knows.
    """

    names: tuple[str, ...]
    classes: tuple[str, ...]
    confusion: NDArray[np.int64]
    covered: NDArray[np.int64]

    @property
    def accuracy(self) -> float:
        """Share of all pixels that are right, 0 to 1."""
        total = self.confusion.sum(axis=0)
        return float(np.trace(total) / total.sum())

    @property
    def coverage(self) -> float:
        """Share of all pixels whose colours the classifier knows, 0 to 1."""
        return float(self.covered.sum() / self.confusion.sum())


def require_same_classes(classes: tuple[str, ...], dataset: Dataset) -> None:
    """Refuse labels of other classes than a model's, or in another order; raises InputError."""
    if classes != dataset.classes:
        raise InputError(
            "the model and the masks have different classes",
            value=f"{', '.join(classes)} / {', '.join(dataset.classes)}",
            hint="give the masks a palette of the model's classes in their order",
        )


def evaluate(classifier: PictureClassifier, dataset: Dataset, progress: Progress) -> Evaluation:
    """Compare a classifier's answers with the labels of images.

    A classifier that looks at neighbours sees a picture's borders repeated outwards.

    Args:
        classifier: what answers.
        dataset: the images; one is in memory at a time.
        progress: told of each image read.

    Raises:
        InputError: an image cannot be read, the classes are not those of the labels, or the classifier looks
            at neighbours and an image has only some of its pixels labelled.
    """
    require_same_classes(classifier.classes, dataset)
    classes = len(dataset.classes)
    confusion = np.zeros((len(dataset), classes, classes), dtype=np.int64)
    covered = np.zeros(len(dataset), dtype=np.int64)
    for position, image in enumerate(reported(dataset, "evaluating images", len(dataset), progress)):
        picture, labels = _pictures(image, classifier.halo)
        answers, known = classifier.answer(picture)
        cells = labels.astype(np.int64) * classes + answers
        confusion[position] = np.bincount(cells.ravel(), minlength=classes**2).reshape(classes, classes)
        covered[position] = np.count_nonzero(known)
    return Evaluation(dataset.names, dataset.classes, confusion, covered)


def _pictures(image: LabelledImage, halo: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The picture with its halo, and its labels; pixels that make no picture as one row."""
    if image.shape is None and not halo:
        return image.pixels[np.newaxis], image.labels[np.newaxis]
    return with_halo(image.picture, halo), image.label_picture


def with_halo(picture: NDArray[np.uint8], halo: int) -> NDArray[np.uint8]:
    """A picture, uint8 ``[height, width, 3]``, with its borders repeated ``halo`` pixels outwards."""
    return np.pad(picture, ((halo, halo), (halo, halo), (0, 0)), mode="edge")


@dataclass(frozen=True, eq=False)
class SquareVote:
    """A classifier that gives all pixels of a square the class of most of a random share of them.

    It is for whole pictures: squares start at the top left corner of what it is given.

    Attributes:
        each: what classifies the single pixels.
        side: pixels of a square's side.
        share: of a square's pixels that vote, above 0, at most 1.
        seed: of the draw.
    """

    each: PictureClassifier
    side: int
    share: float
    seed: int

    @property
    def classes(self) -> tuple[str, ...]:
        """See `PictureClassifier.classes`."""
        return self.each.classes

    @property
    def halo(self) -> int:
        """See `PictureClassifier.halo`."""
        return self.each.halo

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """See `PictureClassifier.classify`."""
        return self._vote(self.each.classify(picture))

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        """See `PictureClassifier.answer`; the known pixels are the single ones."""
        single, known = self.each.answer(picture)
        return self._vote(single), known

    def _vote(self, single: NDArray[np.uint8]) -> NDArray[np.uint8]:
        return vote(single, None, side=self.side, share=self.share, seed=self.seed, count=len(self.classes))


def majority_labels(dataset: Dataset, side: int) -> Dataset:
    """The same images, every pixel labelled by the majority of its square: the truth about whole squares.

    Raises:
        InputError: when an image is read that has only some of its pixels labelled.
    """

    def load(name: str) -> LabelledImage:
        image = dataset.load(name)
        labels = vote(image.label_picture, None, side=side, share=1.0, seed=0, count=len(dataset.classes))
        return replace(image, labels=labels.ravel())

    return replace(dataset, load=load)
