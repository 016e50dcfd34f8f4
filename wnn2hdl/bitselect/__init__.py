"""Bit selection: the raw pixel bits, and the tables over them, that classify best within one to three LUTs.

Everything works on colours counted by image and class, never on pixels: appearance drift between images
(`drift`), a smooth reference classifier (`reference`), its verdict on every code (`mass`), then the search
for one LUT (`single`) or for a cascade of two or three (`cascade`).
"""

from wnn2hdl.bitselect.select import MOST_LUTS, Histogram, look_up_table, select_bits

__all__ = ["MOST_LUTS", "Histogram", "look_up_table", "select_bits"]
