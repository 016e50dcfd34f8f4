"""Windows of a raster as red, green and blue of 8 bits, with what may be classified of them."""

import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.raster.channels import Channels, choose_channels
from wnn2hdl.raster.gdal import Georeference, gdal, open_raster, same_grid

_OPAQUE = 255
_ORIENTATION_TAG = 0x0112
_UPRIGHT = 1
_SAMPLE_SIDE = 512


@dataclass(frozen=True)
class Reading:
    """How a raster is read.

    Attributes:
        bands: band numbers from 1 of red, green and blue, or of one band; None for what the file states.
        scale: values ``(low, high)`` that become 0 and 255; what lies beyond is cut off. None for 8-bit
            samples as they are.
        mask: a raster of the same size whose pixels other than 0 are not to be classified (clouds).
    """

    bands: tuple[int, ...] | None = None
    scale: tuple[float, float] | None = None
    mask: Path | None = None


class RasterReader:
    """A raster that is read in windows, by several threads at once if need be.

    A pixel is valid if its alpha is 255, the file's own mask says so, at least one of its bands differs from
    nodata, all its samples are finite, and the cloud mask is 0 there.

    Args:
        path: a file that GDAL reads.
        reading: how.

    Attributes:
        driver: GDAL's name of the format.
        height: pixels; likewise `width`.
        block: height and width of the blocks that the file is stored in.
        georeference: where it lies.
        note: what had to be assumed about its bands and pages.
        files: what GDAL reads for it and its mask: the files themselves, those beside them, a mosaic's parts.
        masked: whether some of it may be invalid.
        plain: whether its samples are opaque levels, read as they stand: then `wnn2hdl.images.read_rgb` reads
            it as well, if it is small.

    Raises:
        InputError: the file or its mask cannot be read; its bands are not named; its samples have other than
            8 bits and no scaling was given, are complex, or mean white by 0; the mask is a JPEG, or has
            another size or place.
        ExtraMissingError: rasterio is not installed.
    """

    def __init__(self, path: Path, reading: Reading) -> None:
        self._path = path
        self._reading = reading
        self._lock = threading.Lock()
        self._idle: dict[Path, list[Any]] = {}
        with self._borrowed(path) as source:
            self.driver = str(source.driver)
            self.height, self.width = int(source.height), int(source.width)
            self.block: tuple[int, int] = source.block_shapes[0]
            self.georeference = Georeference.of(source)
            names = tuple(x.name for x in source.colorinterp)
            self._channels = choose_channels(path, names, reading.bands)
            self.note = "; ".join(filter(None, [self._channels.note, _pages(source)]))
            self.files: tuple[Path, ...] = tuple(map(Path, source.files))
            self._palette = (
                _palette(source, path, self._channels.indexes[0]) if self._channels.palette else None
            )
            flags = {flag.name for some in source.mask_flag_enums for flag in some}
            self._own_mask = flags != {"all_valid"}
            self._scale = reading.scale or _stated_scale(source, self._channels)
            kinds = {source.dtypes[band - 1] for band in self._channels.indexes}
            if self._palette is None:
                _require_levels(source, path, kinds)
            if self._scale is None and kinds != {"uint8"}:
                raise _unscaled(source, self._channels.indexes, path, kinds)
        self.masked = self._own_mask or reading.mask is not None
        as_it_stands = self._palette is None and not (reading.bands or reading.scale)
        self.plain = as_it_stands and not flags & {"alpha", "nodata"}
        if reading.mask is not None:
            self._check_mask(reading.mask)

    @cached_property
    def _orientation(self) -> int:
        """How the picture is to be turned, as EXIF numbers it; `_UPRIGHT` also where Pillow cannot tell."""
        try:
            # Pillow warns of large pictures and refuses larger ones; only the head is read here.
            with warnings.catch_warnings(action="ignore"), Image.open(self._path) as picture:
                return int(picture.getexif().get(_ORIENTATION_TAG, _UPRIGHT))
        except (OSError, SyntaxError, ValueError, Image.DecompressionBombError):
            return _UPRIGHT

    @property
    def upright(self) -> bool:
        """Whether viewers show it as it is stored; windows are not turned."""
        return self._orientation == _UPRIGHT

    def require_upright(self) -> None:
        """Raise InputError if the file says that viewers must turn the picture."""
        if not self.upright:
            raise InputError(
                f"the picture says that it is to be turned (orientation {self._orientation})",
                value=self._path,
                hint="save it upright",
            )

    def read(
        self, row: int, column: int, height: int, width: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """A window that lies in the raster.

        Returns:
            uint8 ``[height, width, 3]``: red, green, blue; and which pixels are valid, bool
            ``[height, width]``, or None for all.

        Raises:
            InputError: the file is damaged there.
        """
        return self._picture(((row, row + height), (column, column + width)), (height, width))

    def thinned(self, height: int, width: int) -> NDArray[np.uint8]:
        """The whole picture by its nearest pixels: uint8 ``[height, width, 3]``, for showing it."""
        return self._picture(((0, self.height), (0, self.width)), (height, width))[0]

    def _picture(
        self, window: tuple[tuple[int, int], tuple[int, int]], shape: tuple[int, int]
    ) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        where = {"window": window, "out_shape": shape}
        with self._borrowed(self._path) as source:
            samples = source.read(self._channels.indexes, **_bands(where, len(self._channels.indexes)))
            valid = source.dataset_mask(**where) == _OPAQUE if self._own_mask else None
        if self._palette is not None:
            colours = self._palette[samples[0]]
            samples, valid = np.moveaxis(colours[..., :3], 2, 0), _both(valid, colours[..., 3] == _OPAQUE)
        if self._scale is not None:
            if samples.dtype.kind == "f":
                valid = _both(valid, np.isfinite(samples).all(axis=0))
            samples = scaled(samples, *self._scale)
        if self._reading.mask is not None:
            with self._borrowed(self._reading.mask) as source:
                opaque = _opaque_bands(source)
                clouds = source.read(opaque, **_bands(where, len(opaque)))
            valid = _both(valid, ~clouds.any(axis=0))
        return np.broadcast_to(np.moveaxis(samples, 0, 2), (*shape, 3)), valid

    @contextmanager
    def _borrowed(self, path: Path) -> Iterator[Any]:
        """An open dataset that no other thread uses meanwhile; GDAL's must not be shared."""
        with gdal(path) as rasterio:
            with self._lock:
                idle = self._idle.setdefault(path, [])
                source = idle.pop() if idle else open_raster(rasterio, path)
            yield source
            with self._lock:
                idle.append(source)

    def _check_mask(self, mask: Path) -> None:
        with self._borrowed(mask) as source:
            size, place = (source.height, source.width), Georeference.of(source)
            lossy, opaque = source.driver == "JPEG", _opaque_bands(source)
            self.files += tuple(map(Path, source.files))
        if lossy:
            raise InputError(
                "a JPEG cannot be a mask, its compression smears it", value=mask, hint="save it as PNG"
            )
        if not opaque:
            raise InputError("the mask has no band but alpha", value=mask, hint="save it as grey")
        if size != (self.height, self.width):
            raise InputError(
                "the mask and the picture have different sizes",
                value=f"{mask} is {size[1]}x{size[0]}, the picture {self.width}x{self.height}",
                hint="give a mask of the picture's size",
            )
        if not same_grid(self.georeference, place, *size):
            raise InputError(
                "the mask and the picture lie in different places",
                value=mask,
                hint="warp it to the picture's grid first, for instance with gdalwarp",
            )


def scaled(samples: NDArray[Any], low: float, high: float) -> NDArray[np.uint8]:
    """Values from ``low`` to ``high`` become 0 to 255, rounded (halves to even) and cut off beyond.

    What is not a number becomes 0. Any shape and number type in, the same shape out.
    """
    if samples.dtype.itemsize <= 2 and samples.dtype.kind in "iu":
        # One look-up a sample instead of arithmetic in float64.
        limits = np.iinfo(samples.dtype)
        levels = np.arange(limits.min, limits.max + 1, dtype=np.float64)
        return np.take(_scaled(levels, low, high), samples.astype(np.int64) - limits.min)
    return _scaled(samples.astype(np.float64), low, high)


def _scaled(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.uint8]:
    values -= low
    values *= 255 / (high - low)
    np.nan_to_num(values, copy=False, nan=0)
    return np.rint(values).clip(0, 255).astype(np.uint8)


def _bands(where: dict[str, Any], count: int) -> dict[str, Any]:
    """The arguments for one band made those for several."""
    return {**where, "out_shape": (count, *where["out_shape"])}


def _both(one: NDArray[np.bool_] | None, other: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return other if one is None else one & other


def _pages(source: Any) -> str:
    pages = len(source.subdatasets)
    return f"the file holds {pages} pictures; the first one is read" if pages > 1 else ""


def _opaque_bands(source: Any) -> list[int]:
    """Numbers of the bands other than alpha, from 1."""
    return [band for band, kind in enumerate(source.colorinterp, 1) if kind.name != "alpha"]


def _palette(source: Any, path: Path, band: int) -> NDArray[np.uint8]:
    """The colour table of a band: uint8 ``[256, 4]``, red, green, blue, alpha."""
    if source.dtypes[band - 1] != "uint8":
        raise InputError(
            f"the colour table is of {source.dtypes[band - 1]} indices",
            value=path,
            hint="make it red, green and blue first, for instance with gdal_translate -expand rgb",
        )
    table = np.zeros((256, 4), dtype=np.uint8)
    for index, colour in source.colormap(band).items():
        table[index] = colour
    return table


def _stated_scale(source: Any, channels: Channels) -> tuple[float, float] | None:
    """Of samples of 1 to 7 bits, whose largest value is white by the formats' own definitions."""
    bits = int(source.tags(channels.indexes[0], ns="IMAGE_STRUCTURE").get("NBITS", 8))
    return None if bits >= 8 or channels.palette else (0.0, float((1 << bits) - 1))


def _require_levels(source: Any, path: Path, kinds: set[str]) -> None:
    """Refuse samples that are no rising levels; GDAL gives them as they are stored."""
    if any(kind.startswith("complex") for kind in kinds):
        raise InputError("the samples are complex", value=path, hint="make levels of them first")
    if source.tags(ns="IMAGE_STRUCTURE").get("MINISWHITE") == "YES":
        raise InputError(
            "0 is white in the file", value=path, hint="save it with 0 for black (photometric MINISBLACK)"
        )


def _unscaled(source: Any, indexes: tuple[int, ...], path: Path, kinds: set[str]) -> InputError:
    """The complaint about samples of other than 8 bits, with the range of some of them."""
    values = []
    for part in ((0, 0), (1, 1), (0, 1), (1, 0), (0.5, 0.5)):
        starts = [int(x * max(n - _SAMPLE_SIDE, 0)) for x, n in zip(part, source.shape, strict=True)]
        window = tuple((start, start + _SAMPLE_SIDE) for start in starts)
        block = source.read(indexes, window=window, masked=True).compressed()
        values += [block[np.isfinite(block)]]
    found = np.concatenate(values)
    span = f"{found.min():g} to {found.max():g} in a sample" if found.size else "no valid value in a sample"
    return InputError(
        f"the samples are {'/'.join(sorted(kinds))}, and how they become 0 to 255 is not said",
        value=f"{path} ({span})",
        hint="say --scale LOW:HIGH, as in --scale 0:3000",
    )
