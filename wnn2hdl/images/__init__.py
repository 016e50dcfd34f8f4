"""Pictures and masks to arrays and back; nothing about a file's meaning is guessed in silence."""

from wnn2hdl.images.folders import by_stem, list_images, pair_masks
from wnn2hdl.images.palette import CLASS_COLOURS, Palette
from wnn2hdl.images.reading import picture_size, read_labels, read_mask, read_rgb
from wnn2hdl.images.writing import png_bytes, write_png

__all__ = [
    "CLASS_COLOURS",
    "Palette",
    "by_stem",
    "list_images",
    "pair_masks",
    "picture_size",
    "png_bytes",
    "read_labels",
    "read_mask",
    "read_rgb",
    "write_png",
]
