"""The edge patterns that best predict Canny's edges of the grey picture from the binarised one."""

from collections.abc import Iterable

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from wnn2hdl.edges.compare import widened
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, window_codes

PATTERNS = 75
"""Patterns in the reference design's edge filter."""

FLAT = (0, WINDOW_CODES - 1)
"""Windows of one colour show no edge; where Canny's edges are dense, they would predict them nonetheless."""

MOST_PATTERNS = WINDOW_CODES - len(FLAT)


def learned(
    pictures: Iterable[tuple[NDArray[np.bool_], NDArray[np.bool_]]], count: int = PATTERNS
) -> EdgeFilter:
    """Choose patterns greedily: at each step the one that leaves the highest F1 within one pixel.

    The F1 is exactly that of `wnn2hdl.edges.agreement` over the given pictures together, windows on the
    pictures' rims aside. Exactly ``count`` patterns are chosen, even if the last lower it; among equals the
    more frequent wins, then the lower code.

    Args:
        pictures: for each picture, the classifier's output, bool ``[height, width]``, true for foreground,
            and Canny's edges of the grey picture, bool ``[height - 2, width - 2]``; at least 5x5 pixels.
        count: patterns to choose, 1 to 510: the two windows of one colour are never an edge.

    Raises:
        InputError: ``count`` is out of range, or no picture has an edge.
    """
    if not 1 <= count <= MOST_PATTERNS:
        raise InputError("an edge filter has 1 to 510 patterns", value=count)
    seen = np.zeros(WINDOW_CODES, dtype=np.int64)
    near = np.zeros(WINDOW_CODES, dtype=np.int64)
    around = []
    for binary, edges in pictures:
        codes = window_codes(binary)
        seen += np.bincount(codes.ravel(), minlength=WINDOW_CODES)
        near += np.bincount(codes[widened(edges)], minlength=WINDOW_CODES)
        around.append(_codes_around(codes, edges))
    neighbourhoods = np.concatenate(around) if around else np.zeros((0, 9), dtype=np.int64)
    if not len(neighbourhoods):
        raise InputError("Canny finds no edge in the pictures", mend="give pictures with more contrast")
    patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
    patterns[_choose(seen, near, neighbourhoods, count)] = True
    return EdgeFilter("learned", patterns)


def _codes_around(codes: NDArray[np.int64], edges: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The window codes at and around each edge pixel, ``[edge pixels, 9]``, repetitions replaced by -1."""
    around = sliding_window_view(codes, (3, 3))[edges[1:-1, 1:-1]].reshape(-1, 9)
    around = np.sort(around, axis=1)
    around[:, 1:][around[:, 1:] == around[:, :-1]] = -1
    return around


def _choose(
    seen: NDArray[np.int64], near: NDArray[np.int64], neighbourhoods: NDArray[np.int64], count: int
) -> list[int]:
    """Greedy choice; ``near`` of the ``seen`` windows of each code are near an edge of Canny's."""
    chosen: list[int] = []
    open_to_choice = np.ones(WINDOW_CODES, dtype=np.bool_)
    open_to_choice[list(FLAT)] = False
    expected = len(neighbourhoods)
    uncovered = neighbourhoods
    found = found_near = 0
    for _ in range(count):
        # Edge pixels that each code would newly cover.
        gain = np.bincount(uncovered.ravel() + 1, minlength=WINDOW_CODES + 1)[1:]
        precision = (found_near + near) / np.maximum(found + seen, 1)
        recall = (expected - len(uncovered) + gain) / expected
        f1 = 2 * precision * recall / np.maximum(precision + recall, np.finfo(np.float64).tiny)
        f1[~open_to_choice] = -1
        best = np.flatnonzero(f1 == f1.max())
        pick = int(best[np.argmax(seen[best])])
        chosen.append(pick)
        open_to_choice[pick] = False
        found, found_near = found + int(seen[pick]), found_near + int(near[pick])
        uncovered = uncovered[~(uncovered == pick).any(axis=1)]
    return chosen
