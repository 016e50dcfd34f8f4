"""Template matching: where in a map does a picture lie, and how sure is that."""

from wnn2hdl.apps.navigation.matching.confidence import Acceptance, choose_threshold, peak_weights
from wnn2hdl.apps.navigation.matching.index import MapIndex
from wnn2hdl.apps.navigation.matching.peaks import Match, Peak, Window
from wnn2hdl.apps.navigation.matching.scores import Picture, Score

__all__ = [
    "Acceptance",
    "MapIndex",
    "Match",
    "Peak",
    "Picture",
    "Score",
    "Window",
    "choose_threshold",
    "peak_weights",
]
