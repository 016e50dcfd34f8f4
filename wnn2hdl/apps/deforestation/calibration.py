"""What a picture's samples mean by what its file states: pictures that are compared must agree on it."""

from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.errors import InputError
from wnn2hdl.raster.channels import choose_channels
from wnn2hdl.raster.gdal import gdal, open_raster


@dataclass(frozen=True)
class Calibration:
    """How the samples of the bands that are read become values: value = scale · sample + offset.

    Attributes:
        types: GDAL's names of the sample types, sorted: ``("uint16",)``.
        scales: of each band; 1 where the file states none.
        offsets: of each band; 0 where the file states none.
    """

    types: tuple[str, ...]
    scales: tuple[float, ...]
    offsets: tuple[float, ...]

    @classmethod
    def read(cls, path: Path, bands: tuple[int, ...] | None) -> "Calibration":
        """Of the bands that are read of a file.

        Raises:
            InputError: the file cannot be read, or does not say which bands to take.
        """
        with gdal(path) as rasterio, open_raster(rasterio, path) as source:
            names = tuple(kind.name for kind in source.colorinterp)
            chosen = [index - 1 for index in choose_channels(path, names, source.descriptions, bands).indexes]
            return cls(
                tuple(sorted({source.dtypes[index] for index in chosen})),
                tuple(float(source.scales[index]) for index in chosen),
                tuple(float(source.offsets[index]) for index in chosen),
            )

    def comparable(self, other: "Calibration") -> bool:
        """Whether one scale serves both: they agree, or both state the units that a scale is in.

        An offset without a scale states no units: it may be in those of the samples or in others.
        """
        return self == other or all(scale != 1 for scale in (*self.scales, *other.scales))

    def __str__(self) -> str:
        """One line for an error."""
        scales, offsets = (
            ",".join(dict.fromkeys(f"{value:g}" for value in values))
            for values in (self.scales, self.offsets)
        )
        return f"{'/'.join(self.types)}, scale {scales}, offset {offsets}, {len(self.scales)} bands"


def require_comparable(one: Path, first: Calibration, other: Path, second: Calibration, hint: str) -> None:
    """Refuse two pictures whose samples mean different things, so that no one scale serves both.

    Raises:
        InputError: the pictures differ in their sample types, scales, offsets or number of bands, and do not
            both state units.
    """
    if not first.comparable(second):
        raise InputError(
            "the samples of two pictures mean different values",
            value=f"{one} ({first}) and {other} ({second})",
            hint=hint,
        )
