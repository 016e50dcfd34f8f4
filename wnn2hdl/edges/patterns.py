"""Edge patterns that need no training: by rule, or from a file."""

import json
from collections.abc import Callable, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.files import read_json_value
from wnn2hdl.ir import CENTRE, WINDOW_BITS, WINDOW_CODES, EdgeFilter, codes_to_bits

_LONGEST_SHOWN = 60
"""Characters of a wrong pattern that are shown."""

NEIGHBOURS = (1, 3, 5, 7)
"""The centre's 4-neighbours: above, left, right, below."""


def boundary() -> EdgeFilter:
    """The inner boundary: the centre is set and a 4-neighbour is clear; 240 patterns."""
    return EdgeFilter("boundary", _on_boundary())


def half_plane() -> EdgeFilter:
    """The digital straight edges: boundary patterns that a straight line cuts out of the window; 24 patterns.

    A window is such an edge if its set pixels are exactly the grid points on one side of some line,
    ``{(x, y): a*x + b*y >= c}``, and if it is a `boundary` pattern: the centre is set, a 4-neighbour clear.
    """
    side = range(-1, 2)
    cut = np.zeros(WINDOW_CODES, dtype=np.bool_)
    # Lines through two grid points have slopes 0, 1/2, 1, 2 and infinity; a and b up to 3 reach each slope
    # and the gaps between them, and |a*x + b*y| is at most 6.
    for a, b, c in product(range(-3, 4), range(-3, 4), range(-6, 8)):
        inside = [a * x + b * y >= c for y in side for x in side]
        cut[sum(1 << bit for bit, is_set in enumerate(inside) if is_set)] = True
    return EdgeFilter("half-plane", cut & _on_boundary())


RULES: Mapping[str, Callable[[], EdgeFilter]] = {"boundary": boundary, "half-plane": half_plane}
"""The pattern sets that are rules, by name."""


def from_file(path: Path) -> EdgeFilter:
    """Read a list of patterns; the filter is named after the file's stem.

    The file holds a JSON list, or an object whose ``patterns`` is that list (as a filter is saved). Each
    pattern is a window code from 0 to 511, a string of nine 0s and 1s, or a list of three strings of three:
    rows from top to bottom, columns from left to right, so the first character is bit 0.

    Raises:
        InputError: the file cannot be read, is not such a list, is empty, or a pattern is something else.
    """
    data = read_json_value(path, "a file of edge patterns")
    listed = data.get("patterns") if isinstance(data, dict) else data
    if not isinstance(listed, list) or not listed:
        raise InputError(
            "the file does not hold a list of edge patterns",
            value=path,
            hint="write a JSON list such as [56, 504]",
        )
    patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
    for number, entry in enumerate(listed, start=1):
        patterns[_code(entry, f"pattern {number} of {path}")] = True
    return EdgeFilter(path.stem, patterns)


def _code(entry: Any, where: str) -> int:
    if isinstance(entry, int) and not isinstance(entry, bool) and 0 <= entry < WINDOW_CODES:
        return entry
    rows = entry if isinstance(entry, list) and [len(str(row)) for row in entry] == [3, 3, 3] else [entry]
    text = "".join(row if isinstance(row, str) else "?" for row in rows)
    if len(text) != WINDOW_BITS or not set(text) <= {"0", "1"}:
        raise InputError(
            f"{where} is not a 3x3 pattern",
            value=json.dumps(entry)[:_LONGEST_SHOWN],
            hint=f"write a code from 0 to {WINDOW_CODES - 1}, nine 0s and 1s, or three rows of three",
        )
    return sum(1 << bit for bit, character in enumerate(text) if character == "1")


def _on_boundary() -> NDArray[np.bool_]:
    bits = codes_to_bits(np.arange(WINDOW_CODES), WINDOW_BITS)
    return bits[:, CENTRE] & ~bits[:, NEIGHBOURS].all(axis=1)
