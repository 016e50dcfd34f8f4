"""Minimising tables: two-level covers, and networks of LUTs; each proved equal on the care set."""

from wnn2hdl.minimise.check import require_equal
from wnn2hdl.minimise.espresso import Minimised, espresso
from wnn2hdl.minimise.portfolio import EFFORTS, Candidate, Mapping, generators, map_luts
from wnn2hdl.minimise.support import minimum_supports

__all__ = [
    "EFFORTS",
    "Candidate",
    "Mapping",
    "Minimised",
    "espresso",
    "generators",
    "map_luts",
    "minimum_supports",
    "require_equal",
]
