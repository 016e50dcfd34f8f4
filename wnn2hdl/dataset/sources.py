"""Labelled images from folders of pictures and masks, and from the embedded landscapes."""

from pathlib import Path

import numpy as np

from wnn2hdl.dataset.labelled import CLASSES, Dataset, LabelledImage
from wnn2hdl.errors import InputError
from wnn2hdl.images import Palette, pair_masks, read_labels, read_mask, read_rgb
from wnn2hdl.samples import CLASSES as SAMPLE_CLASSES
from wnn2hdl.samples import landscape


def from_masks(images: Path, masks: Path, palette: Palette | None = None) -> Dataset:
    """Every pixel of each picture, labelled by the mask of the same stem.

    Args:
        images: a folder of pictures.
        masks: a folder of masks: 0 forest, anything else deforested; or, with ``palette``,
            colours of classes.
        palette: the classes and their colours, where there are more than forest and deforested.

    Raises:
        InputError: at once if a folder cannot be used or a mask is missing; when an image is read, if it or
            its mask cannot be used.
    """
    pairs = {picture.name: (picture, mask) for picture, mask in pair_masks(images, masks)}

    def load(name: str) -> LabelledImage:
        picture, mask = pairs[name]
        rgb = read_rgb(picture)
        shape = (rgb.shape[0], rgb.shape[1])
        labels = read_labels(mask, shape, palette) if palette else read_mask(mask, shape)
        return LabelledImage(name, rgb.reshape(-1, 3), labels.ravel(), shape)

    return Dataset(palette.names if palette else CLASSES, tuple(sorted(pairs)), load)


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
