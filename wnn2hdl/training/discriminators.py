"""From labelled images to a trained model."""

import hashlib
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.ir import COLOURS, PixelEncoder, WisardModel, all_codes
from wnn2hdl.progress import Progress, reported
from wnn2hdl.wisard import choose_bleaching, draw_mapping, train_histogram

LEFT_OUT = "left_out"
"""Of a model's training: pixels of the images that were not labelled or without data, and their share of
all."""


IDENTICAL = "identical_images"
"""Of a model's training: names of images that show the same pixels, one list for each picture."""


def image_histograms(dataset: Dataset, encoder: PixelEncoder, progress: Progress) -> NDArray[np.int64]:
    """How often each code occurs, by image and class: int64 ``[images, classes, 2**width]``.

    One image is in memory at a time; the cost grows with the pixels.

    Raises:
        InputError: the encoder is too wide for a table, an image cannot be read, or a class has no pixel.
    """
    shape = (len(dataset.classes), len(all_codes(encoder.width)))
    histograms = np.zeros((len(dataset), *shape), dtype=np.int64)
    for position, image in enumerate(reported(dataset, "reading images", len(dataset), progress)):
        histograms[position] = _histogram(image, encoder, shape)
    for name, pixels in zip(dataset.classes, histograms.sum(axis=(0, 2)), strict=True):
        if pixels == 0:
            raise InputError(
                f"no training pixel is labelled {name}",
                value=f"{len(dataset)} images",
                hint="add images that show every class",
            )
    return histograms


def train(
    dataset: Dataset,
    encoder: PixelEncoder,
    *,
    address_bits: int,
    rams: int,
    bleaching: int | None,
    balanced: bool = False,
    seed: int,
    progress: Progress,
) -> WisardModel:
    """Train RAM discriminators on a data set.

    Args:
        dataset: the training images.
        encoder: which pixel bits the network reads.
        address_bits: n, address bits of a RAM.
        rams: k, RAMs of a discriminator.
        bleaching: the threshold; None chooses it by cross-validation by image, on these images alone.
        balanced: multiply the counts of every class so that all classes weigh equally. Without it one
            bleaching threshold serves frequent classes and silences rare ones.
        seed: of the tuple mapping.
        progress: called with each image read.

    Raises:
        InputError: the images cannot be used, or n does not fit the encoder.
    """
    mapping = draw_mapping(encoder.width, rams, address_bits, seed)
    histograms = image_histograms(dataset, encoder, progress)
    pixels = int(histograms.sum())
    if balanced:
        histograms = _balanced(histograms)
    threshold = choose_bleaching(histograms, mapping) if bleaching is None else bleaching
    training = {
        "seed": seed,
        "images": list(dataset.names),
        "pixels": pixels,
        "bleaching": "auto" if bleaching is None else "given",
        "balanced": balanced,
    }
    return train_histogram(histograms.sum(axis=0), encoder, dataset.classes, mapping, threshold, training)


def _balanced(histograms: NDArray[np.int64]) -> NDArray[np.int64]:
    """Histograms whose classes all have about as many counts as the largest of them."""
    totals = histograms.sum(axis=(0, 2))
    shares = totals.max() / totals
    return np.asarray(np.rint(histograms * shares[None, :, None]), dtype=np.int64)


def with_colours(model: WisardModel, dataset: Dataset, progress: Progress) -> WisardModel:
    """The model with a memory of the colours of its training images; these are read once more.

    Its training records how many pixels of the images were left out, not labelled or without data, and which
    images show the same.

    Raises:
        InputError: an image cannot be read.
    """
    seen = np.zeros(1 << COLOURS.width, dtype=np.bool_)
    used = left_out = 0
    same: dict[bytes, list[str]] = {}
    for image in reported(dataset, "noting colours", len(dataset), progress):
        seen[COLOURS.codes(image.pixels)] = True
        used, left_out = used + len(image.labels), left_out + image.left_out
        shown = image.pixels if image.scene is None else image.scene.picture
        same.setdefault(hashlib.sha256(shown.tobytes()).digest(), []).append(image.name)
    figures = {
        LEFT_OUT: {"pixels": left_out, "share": left_out / (used + left_out)},
        IDENTICAL: [names for names in same.values() if len(names) > 1],
    }
    return replace(model, colours=np.flatnonzero(seen), training=dict(model.training) | figures)


def _histogram(image: LabelledImage, encoder: PixelEncoder, shape: tuple[int, int]) -> NDArray[np.int64]:
    cells = image.labels.astype(np.int64) * shape[1] + encoder.codes(image.pixels)
    return np.bincount(cells, minlength=shape[0] * shape[1]).reshape(shape)
