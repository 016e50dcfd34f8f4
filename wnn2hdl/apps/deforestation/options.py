"""What a user may want of a scan."""

from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.apps.deforestation.cleanup import MinimumSize
from wnn2hdl.raster import Reading

Vector = Literal["geojson", "gpkg", "none"]


@dataclass(frozen=True)
class ScanOptions:
    """What is wanted.

    Attributes:
        reading: how pictures are read.
        method: squares and smoothing.
        minimum: smaller regions are dissolved into their surroundings; None for no such limit.
        vector: the format of polygons.
    """

    reading: Reading = field(default_factory=Reading)
    method: Method = field(default_factory=Method)
    minimum: MinimumSize | None = None
    vector: Vector = "geojson"

    def to_json(self) -> dict[str, Any]:
        """A flat JSON object."""
        reading = self.reading
        return {
            "bands": list(reading.bands) if reading.bands else None,
            "scale": list(reading.scale) if reading.scale else None,
            "alpha": reading.alpha,
            "exclude": str(reading.exclude) if reading.exclude else None,
            **asdict(self.method),
            "minimum_pixels": (self.minimum and self.minimum.pixels) or None,
            "minimum_hectares": (self.minimum and self.minimum.hectares) or None,
            "vector": self.vector,
        }
