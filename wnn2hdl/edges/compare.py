"""How far two edge images agree within one pixel."""

from collections.abc import Iterable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import EdgeFilter, window_codes


@dataclass(frozen=True)
class Agreement:
    """Counts of edge pixels; sums of counts pool several pictures.

    Attributes:
        found: edge pixels of the tested image.
        found_near: those with a reference edge pixel at most one pixel away, diagonals included.
        expected: edge pixels of the reference.
        expected_near: those with a tested edge pixel at most one pixel away.
    """

    found: int = 0
    found_near: int = 0
    expected: int = 0
    expected_near: int = 0

    def __add__(self, other: "Agreement") -> "Agreement":
        return Agreement(
            self.found + other.found,
            self.found_near + other.found_near,
            self.expected + other.expected,
            self.expected_near + other.expected_near,
        )

    @property
    def precision(self) -> float | None:
        """Share of the found edge pixels that are near a reference edge; None if nothing was found."""
        return self.found_near / self.found if self.found else None

    @property
    def recall(self) -> float | None:
        """Share of the reference's edge pixels that are near a found one; None if it has none."""
        return self.expected_near / self.expected if self.expected else None

    @property
    def f1(self) -> float | None:
        """Harmonic mean of precision and recall; None if either is None."""
        if self.precision is None or self.recall is None:
            return None
        total = self.precision + self.recall
        return 2 * self.precision * self.recall / total if total else 0.0


def agreement(edges: NDArray[np.bool_], reference: NDArray[np.bool_]) -> Agreement:
    """Compare two edge images, bool ``[height, width]`` each."""
    return Agreement(
        found=int(edges.sum()),
        found_near=int((edges & widened(reference)).sum()),
        expected=int(reference.sum()),
        expected_near=int((reference & widened(edges)).sum()),
    )


def filter_agreement(
    edge_filter: EdgeFilter, pictures: Iterable[tuple[NDArray[np.bool_], NDArray[np.bool_]]]
) -> Agreement:
    """Agreement of a filter's edges of binarised pictures with reference edges, pooled over the pictures.

    Args:
        edge_filter: the filter.
        pictures: for each picture, the classifier's output, bool ``[height, width]``, true for foreground,
            and Canny's edges of the grey picture, bool ``[height - 2, width - 2]``.
    """
    total = Agreement()
    for binary, reference in pictures:
        total += agreement(edge_filter.evaluate(window_codes(binary)), reference)
    return total


def widened(edges: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Every pixel at most one pixel from an edge pixel, diagonals included."""
    return np.asarray(cv2.dilate(edges.astype(np.uint8), np.ones((3, 3), dtype=np.uint8)) > 0)
