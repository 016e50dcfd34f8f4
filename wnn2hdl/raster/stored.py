"""The samples of a raster as they are stored: what a mask of labels is read by."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster.channels import choose_channels
from wnn2hdl.raster.handles import Handles
from wnn2hdl.raster.reading import colour_table, require_decodable
from wnn2hdl.raster.validity import Validity, masking_alpha


@dataclass(frozen=True, eq=False)
class Stored:
    """The samples.

    Attributes:
        samples: of one band, or of red, green and blue: ``[bands, height, width]`` of the file's type.
        valid: bool ``[height, width]``: which pixels the file does not leave out.
        palette: uint8 ``[256, 4]``: red, green, blue and alpha of each sample; None if they are not indices.
    """

    samples: NDArray[Any]
    valid: NDArray[np.bool_]
    palette: NDArray[np.uint8] | None


def read_stored(path: Path) -> Stored:
    """Read a whole raster.

    Raises:
        InputError: it cannot be read, points at other files, is too large, does not say which of its bands to
            take, or means white by 0.
        ExtraMissingError: rasterio is not installed.
    """
    with Handles(path).borrowed() as source:
        require_decodable(path, source.height, source.width)
        if source.tags(ns="IMAGE_STRUCTURE").get("MINISWHITE") == "YES":
            raise InputError(
                "0 is white in the file", value=path, hint="save it with 0 for black (photometric MINISBLACK)"
            )
        kinds = tuple(x.name for x in source.colorinterp)
        channels = choose_channels(path, kinds, source.descriptions)
        alpha = masking_alpha(source, path, None, None)
        validity = Validity.of(source, path, channels.indexes, alpha)
        samples = source.read(list(channels.indexes))
        opacity = None if alpha is None else source.read(alpha)
        valid = validity.read(source, samples, opacity, {})
        palette = colour_table(source, path, 1) if channels.palette else None
    shape = samples.shape[1:]
    return Stored(samples, np.ones(shape, dtype=np.bool_) if valid is None else valid, palette)
