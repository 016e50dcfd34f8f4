"""The 3x3 edge filter's pattern sets, and Canny and Sobel to compare their edges with."""

from wnn2hdl.edges.budget import learned_under_budget
from wnn2hdl.edges.compare import Agreement, agreement, filter_agreement
from wnn2hdl.edges.learning import learned
from wnn2hdl.edges.patterns import RULES, boundary, from_file, half_plane
from wnn2hdl.edges.reference import canny, grey, sobel

__all__ = [
    "RULES",
    "Agreement",
    "agreement",
    "boundary",
    "canny",
    "filter_agreement",
    "from_file",
    "grey",
    "half_plane",
    "learned",
    "learned_under_budget",
    "sobel",
]
