"""Access to GDAL: which files it may open, one line for what is wrong, where a raster lies on the Earth."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from wnn2hdl.errors import InputError, extra_needed
from wnn2hdl.files import require_file
from wnn2hdl.muted import muted
from wnn2hdl.raster.formats import TIFF, format_of

CACHE_BYTES = 64 << 20
"""GDAL's cache of decoded blocks; by default it takes a twentieth of the machine's memory.

Here it is a number of bytes, unlike the environment variable of that name.
"""

_SETTINGS = {
    "GDAL_CACHEMAX": CACHE_BYTES,
    # Only the names that `_require_harmless_neighbours` looks at are then looked for beside a file.
    "GDAL_DISABLE_READDIR_ON_OPEN": "TRUE",
    # Of its own threads GDAL prints the warnings; windows are read by several of ours anyway.
    "GDAL_NUM_THREADS": "1",
    # A second fence: GDAL's files of the network are of this one name, which nothing has.
    "CPL_VSIL_CURL_ALLOWED_FILENAME": "none",
}

_READ_BESIDE = (".aux.xml", ".aux", ".AUX", ".tfw", ".TFW", ".wld", ".WLD", ".pgw", ".jgw", ".bpw", ".tab")
"""Files that GDAL reads as text, if they lie beside a raster, or with the same name but for its suffix."""

_ERDAS = b"EHFA_HEADER_TAG"
"""How files of Erdas Imagine begin, which name others that hold their parts."""

_CONTROL_POINT_TOLERANCE = 0.01
"""How far, in pixels, control points may lie from an affine map that stands for them."""


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
        """Of an open rasterio dataset.

        Raises:
            InputError: only control points locate it, and no affine map goes through them.
        """
        if source.transform.is_identity and source.gcps[0]:
            return cls._of_control_points(source)
        transform = None if source.transform.is_identity else tuple(source.transform)[:6]
        return cls(source.crs.to_wkt() if source.crs else None, transform)

    @classmethod
    def _of_control_points(cls, source: Any) -> Self:
        points, crs = source.gcps
        fitted = _rasterio().transform.from_gcps(points)
        if fitted.is_degenerate or _farthest(points, ~fitted) > _CONTROL_POINT_TOLERANCE:
            raise InputError(
                f"{len(points)} control points locate the picture, and no affine map goes through them",
                value=source.name,
                hint="lay it on a grid first, for instance with gdalwarp",
            )
        return cls(crs.to_wkt() if crs else None, tuple(fitted)[:6])


def _farthest(points: Sequence[Any], place: Any) -> float:
    """How far, in pixels, control points lie from where an affine map of coordinates to pixels has them."""
    a, b, c, d, e, f = tuple(place)[:6]
    return max(
        math.hypot(a * point.x + b * point.y + c - point.col, d * point.x + e * point.y + f - point.row)
        for point in points
    )


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
        InputError: the file is damaged, or cannot be written.
    """
    with _refused(path, "cannot read or write the raster", "it may be damaged, or the disk full") as rasterio:
        yield rasterio


@contextmanager
def decoding(path: Path) -> Iterator[Any]:
    """As `gdal`, to read a picture that somebody else made.

    Raises:
        ExtraMissingError: rasterio is not installed.
        InputError: the file is damaged.
    """
    with _refused(path, "the picture is damaged or truncated", "copy or save it again") as rasterio:
        yield rasterio


@contextmanager
def _refused(path: Path, fault: str, hint: str) -> Iterator[Any]:
    rasterio = _rasterio()
    # Some calls let GDAL's own errors through, which rasterio does not publish.
    from rasterio._err import CPLE_BaseError

    try:
        with rasterio.Env(**_SETTINGS):
            yield rasterio
    except (rasterio.errors.RasterioError, CPLE_BaseError) as error:
        # rasterio's own message is often "Read failed. See previous exception for details."
        raise InputError(fault, value=f"{path} ({error.__cause__ or error})", hint=hint) from error


def open_raster(rasterio: Any, path: Path, mode: str = "r", **profile: Any) -> Any:
    """An open dataset; no warning is given if it is not georeferenced.

    What is to be read must be of one of the formats of `wnn2hdl.raster.formats`, and neither it nor the files
    beside it that GDAL would open may point at others.

    Raises:
        InputError: it is to be read, and is missing, no regular file, of another format, or points at others.
    """
    with muted(rasterio.errors.NotGeoreferencedWarning):
        # Absolute paths only: GDAL takes a name that begins with a driver's for a call of that driver.
        if mode != "r":
            return rasterio.open(path.absolute(), mode, **profile)
        return _open_harmless(rasterio, path, format_of(path))


def _open_harmless(rasterio: Any, path: Path, driver: str) -> Any:
    _require_harmless_neighbours(rasterio, path)
    source = rasterio.open(path.absolute(), driver=driver)
    # In the file itself or in its .aux.xml; GDAL would open what it names when smaller copies are wanted.
    if "OVERVIEW_FILE" in {name.upper() for name in source.tags(ns="OVERVIEWS")}:
        source.close()
        raise _pointing(path)
    return source


def _require_harmless_neighbours(rasterio: Any, path: Path) -> None:
    """Refuse files beside a raster that GDAL would open for it by any driver, unless they are TIFFs."""
    for suffix in (".msk", ".MSK", ".ovr", ".OVR"):
        neighbour = path.with_name(path.name + suffix)
        if neighbour.exists():
            if format_of(neighbour) != TIFF:
                raise _pointing(neighbour)
            _open_harmless(rasterio, neighbour, TIFF).close()
    for name in (name + suffix for name in (path.name, path.stem) for suffix in _READ_BESIDE):
        neighbour = path.with_name(name)
        if not neighbour.exists():
            continue
        # GDAL would wait for a pipe.
        require_file(neighbour, "a file beside the picture")
        with neighbour.open("rb") as stream:
            if stream.read(len(_ERDAS)) == _ERDAS:
                raise _pointing(neighbour)


def _pointing(path: Path) -> InputError:
    return InputError(
        "the file may point at other files, which are not opened for it",
        value=path,
        hint="remove it, or save the picture as a TIFF in another folder",
    )


def _rasterio() -> Any:
    with extra_needed("geo", "rasters are read and written with rasterio"):
        import rasterio
    return rasterio
