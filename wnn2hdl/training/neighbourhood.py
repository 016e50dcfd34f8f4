"""Training of models that look at a pixel's neighbours."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel
from wnn2hdl.progress import Progress, reported
from wnn2hdl.training.bitselect import LEAST_SHARE, LUTS, main_drift, select_neighbourhood

WINDOWS = 8000
"""Windows drawn from each image, wherever they lie wholly inside data; more changed little."""


def train_neighbourhood(
    dataset: Dataset, size: int, *, luts_per_pixel: int | None, seed: int, progress: Progress
) -> WisardModel:
    """The classifier that reads six tables over the window around a pixel by one LUT.

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
    windows, labels, means = [], [], []
    for position, image in enumerate(reported(dataset, "reading images", len(dataset), progress)):
        drawn = _draw(image, size, np.random.default_rng([seed, position]))
        windows.append(drawn[0])
        labels.append(drawn[1])
        background = image.pixels[image.labels == 0]
        if len(background) > LEAST_SHARE * len(image.pixels):
            means.append(background.mean(axis=0))
    model = select_neighbourhood(
        np.concatenate(windows),
        np.concatenate(labels),
        main_drift(np.array(means)),
        dataset.classes,
        seed=seed,
        progress=lambda done, total: progress("choosing tables", done, total),
    )
    return replace(model, training={**model.training, "images": list(dataset.names)})


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
