"""Which pixels a file states to be no data: by nodata values, its own mask, and alpha."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster.sampling import sampled

AlphaMeaning = Literal["exclude", "data"]
"""What a band marked alpha holds: which pixels to leave out, or something else that is not looked at."""

_MOST_PARTLY = 0.02
_FEWEST_DEGREES = 16
"""Alpha is a mask with a rim at most; a band with more pixels, and degrees, in between may be data."""


@dataclass(frozen=True)
class Validity:
    """What a file states about some of its bands.

    A pixel is valid if the file's own mask says so, its alpha is the highest there is, its samples are
    numbers, and they are not nodata. Where nodata could be a measurement as well (0 in a picture), only a
    pixel that has it in all bands is without data; where it could not (-9999), one band is enough.

    Attributes:
        bands: number of bands read, without alpha.
        mask: whether the file has its own mask, inside it or beside it.
        alpha: number of the band that is alpha and masks, from 1; None if there is none.
        nodata: of each band read; None if there is none. Not a number is never data.
        impossible: of each band read, whether no measurement can have that value.
    """

    bands: int
    mask: bool
    alpha: int | None
    nodata: tuple[float | None, ...]
    impossible: tuple[bool, ...]

    @classmethod
    def of(cls, source: Any, path: Path, indexes: tuple[int, ...], alpha: int | None) -> Self:
        """Of an open dataset, its bands to read and the one that masks; nodata could be measurements.

        Raises:
            InputError: a mask lies beside the file, and GDAL does not take it for one.
        """
        flags = {flag.name for band in indexes for flag in source.mask_flag_enums[band - 1]}
        nodata = tuple(source.nodatavals[band - 1] for band in indexes)
        own = "per_dataset" in flags and "alpha" not in flags
        beside = [path.with_name(path.name + suffix) for suffix in (".msk", ".MSK")]
        if not own and any(file.exists() for file in beside):
            raise InputError(
                "the mask beside the picture does not say which of its bands it is for",
                value=f"{path}.msk",
                hint="remove it, or make it with GDAL (INTERNAL_MASK_FLAGS_1=2)",
            )
        return cls(len(indexes), own, alpha, nodata, (False,) * len(indexes))

    @property
    def partial(self) -> bool:
        """Whether a pixel may be invalid by what is stated; samples that are not numbers come on top."""
        return self.mask or self.alpha is not None or any(value is not None for value in self.nodata)

    def read(
        self, source: Any, samples: NDArray[Any], alpha: NDArray[Any] | None, where: dict[str, Any]
    ) -> NDArray[np.bool_] | None:
        """Which pixels of a window are valid.

        Args:
            source: the open dataset.
            samples: of the bands read, ``[bands, height, width]``.
            alpha: of the band that masks, ``[height, width]``.
            where: the window, as arguments for rasterio.

        Returns:
            bool ``[height, width]``; None for all.
        """
        parts = []
        if self.mask:
            parts.append(source.read_masks(1, **where) != 0)
        if alpha is not None:
            parts.append(alpha == opaque(alpha.dtype))
        if any(value is not None for value in self.nodata):
            parts.append(self._data(samples))
        if samples.dtype.kind == "f":
            parts.append(np.isfinite(samples).all(axis=0))
        return np.logical_and.reduce(parts) if parts else None

    def _data(self, samples: NDArray[Any]) -> NDArray[np.bool_]:
        empty = np.stack([_equal(band, value) for band, value in zip(samples, self.nodata, strict=True)])
        return np.asarray(~(empty.all(axis=0) | empty[list(self.impossible)].any(axis=0)))


def _equal(band: NDArray[Any], value: float | None) -> NDArray[np.bool_]:
    if value is None or np.isnan(value):
        return np.zeros(band.shape, dtype=np.bool_)
    # Nodata is kept in double precision, and a band of single precision holds the nearest it has.
    return np.asarray(band == (band.dtype.type(value) if band.dtype.kind == "f" else value))


def opaque(kind: np.dtype[Any]) -> float:
    """The alpha of a pixel that is fully shown, in a band of this type."""
    return float(np.iinfo(kind).max) if kind.kind in "iu" else 1.0


def masking_alpha(
    source: Any, path: Path, bands: tuple[int, ...] | None, meaning: AlphaMeaning | None
) -> int | None:
    """The band that is alpha and masks, from 1; None if there is none.

    Programs mark the fourth band of any file of four as alpha by default, so near-infrared often
    passes for it.

    Args:
        source: the open dataset.
        path: the file, for errors.
        bands: bands that the user chose: a band that is named never masks.
        meaning: what the user says that it holds.

    Raises:
        InputError: it looks like data, and the user does not say what it holds.
    """
    numbers = [band for band, kind in enumerate(source.colorinterp, 1) if kind.name == "alpha"]
    numbers = [band for band in numbers if band not in (bands or ())]
    if not numbers or meaning == "data":
        return None
    if meaning is None:
        require_mask([block[0] for block in sampled(source, numbers[:1])], path)
    return numbers[0]


def require_mask(parts: list[NDArray[Any]], path: Path) -> None:
    """Raise InputError if alpha, in parts ``[any, any]``, looks like data."""
    count = sum(part.size for part in parts)
    between = np.concatenate([part[(part != 0) & (part != opaque(part.dtype))] for part in parts])
    if len(between) > _MOST_PARTLY * count and len(np.unique(between)) >= _FEWEST_DEGREES:
        raise InputError(
            "a band is marked as alpha, and looks like data",
            value=f"{path} ({len(between) / count:.0%} of its pixels are neither clear nor opaque)",
            hint="give --alpha data if it is (as near-infrared), or --alpha exclude to leave its pixels out",
        )
