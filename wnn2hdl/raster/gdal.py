"""The door to GDAL: opening, what is wrong in one line, and where a raster lies on the Earth."""

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from wnn2hdl.errors import InputError, extra_needed

PICTURE_DRIVERS = ("JPEG", "PNG", "BMP")
"""GDAL's names of the formats of plain pictures: not georeferenced, not readable in windows at random."""

CACHE_BYTES = 64 << 20
"""GDAL's cache of decoded blocks; by default it takes a twentieth of the machine's memory.

Here it is a number of bytes, unlike the environment's variable of that name.
"""


@dataclass(frozen=True)
class Georeference:
    """Where a raster lies.

    Attributes:
        crs: the coordinate system as WKT, None if the file names none.
        transform: ``(a, b, c, d, e, f)``: x = a·column + b·row + c, y = d·column + e·row + f, of pixel
            corners; None if the file has none.
    """

    crs: str | None = None
    transform: tuple[float, float, float, float, float, float] | None = None

    @property
    def located(self) -> bool:
        """Whether areas on the Earth are known; a system of a building site's own is tied to no place."""
        if self.crs is None or self.transform is None:
            return False
        system = _rasterio().crs.CRS.from_wkt(self.crs)
        return bool(system.is_geographic or system.is_projected)

    @classmethod
    def of(cls, source: Any) -> Self:
        """Of an open rasterio dataset."""
        transform = None if source.transform.is_identity else tuple(source.transform)[:6]
        return cls(source.crs.to_wkt() if source.crs else None, transform)


def same_grid(one: Georeference, other: Georeference, height: int, width: int) -> bool:
    """Whether two rasters of the same size cover the same pixels, to a hundredth of a pixel.

    One without a coordinate system fits every grid, since nothing contradicts it.
    """
    if one.crs is None or one.transform is None or other.crs is None or other.transform is None:
        return True
    if _rasterio().crs.CRS.from_wkt(one.crs) != _rasterio().crs.CRS.from_wkt(other.crs):
        return False
    a, b, c, d, e, f = (x - y for x, y in zip(one.transform, other.transform, strict=True))
    size = math.sqrt(abs(one.transform[0] * one.transform[4] - one.transform[1] * one.transform[3]))
    corners = ((0, 0), (0, width), (height, 0), (height, width))
    return all(
        math.hypot(a * column + b * row + c, d * column + e * row + f) <= 0.01 * size
        for row, column in corners
    )


@contextmanager
def gdal(path: Path) -> Iterator[Any]:
    """The rasterio module, to do something with a file; what GDAL raises inside becomes an `InputError`.

    Raises:
        ExtraMissingError: rasterio is not installed.
        InputError: the file is missing, no raster, damaged, or cannot be written.
    """
    rasterio = _rasterio()
    # Some calls let GDAL's own errors through, which rasterio does not publish.
    from rasterio._err import CPLE_BaseError

    try:
        with rasterio.Env(GDAL_CACHEMAX=CACHE_BYTES):
            yield rasterio
    except (rasterio.errors.RasterioError, CPLE_BaseError) as error:
        # rasterio's own message is often "Read failed. See previous exception for details."
        reason = error.__cause__ or error
        raise InputError(
            "cannot read or write the raster",
            value=f"{path} ({reason})",
            hint="it may be damaged, truncated, of an unknown format, or the disk full",
        ) from error


def open_raster(rasterio: Any, path: Path, mode: str = "r", **profile: Any) -> Any:
    """An open dataset; that it is not georeferenced is no reason for a warning.

    Raises:
        InputError: it is to be read, and there is no such file.
    """
    if mode == "r" and not path.is_file():
        raise InputError("cannot read the picture", value=f"{path} (no such file)")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        return rasterio.open(path, mode, **profile)


def _rasterio() -> Any:
    with extra_needed("geo", "rasters are read and written with rasterio"):
        import rasterio
    return rasterio
