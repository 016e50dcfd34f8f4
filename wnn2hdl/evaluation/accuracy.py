"""How often a classifier of pictures, a model or a circuit, names the class that the mask shows."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.evaluation.measures import confusion_of
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.images import whole_windows
from wnn2hdl.progress import Progress, reported


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The outcome over a set of labelled images.

    Attributes:
        names: the images.
        classes: class names, the background first.
        confusion: int64 ``[images, classes, classes]``, pixels by true class (rows) and answer (columns).
        covered: int64 ``[images]``, pixels whose colours the classifier knows.
        left_out: int64 ``[images]``, pixels that are unlabelled, without data, or beside one without data.
    """

    names: tuple[str, ...]
    classes: tuple[str, ...]
    confusion: NDArray[np.int64]
    covered: NDArray[np.int64]
    left_out: NDArray[np.int64]

    @property
    def accuracy(self) -> float:
        """Share of all measured pixels that are right, 0 to 1."""
        total = self.confusion.sum(axis=0)
        return float(np.trace(total) / total.sum())

    @property
    def coverage(self) -> float:
        """Share of all measured pixels whose colours the classifier knows, 0 to 1."""
        return float(self.covered.sum() / self.confusion.sum())

    @property
    def left_out_share(self) -> float:
        """Share of all pixels that are left out, 0 to 1."""
        left_out = self.left_out.sum()
        return float(left_out / (left_out + self.confusion.sum()))


@dataclass(frozen=True)
class Squares:
    """Squares whose pixels all get the class of most of a random share of them.

    Attributes:
        side: pixels of a square's side; squares start at a picture's top left corner.
        share: of a square's pixels that vote, above 0, at most 1.
        seed: of the draw.
    """

    side: int
    share: float
    seed: int


def require_same_classes(classes: tuple[str, ...], dataset: Dataset) -> None:
    """Refuse labels whose classes are not the model's, or in another order; raises InputError."""
    if classes != dataset.classes:
        raise InputError(
            "the model and the masks have different classes",
            value=f"{', '.join(classes)} / {', '.join(dataset.classes)}",
            hint="give the masks a palette of the model's classes in their order",
        )


def evaluate(
    classifier: PictureClassifier, dataset: Dataset, progress: Progress, squares: Squares | None = None
) -> Evaluation:
    """Compare a classifier's answers with the labels of images.

    A classifier that looks at neighbours sees a picture's borders repeated outwards, and is not asked about
    pixels beside one without data.

    Args:
        classifier: what answers.
        dataset: the images; one is in memory at a time.
        progress: called with each image read.
        squares: let the pixels of squares vote, those that are data; None for each pixel by itself.

    Raises:
        InputError: an image cannot be read, the classes are not those of the labels, no pixel can be
            measured, or neighbours or squares are needed and an image has only some of its pixels here.
    """
    require_same_classes(classifier.classes, dataset)
    classes = len(dataset.classes)
    confusion = np.zeros((len(dataset), classes, classes), dtype=np.int64)
    covered, left_out = np.zeros((2, len(dataset)), dtype=np.int64)
    for position, image in enumerate(reported(dataset, "evaluating images", len(dataset), progress)):
        answers, known, labels = labelled_answers(classifier, image, squares)
        confusion[position] = confusion_of(labels, answers, classes)
        covered[position] = np.count_nonzero(known)
        left_out[position] = 0 if image.shape is None else np.prod(image.shape) - len(labels)
    if not confusion.any():
        raise InputError(
            "no pixel can be measured",
            value=f"{len(dataset)} images",
            hint="give images with labelled pixels",
        )
    return Evaluation(dataset.names, dataset.classes, confusion, covered, left_out)


def labelled_answers(
    classifier: PictureClassifier, image: LabelledImage, squares: Squares | None
) -> tuple[NDArray[np.uint8], NDArray[np.bool_], NDArray[np.uint8]]:
    """What a classifier answers for the measured pixels of an image.

    Args:
        classifier: what answers.
        image: the image.
        squares: as of `evaluate`.

    Returns:
        The class of each pixel, whether the classifier knows its colours, and its label, each ``[n]``.

    Raises:
        InputError: neighbours or squares are needed, and the image has only some of its pixels here.
    """
    if image.shape is None and not classifier.halo and squares is None:
        answers, known = (x[0] for x in classifier.answer(image.pixels[np.newaxis]))
        return answers, known, image.labels
    answers, known = classifier.answer(with_halo(image.picture, classifier.halo))
    if squares is not None:
        valid = None if image.scene is None else whole_windows(image.scene.valid, classifier.halo)
        answers = vote(
            answers,
            valid,
            side=squares.side,
            share=squares.share,
            seed=squares.seed,
            count=len(classifier.classes),
        )
    used = image.usable(classifier.halo)
    return answers[used], known[used], image.label_picture[used]


def with_halo(picture: NDArray[np.uint8], halo: int) -> NDArray[np.uint8]:
    """A picture, uint8 ``[height, width, 3]``, with its borders repeated ``halo`` pixels outwards."""
    return np.pad(picture, ((halo, halo), (halo, halo), (0, 0)), mode="edge")


def majority_labels(dataset: Dataset, side: int) -> Dataset:
    """The same images, every labelled pixel of the class of most of its square: the truth about squares.

    Raises:
        InputError: when an image is read that has only some of its pixels labelled.
    """

    def load(name: str) -> LabelledImage:
        image = dataset.load(name)
        used = image.usable(0)
        classes = np.where(used, image.label_picture, 0)
        majority = vote(classes, used, side=side, share=1.0, seed=0, count=len(dataset.classes))
        return replace(image, labels=majority[used])

    return replace(dataset, load=load)
