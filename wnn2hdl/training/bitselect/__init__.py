"""Bit selection: the raw pixel bits, and the tables over them, that classify best within a few LUTs.

Everything for single pixels works on colours counted by image and class, never on pixels: appearance drift
between images (`drift`), a smooth reference classifier (`reference`), its verdict on every code (`mass`),
then the search for one LUT (`single`) or for a cascade of two or three (`cascade`). Tables over a pixel and
its neighbours (`neighbourhood`) are found the same way, from windows.
"""

from wnn2hdl.training.bitselect.drift import LEAST_SHARE, main_drift
from wnn2hdl.training.bitselect.neighbourhood import LUTS, SIZES, select_neighbourhood
from wnn2hdl.training.bitselect.select import MOST_LUTS, Histogram, look_up_table, select_bits

__all__ = [
    "LEAST_SHARE",
    "LUTS",
    "MOST_LUTS",
    "SIZES",
    "Histogram",
    "look_up_table",
    "main_drift",
    "select_bits",
    "select_neighbourhood",
]
