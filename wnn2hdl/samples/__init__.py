"""The embedded default: deterministic landscapes with exact truth, for tests, demos and first steps."""

from wnn2hdl.samples.ground import CLASSES
from wnn2hdl.samples.render import Landscape, Season, landscape

__all__ = ["CLASSES", "Landscape", "Season", "landscape"]
