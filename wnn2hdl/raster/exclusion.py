"""A mask that leaves pixels of a picture out, such as one of clouds."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster.formats import JPEG, format_of
from wnn2hdl.raster.gdal import Georeference, same_grid
from wnn2hdl.raster.handles import Handles


class Exclusion:
    """A mask, read in windows: pixels other than 0 in a band besides alpha are left out.

    Args:
        path: a raster.
        height: of the picture, in pixels.
        width: of the picture, in pixels.
        georeference: where the picture lies.

    Attributes:
        files: what GDAL reads for it.

    Raises:
        InputError: the mask cannot be read, is a JPEG, has no band, or has another size or place.
        ExtraMissingError: rasterio is not installed.
    """

    def __init__(self, path: Path, height: int, width: int, georeference: Georeference) -> None:
        if format_of(path) == JPEG:
            raise InputError(
                "a JPEG cannot be a mask, because its compression smears it",
                value=path,
                hint="save it as PNG",
            )
        self._handles = Handles(path)
        with self._handles.borrowed() as source:
            size, place = (source.height, source.width), Georeference.of(source)
            self._bands = [band for band, kind in enumerate(source.colorinterp, 1) if kind.name != "alpha"]
            self.files: tuple[Path, ...] = tuple(map(Path, source.files))
        if not self._bands:
            raise InputError("the mask has no band but alpha", value=path, hint="save it as grey")
        if size != (height, width):
            raise InputError(
                "the mask and the picture have different sizes",
                value=f"{path} is {size[1]}x{size[0]}, the picture {width}x{height}",
                hint="give a mask of the picture's size",
            )
        if not same_grid(georeference, place, *size):
            raise InputError(
                "the mask and the picture lie in different places",
                value=path,
                hint="warp it to the picture's grid first, for instance with gdalwarp",
            )

    def kept(self, row: int, column: int, height: int, width: int) -> NDArray[np.bool_]:
        """Which pixels of a window are not left out: bool ``[height, width]``."""
        window = ((row, row + height), (column, column + width))
        with self._handles.borrowed() as source:
            return np.asarray(~source.read(self._bands, window=window).any(axis=0))
