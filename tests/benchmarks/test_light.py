"""Classifiers under more light and less are compared as the table says."""

from functools import partial

import numpy as np

from benchmarks.light import SHAPES, by_exposure, threshold
from wnn2hdl.dataset import CLASSES, colour_histogram, from_samples
from wnn2hdl.images import exposed
from wnn2hdl.ir import WisardModel, pixel_encoder
from wnn2hdl.training.crossval import EXPOSURES

WEIGHTS = {"R>=0": (1, 0, 0), "R>=B": (1, 0, -1), "3R>=2B": (3, 0, -2)}
IMAGES = [colour_histogram(image, len(CLASSES)) for image in from_samples(6, 24, seed=2)]


def classes_of(model: WisardModel, pixels: np.ndarray) -> np.ndarray:
    return np.asarray(model.evaluate_all_codes()[pixel_encoder(model).codes(pixels)])


def test_no_threshold_is_better_than_the_one_that_is_found() -> None:
    def right(classes: list[np.ndarray]) -> int:
        pairs = zip(IMAGES, classes, strict=True)
        return sum(int(image.counts[found, np.arange(len(found))].sum()) for image, found in pairs)

    for name, weights in WEIGHTS.items():
        levels = [image.pixels.astype(int) @ weights for image in IMAGES]
        bounds = np.unique(np.concatenate([[-1000, 1000], *levels]))
        best = max(right([(level >= bound).astype(int) for level in levels]) for bound in bounds)
        model = threshold(SHAPES[name], IMAGES)
        assert right([classes_of(model, image.pixels) for image in IMAGES]) == best


def test_each_image_is_judged_in_each_light_by_what_never_saw_it() -> None:
    shares = by_exposure(IMAGES, partial(threshold, SHAPES["R>=0"]))
    unseen = threshold(SHAPES["R>=0"], IMAGES[1:5])
    for place in (0, 5):
        image = IMAGES[place]
        for column, exposure in enumerate(EXPOSURES):
            found = classes_of(unseen, exposed(image.pixels, exposure))
            right = image.counts[found, np.arange(len(found))].sum()
            assert shares[place, column] == right / image.counts.sum()
