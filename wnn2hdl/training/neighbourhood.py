"""Training of models that look at a pixel's neighbours."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel
from wnn2hdl.progress import Progress, reported
from wnn2hdl.training.bitselect import LEAST_SHARE, LUTS, main_drift, select_neighbourhood
from wnn2hdl.training.budget import LIGHT
from wnn2hdl.training.crossval import EXPOSURES, pictures_cross_validated
from wnn2hdl.training.folds import training_sets
from wnn2hdl.training.promise import light_figures

WINDOWS = 8000
"""Windows drawn from each image, wherever they lie wholly inside data; more changed little."""


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Windows of one image.

    Attributes:
        windows: uint8 ``[n, size, size, 3]``.
        labels: the classes of their middles, uint8 ``[n]``.
        mean: colour of its background, float64 ``[3]``; None if it has hardly any.
    """

    windows: NDArray[np.uint8]
    labels: NDArray[np.uint8]
    mean: NDArray[np.float64] | None


def train_neighbourhood(
    dataset: Dataset, size: int, *, luts_per_pixel: int | None, seed: int, progress: Progress
) -> WisardModel:
    """The classifier that reads six tables over the window around a pixel by one LUT.

    What it promises is measured in cross-validation by image, unless there is one image, or a class that only
    the images of one fold show.

    Args:
        dataset: whole images; one is in memory at a time.
        size: rows and columns of the window, 3 or 5.
        luts_per_pixel: how many LUTs the user allows; None sets no limit.
        seed: of the windows drawn and of the search.
        progress: called with each image read and each table chosen.

    Raises:
        InputError: an image cannot be read, is smaller than a window or labelled in part only, a class has no
            pixel, there are not two classes, or more LUTs are needed.
    """
    if luts_per_pixel is not None and luts_per_pixel < LUTS:
        raise InputError(
            f"a neighbourhood takes {LUTS} LUTs",
            value=f"{luts_per_pixel} allowed",
            hint="allow more, or train without --neighbourhood",
        )
    images = []
    for position, image in enumerate(reported(dataset, "reading images", len(dataset), progress)):
        windows, labels = _draw(image, size, np.random.default_rng([seed, position]))
        background = image.pixels[image.labels == 0]
        enough = len(background) > LEAST_SHARE * len(image.pixels)
        images.append(_Drawn(windows, labels, background.mean(axis=0) if enough else None))
    model = _select(
        images, dataset.classes, seed, lambda done, total: progress("choosing tables", done, total)
    )
    figures: dict[str, Any] = {"images": list(dataset.names)}
    light = _shares_right(images, dataset, seed, progress)
    if len(light) > 1:
        figures[LIGHT] = light_figures(light)
    return replace(model, training={**model.training, **figures})


def _select(
    images: Sequence[_Drawn], classes: tuple[str, ...], seed: int, progress: Callable[[int, int], None]
) -> WisardModel:
    """The classifier for these images."""
    return select_neighbourhood(
        np.concatenate([image.windows for image in images]),
        np.concatenate([image.labels for image in images]),
        main_drift(np.array([image.mean for image in images if image.mean is not None])),
        classes,
        seed=seed,
        progress=progress,
    )


def _shares_right(
    images: Sequence[_Drawn], dataset: Dataset, seed: int, progress: Progress
) -> NDArray[np.float64]:
    """Share of right pixels of each image that can be judged, by a classifier that has not seen it.

    Returns:
        float64 ``[judged, exposures]``; none are judged if a fold has no classifier.
    """
    shown = [{*np.unique(image.labels).tolist()} for image in images]
    if any(set().union(*(shown[i] for i in others)) != {0, 1} for others in training_sets(len(images))):
        return np.zeros((0, len(EXPOSURES)))

    def select(others: Sequence[int]) -> WisardModel:
        return _select([images[i] for i in others], dataset.classes, seed, _silent)

    return pictures_cross_validated(dataset, select, "cross-validating", progress)


def _silent(done: int, total: int) -> None:
    """A choice inside a fold is one step of the whole."""


def _draw(
    image: LabelledImage, size: int, rng: np.random.Generator
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Windows, uint8 ``[n, size, size, 3]``, and the classes of their middles, uint8 ``[n]``.

    `WINDOWS` of them, or none if no labelled pixel sees data alone.
    """
    picture, labels = image.picture, image.label_picture
    height, width = labels.shape
    if min(height, width) < size:
        raise InputError(
            "an image is smaller than the neighbourhood",
            value=f"{image.name} of {width}x{height} pixels",
            hint="give larger ones",
        )
    halo = size // 2
    middles = image.usable(halo)[halo : height - halo, halo : width - halo]
    if image.scene is None:
        rows = rng.integers(middles.shape[0], size=WINDOWS)
        columns = rng.integers(middles.shape[1], size=WINDOWS)
    else:
        places = np.argwhere(middles)
        # An image without a whole window adds nothing.
        chosen = places[rng.integers(len(places), size=WINDOWS)] if len(places) else places
        rows, columns = chosen.T
    reach = np.arange(size)
    windows = picture[(rows[:, None] + reach)[:, :, None], (columns[:, None] + reach)[:, None, :]]
    return windows, labels[rows + halo, columns + halo]
