"""What a user may want of a scan."""

from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.raster import Reading

Vector = Literal["geojson", "gpkg", "none"]


@dataclass(frozen=True)
class ScanOptions:
    """What is wanted.

    Attributes:
        reading: how pictures are read.
        method: squares and smoothing.
        minimum_pixels: regions of fewer pixels are dissolved into their surroundings; None for no such limit.
        minimum_hectares: the same as an area; at most one of the two is given.
        vector: the format of polygons.
    """

    reading: Reading = field(default_factory=Reading)
    method: Method = field(default_factory=Method)
    minimum_pixels: int | None = None
    minimum_hectares: float | None = None
    vector: Vector = "geojson"

    def to_json(self) -> dict[str, Any]:
        """A flat JSON object."""
        reading = self.reading
        return {
            "bands": list(reading.bands) if reading.bands else None,
            "scale": list(reading.scale) if reading.scale else None,
            "alpha": reading.alpha,
            "mask": str(reading.mask) if reading.mask else None,
            **asdict(self.method),
            "minimum_pixels": self.minimum_pixels,
            "minimum_hectares": self.minimum_hectares,
            "vector": self.vector,
        }
