"""Pictures and masks to arrays and back; no meaning of a file is guessed silently."""

from wnn2hdl.images.codes import parse_code, spoken_codes
from wnn2hdl.images.folders import by_stem, list_images, pair_masks
from wnn2hdl.images.labels import UNLABELLED, Labels, MaskFormat, read_labels
from wnn2hdl.images.light import balanced, curved, exposed, hazed
from wnn2hdl.images.palette import CLASS_COLOURS, Palette
from wnn2hdl.images.reading import Picture, picture_size, read_picture, read_rgb, whole_windows
from wnn2hdl.images.sources import PlainPicture, Source, open_picture
from wnn2hdl.images.writing import jpeg_bytes, png_bytes, write_png

__all__ = [
    "CLASS_COLOURS",
    "UNLABELLED",
    "Labels",
    "MaskFormat",
    "Palette",
    "Picture",
    "PlainPicture",
    "Source",
    "balanced",
    "by_stem",
    "curved",
    "exposed",
    "hazed",
    "jpeg_bytes",
    "list_images",
    "open_picture",
    "pair_masks",
    "parse_code",
    "picture_size",
    "png_bytes",
    "read_labels",
    "read_picture",
    "read_rgb",
    "spoken_codes",
    "whole_windows",
    "write_png",
]
