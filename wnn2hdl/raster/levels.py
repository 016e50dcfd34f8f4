"""From the samples that a file stores to levels of 8 bits, as the file and the user say."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.raster.channels import Channels
from wnn2hdl.raster.sampling import sampled


@dataclass(frozen=True)
class Levels:
    """How samples become levels.

    Attributes:
        limits: of each band read, the samples that become 0 and 255; None for levels as they are stored.
        inverted: whether 0 is white in the file.
    """

    limits: tuple[tuple[float, float], ...] | None
    inverted: bool

    @classmethod
    def of(cls, source: Any, path: Path, channels: Channels, scale: tuple[float, float] | None) -> Self:
        """Of the bands of an open dataset.

        Args:
            source: the dataset.
            path: the file, for errors.
            channels: the bands; not of a palette.
            scale: the values that become 0 and 255, in the file's units: a band's sample times its scale plus
                its offset, where the file states them.

        Raises:
            InputError: the samples are complex; or not levels of 8 bits, or have a scale or an offset, and
                ``scale`` is None; or they can never reach it.
        """
        kinds = {source.dtypes[band - 1] for band in channels.indexes}
        if any(kind.startswith("complex") for kind in kinds):
            raise InputError("the samples are complex", value=path, hint="make levels of them first")
        inverted = source.tags(ns="IMAGE_STRUCTURE").get("MINISWHITE") == "YES"
        units = tuple((source.scales[band - 1], source.offsets[band - 1]) for band in channels.indexes)
        bits = int(source.tags(channels.indexes[0], ns="IMAGE_STRUCTURE").get("NBITS", 8))
        stated = any(unit != (1, 0) for unit in units)
        if scale is None:
            if kinds != {"uint8"} or stated:
                raise _unscaled(source, channels, path, kinds, units)
            # By the formats' own definitions the largest value is white.
            limits = None if bits == 8 else ((0.0, float((1 << bits) - 1)),) * len(units)
            return cls(limits, inverted)
        if stated:
            _require_reach(path, kinds, units, scale)
        return cls(tuple(_samples(scale, *unit) for unit in units), inverted)

    def apply(self, samples: NDArray[Any]) -> NDArray[np.uint8]:
        """Samples ``[bands, …]`` as uint8 of the same shape; NaN becomes 0 (or white's 255)."""
        if self.limits is not None:
            if len(set(self.limits)) == 1:
                samples = scaled(samples, *self.limits[0])
            else:
                samples = np.stack(
                    [scaled(band, *limits) for band, limits in zip(samples, self.limits, strict=True)]
                )
        return 255 - samples if self.inverted else samples

    def beyond(self, band: int, value: float) -> bool:
        """Whether no measurement has this sample: it lies outside of what becomes 0 to 255."""
        return self.limits is not None and not min(self.limits[band]) <= value <= max(self.limits[band])


def scaled(samples: NDArray[Any], low: float, high: float) -> NDArray[np.uint8]:
    """Values from ``low`` to ``high`` become 0 to 255, rounded (halves to even) and cut off beyond.

    What is not a number becomes 0. Any shape and number type in, the same shape out; ``high`` may be below
    ``low``.
    """
    if samples.dtype.itemsize <= 2 and samples.dtype.kind in "iu":
        # One look-up per sample instead of arithmetic in float64.
        limits = np.iinfo(samples.dtype)
        levels = np.arange(limits.min, limits.max + 1, dtype=np.float64)
        return np.take(_scaled(levels, low, high), samples.astype(np.int64) - limits.min)
    return _scaled(samples.astype(np.float64), low, high)


def _scaled(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.uint8]:
    values -= low
    values *= 255 / (high - low)
    np.nan_to_num(values, copy=False, nan=0)
    return np.rint(values).clip(0, 255).astype(np.uint8)


def _samples(scale: tuple[float, float], factor: float, offset: float) -> tuple[float, float]:
    """Values of the file's units as samples."""
    return (scale[0] - offset) / factor, (scale[1] - offset) / factor


def _require_reach(
    path: Path, kinds: set[str], units: tuple[tuple[float, float], ...], scale: tuple[float, float]
) -> None:
    """Refuse a scale in samples where the file's units are others: nearly everything would become 0."""
    if any(np.dtype(kind).kind not in "iu" for kind in kinds):
        return
    ends = [np.iinfo(kind) for kind in kinds]
    reached = [x * factor + offset for end in ends for x in (end.min, end.max) for factor, offset in units]
    if scale[0] >= max(reached) or scale[1] > 2 * max(map(abs, reached)):
        raise InputError(
            f"the file's values reach from {min(reached):g} to {max(reached):g}, so none becomes white",
            value=f"--scale {scale[0]:g}..{scale[1]:g} for {path} ({_spoken(units)})",
            hint="give --scale in the file's units",
        )


def _unscaled(
    source: Any, channels: Channels, path: Path, kinds: set[str], units: tuple[tuple[float, float], ...]
) -> InputError:
    """The complaint about samples other than levels of 8 bits, with the range of some of them."""
    values = []
    for block in sampled(source, channels.indexes, masked=True):
        factor, offset = (np.reshape(x, (-1, 1, 1)) for x in zip(*units, strict=True))
        numbers = (block.astype(np.float64) * factor + offset).compressed()
        values.append(numbers[np.isfinite(numbers)])
    found = np.concatenate(values)
    span = f"{found.min():g} to {found.max():g} in a sample" if found.size else "no valid value in a sample"
    unit = f"; {_spoken(units)}" if any(unit != (1, 0) for unit in units) else ""
    return InputError(
        f"the samples are {'/'.join(sorted(kinds))}, and it is not said how they become 0 to 255",
        value=f"{path} ({span}{unit})",
        hint="give --scale LOW..HIGH, as in --scale 0..3000",
    )


def _spoken(units: tuple[tuple[float, float], ...]) -> str:
    return ", ".join(f"{factor:g} times the sample {offset:+g}" for factor, offset in dict.fromkeys(units))
