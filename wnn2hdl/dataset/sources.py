"""Labelled images from folders of pictures and masks, and from the embedded landscapes."""

from pathlib import Path

import numpy as np

from wnn2hdl.dataset.labelled import CLASSES, Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.images import MaskFormat, pair_masks, read_labels, read_picture
from wnn2hdl.raster import Reading
from wnn2hdl.samples import CLASSES as SAMPLE_CLASSES
from wnn2hdl.samples import landscape

SAMPLE_IMAGES, SAMPLE_SIDE = 12, 256
"""The embedded default: so many landscapes, and the pixels on a side of each."""


def from_masks(
    images: Path,
    masks: Path,
    mask_format: MaskFormat = MaskFormat(),  # noqa: B008  # frozen
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> Dataset:
    """The pixels of each picture that are data and that the mask of the same stem labels.

    Args:
        images: a folder of pictures.
        masks: a folder of masks.
        mask_format: how masks are read; by default 0 is forest, another value deforested.
        reading: how pictures are read.

    Raises:
        InputError: at once if a folder cannot be used or a mask is missing; when an image is read, if it or
            its mask cannot be used, or the masks of two images have different values for deforested.
    """
    pairs = {picture.name: (picture, mask) for picture, mask in pair_masks(images, masks)}
    palette = mask_format.palette
    foregrounds: dict[int, Path] = {}

    def load(name: str) -> LabelledImage:
        path, mask = pairs[name]
        picture = read_picture(path, reading)
        labels = read_labels(mask, path, picture.valid.shape, mask_format)
        if labels.foreground is not None:
            foregrounds.setdefault(labels.foreground, mask)
            _require_one_foreground(foregrounds)
        return LabelledImage.of(name, picture, labels.classes)

    return Dataset(palette.names if palette else CLASSES, tuple(sorted(pairs)), load)


def _require_one_foreground(foregrounds: dict[int, Path]) -> None:
    if len(foregrounds) > 1:
        (one, first), (other, second) = list(foregrounds.items())[:2]
        raise InputError(
            f"masks of one folder hold {one} and {other}, without saying which of them is deforested",
            value=f"{first} and {second}",
            hint="name unlabelled values with --ignore VALUE, or give a palette file of the classes",
        )


def from_samples(count: int, side: int, *, seed: int, every_kind: bool = False) -> Dataset:
    """The embedded default: every pixel of generated landscapes.

    Args:
        count: images.
        side: their height and width in pixels.
        seed: at least 0; image ``i`` is the landscape of seed ``seed + i``.
        every_kind: label with the kinds of ground of `wnn2hdl.samples` instead of forest and deforested.

    Raises:
        InputError: no image was asked for; when an image is made, if it has no pixel.
    """
    if count < 1:
        raise InputError("a set needs at least one landscape", value=count)
    seeds = {f"landscape-{seed + i:05d}": seed + i for i in range(count)}

    def load(name: str) -> LabelledImage:
        scene = landscape(side, side, seeds[name])
        labels = scene.labels if every_kind else scene.deforested.astype(np.uint8)
        return LabelledImage(name, scene.image.reshape(-1, 3), labels.ravel(), (side, side))

    return Dataset(SAMPLE_CLASSES if every_kind else CLASSES, tuple(sorted(seeds)), load)
