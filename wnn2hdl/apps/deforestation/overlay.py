"""A class map laid over its picture, as the reference design shows it: green forest, red clearings."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import open_classes
from wnn2hdl.images import Palette, write_png

GREEN_AND_RED = ((40, 200, 60), (230, 60, 60))
"""The reference design's colours of background and clearing."""

_OPACITY = 0.65
"""Of the tint; the picture's lightness stays visible through it, as in the reference."""


def overlay_palette(names: tuple[str, ...]) -> Palette:
    """Green and red for two classes, as in the reference design; the project's colours for more."""
    return Palette(names, GREEN_AND_RED) if len(names) == 2 else Palette.of(names)


def overlay(
    picture: NDArray[np.uint8], classes: NDArray[np.uint8], valid: NDArray[np.bool_], palette: Palette
) -> NDArray[np.uint8]:
    """Tint a picture with the colours of classes.

    Args:
        picture: uint8 ``[height, width, 3]``: red, green, blue.
        classes: uint8 ``[height, width]``, class indices.
        valid: bool ``[height, width]``; other pixels are left as they are.
        palette: the colour of each class.

    Returns:
        uint8 ``[height, width, 3]``.
    """
    grey = picture.astype(np.float32).mean(axis=2, keepdims=True)
    # A tint as bright as what lies under it: dark forest stays dark, a bright road bright.
    tint = palette.paint(np.where(valid, classes, 0)) * ((grey + 32) / 192)
    mixed = np.clip((1 - _OPACITY) * picture + _OPACITY * tint, 0, 255).round().astype(np.uint8)
    return np.where(valid[..., np.newaxis], mixed, picture)


def write_overlay(
    read_picture: Callable[[int, int], NDArray[np.uint8]],
    classes: Path,
    output: Path,
    palette: Palette,
    *,
    max_side: int = 2000,
) -> None:
    """Write the overlay of a class raster as a PNG of at most ``max_side`` pixels on a side.

    A larger raster is thinned, from its overviews if it has some: no colour is mixed of two classes.

    Args:
        read_picture: gives the picture under the raster at a given height and width.
        classes: a class raster.
        output: the PNG.
        palette: the colour of each class.
        max_side: pixels.

    Raises:
        ExtraMissingError: the extra ``geo`` is not installed.
        InputError: a file cannot be read or written.
    """
    with open_classes(classes) as dataset:
        shrink = max(1.0, max(dataset.shape) / max_side)
        height, width = (max(1, round(side / shrink)) for side in dataset.shape)
        labels = dataset.read(1, out_shape=(height, width))
        valid = dataset.read_masks(1, out_shape=(height, width)) != 0
    write_png(output, overlay(read_picture(height, width), labels, valid, palette))
