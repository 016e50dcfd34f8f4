"""The edge patterns that best predict Canny's edges of the grey picture from the binarised one."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.edges.evidence import gather
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter

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
    evidence = gather(pictures)
    neighbourhoods = np.repeat(evidence.around, evidence.times, axis=0)
    patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
    patterns[_choose(evidence.seen, evidence.near, neighbourhoods, count)] = True
    return EdgeFilter("learned", patterns)


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
        gain = np.bincount(uncovered.ravel(), minlength=WINDOW_CODES + 1)[:WINDOW_CODES]
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
