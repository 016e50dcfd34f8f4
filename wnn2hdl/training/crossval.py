"""Cross-validation by image, of anything that trains a pixel model."""

from collections.abc import Callable, Sequence

import numpy as np

from wnn2hdl.dataset import ColourHistogram
from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, WisardModel

FOLDS = 5

Trainer = Callable[[Sequence[int]], WisardModel]
"""Trains a pixel model on the images with these positions."""


def cross_validate(images: Sequence[ColourHistogram], train: Trainer) -> float:
    """Share of all pixels that are right when each image is classified by a model that has not seen it.

    Image ``i`` is tested in fold ``i % 5``, as `wnn2hdl.dataset.folds` splits sorted names; fewer images
    than that are left out one by one.

    Args:
        images: the colours of each image.
        train: called once per fold.

    Raises:
        InputError: fewer than two images.
    """
    if len(images) < 2:
        raise InputError("cross-validation by image needs two images", value=len(images), hint="give more")
    folds = min(FOLDS, len(images))
    right = 0
    for fold in range(folds):
        model = train([i for i in range(len(images)) if i % folds != fold])
        right += sum(pixels_right(model, image) for image in images[fold::folds])
    return right / sum(int(image.counts.sum()) for image in images)


def pixels_right(model: WisardModel, image: ColourHistogram) -> int:
    """How many pixels of an image a model puts into their class."""
    assert isinstance(model.encoder, BitSelect)
    answers = model.evaluate_all_codes()[model.encoder.codes(image.pixels)]
    return int(image.counts[answers, np.arange(len(answers))].sum())
