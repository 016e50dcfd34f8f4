"""Template matching: where in a map does a picture lie, and how sure is that."""

from wnn2hdl.apps.navigation.matching.confidence import Acceptance, choose_threshold, peak_weights
from wnn2hdl.apps.navigation.matching.index import MapIndex
from wnn2hdl.apps.navigation.matching.peaks import Match, Peak, Window
from wnn2hdl.apps.navigation.matching.scores import Picture, Score
from wnn2hdl.apps.navigation.matching.segments import SegmentIndex

__all__ = [
    "Acceptance",
    "MapIndex",
    "Match",
    "Peak",
    "Picture",
    "Score",
    "SegmentIndex",
    "Window",
    "choose_threshold",
    "peak_weights",
]
