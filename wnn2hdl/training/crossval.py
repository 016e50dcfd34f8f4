"""Cross-validation by image, of anything that trains a pixel model."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import ColourHistogram, Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.images import exposed
from wnn2hdl.ir import WisardModel, picture_encoder, pixel_encoder
from wnn2hdl.progress import Progress, reported
from wnn2hdl.training.folds import training_sets

STRIP = 512
"""Rows of a picture that are classified together."""

Trainer = Callable[[Sequence[int]], WisardModel]
"""Trains a pixel model on the images with these positions."""


EXPOSURES = (0.8, 1.0, 1.25, 1.5)
"""The light under which classifiers are compared, as a factor of that in which the images were taken."""


def cross_validate(images: Sequence[ColourHistogram], train: Trainer) -> float:
    """Share of all pixels that are right when each image is classified by a model that has not seen it.

    See `cross_validated` for the folds and what is raised.
    """
    right = cross_validated(images, train, (1.0,)).sum()
    return float(right / sum(int(image.counts.sum()) for image in images))


def shares_right(images: Sequence[ColourHistogram], train: Trainer) -> NDArray[np.float64]:
    """Share of each image's pixels that are right in each light, by a model that has not seen the image.

    See `cross_validated` for the folds and what is raised.

    Returns:
        float64 ``[images, exposures]``, 0 to 1, for each of `EXPOSURES`.
    """
    right = cross_validated(images, train, EXPOSURES)
    return np.asarray(right / np.array([[image.counts.sum()] for image in images]))


def cross_validated(
    images: Sequence[ColourHistogram], train: Trainer, exposures: Sequence[float]
) -> NDArray[np.int64]:
    """Pixels that are right when each image is classified, in each light, by a model that has not seen it.

    The folds are those of `wnn2hdl.training.folds.training_sets`.

    Args:
        images: the colours of each image.
        train: called once per fold.
        exposures: the light, as a factor.

    Returns:
        int64 ``[images, exposures]``.

    Raises:
        InputError: fewer than two images.
    """
    if len(images) < 2:
        raise InputError("cross-validation by image needs two images", value=len(images), hint="give more")
    folds = training_sets(len(images))
    right = np.zeros((len(images), len(exposures)), dtype=np.int64)
    for fold, others in enumerate(folds):
        model = train(others)
        for i in range(fold, len(images), len(folds)):
            right[i] = [pixels_right(model, images[i], exposure) for exposure in exposures]
    return right


def pixels_right(model: WisardModel, image: ColourHistogram, exposure: float = 1.0) -> int:
    """How many pixels of an image, under more or less light, a model puts into their class."""
    codes = pixel_encoder(model).codes(exposed(image.pixels, exposure))
    answers = model.evaluate_all_codes()[codes]
    return int(image.counts[answers, np.arange(len(answers))].sum())


def pictures_cross_validated(
    dataset: Dataset, train: Trainer, step: str, progress: Progress
) -> NDArray[np.float64]:
    """Share of each image's pixels that a model which looks around, and has not seen it, has right.

    Args:
        dataset: whole images; one is in memory at a time. Folds are those of `cross_validated`.
        train: called once per fold.
        step: what the progress of the folds is called.
        progress: called with each fold.

    Returns:
        float64 ``[judged, exposures]``; an image of which no pixel can be judged says nothing.
    """
    folds = training_sets(len(dataset))
    shares = np.zeros((len(dataset), len(EXPOSURES)))
    for fold, others in enumerate(reported(folds, step, len(folds), progress)):
        model = train(others)
        for i in range(fold, len(dataset), len(folds)):
            shares[i] = picture_shares_right(model, dataset.load(dataset.names[i]))
    return np.asarray(shares[~np.isnan(shares).any(axis=1)])


def picture_shares_right(model: WisardModel, image: LabelledImage) -> NDArray[np.float64]:
    """Share of an image's labelled pixels that a model which looks around puts into their class.

    A picture's borders are repeated outwards; pixels beside one without data are left out.

    Returns:
        float64 ``[exposures]``, for each of `EXPOSURES`; NaN if no pixel can be judged.

    Raises:
        InputError: only some pixels of the image are here.
    """
    encoder = picture_encoder(model)
    halo, answers = encoder.halo, model.evaluate_all_codes()
    labels, used = image.label_picture, image.usable(halo)
    if not used.any():
        return np.full(len(EXPOSURES), np.nan)
    right = np.zeros(len(EXPOSURES))
    padded = np.pad(image.picture, ((halo, halo), (halo, halo), (0, 0)), mode="edge")
    for top in range(0, len(labels), STRIP):
        rows = slice(top, top + STRIP)
        strip = padded[top : top + STRIP + 2 * halo]
        for position, exposure in enumerate(EXPOSURES):
            found = answers[encoder.codes(exposed(strip, exposure))]
            right[position] += (found == labels[rows])[used[rows]].sum()
    return np.asarray(right / used.sum())
