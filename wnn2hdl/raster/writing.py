"""Class rasters: GeoTIFFs with one colour per class, written from top to bottom."""

from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster.gdal import Georeference, gdal, open_raster

NODATA = 255
"""Class index of what was not classified."""

TILE = 512
"""Side of a tile."""

_SMALLEST_OVERVIEW = 256


def _incomplete(path: Path) -> InputError:
    return InputError("the raster was not written completely", value=path, hint="the disk may be full")


class ClassWriter:
    """Writes a class raster: tiled, compressed (deflate), with nodata and a colour table.

    A context manager: the file is removed if the block ends with an error.

    Args:
        path: the GeoTIFF.
        height: rows that will be written.
        width: pixels per row.
        georeference: kept as it is.
        colours: red, green, blue of each class, 0 to 255.

    Raises:
        InputError: the file cannot be written, or when it is closed, not all of it was.
        ExtraMissingError: rasterio is not installed.
    """

    def __init__(
        self,
        path: Path,
        height: int,
        width: int,
        georeference: Georeference,
        colours: tuple[tuple[int, int, int], ...],
    ) -> None:
        self._path = path
        self._size = (height, width)
        self._row = 0
        self._valid = 0
        self._waiting = np.empty((0, width), dtype=np.uint8)
        with gdal(path) as rasterio:
            place = georeference.transform
            self._target = open_raster(
                rasterio,
                path,
                "w",
                driver="GTiff",
                height=height,
                width=width,
                count=1,
                dtype="uint8",
                nodata=NODATA,
                crs=georeference.crs,
                transform=rasterio.Affine(*place) if place else None,
                tiled=True,
                blockxsize=TILE,
                blockysize=TILE,
                compress="deflate",
                bigtiff="if_safer",
                num_threads="all_cpus",
            )
            self._target.write_colormap(1, {index: (*colour, 255) for index, colour in enumerate(colours)})

    def write(self, rows: NDArray[np.uint8]) -> None:
        """Add rows, uint8 ``[any, width]``, below those already written."""
        self._valid += int(np.count_nonzero(rows != NODATA))
        self._waiting = np.concatenate([self._waiting, rows])
        # Whole rows of tiles only: a compressed tile that is written twice leaves a hole in the file.
        ready = len(self._waiting)
        if self._row + ready < self._size[0]:
            ready -= ready % TILE
        if not ready:
            return
        with gdal(self._path):
            window = ((self._row, self._row + ready), (0, self._size[1]))
            self._target.write(self._waiting[:ready], 1, window=window)
        self._row += ready
        self._waiting = self._waiting[ready:].copy()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            with gdal(self._path):
                self._target.close()
            if kind is None:
                self._check()
        except BaseException:
            self._path.unlink(missing_ok=True)
            raise
        if kind is not None:
            self._path.unlink(missing_ok=True)

    def _check(self) -> None:
        """Refuse a file that lacks some of what was written: closing one on a full disk raises nothing."""
        with gdal(self._path) as rasterio, open_raster(rasterio, self._path) as written:
            windows = (window for _, window in written.block_windows(1))
            valid = sum(np.count_nonzero(written.read(1, window=window) != NODATA) for window in windows)
        if valid != self._valid:
            raise _incomplete(self._path)


def add_overviews(path: Path) -> None:
    """Add smaller copies to a class raster, inside the file: what viewers show of a large one.

    A pixel of a copy has the class of most of the pixels beneath it.

    Raises:
        InputError: the file cannot be read or written.
    """
    with gdal(path) as rasterio, open_raster(rasterio, path, "r+") as target:
        factors = [2]
        while max(target.shape) // factors[-1] > _SMALLEST_OVERVIEW:
            factors.append(2 * factors[-1])
        target.build_overviews(factors, rasterio.enums.Resampling.mode)
    with gdal(path) as rasterio, open_raster(rasterio, path) as written:
        if len(written.overviews(1)) != len(factors):
            raise _incomplete(path)
