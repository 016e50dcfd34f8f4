"""What pictures say about every edge pattern: enough to compute the F1 of any set of them."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from wnn2hdl.edges.compare import widened
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WINDOW_CODES, window_codes


@dataclass(frozen=True, eq=False)
class Evidence:
    """Windows and reference edges of a set of pictures.

    Attributes:
        seen: int64 ``[512]``, how often each window occurs.
        near: int64 ``[512]``, how often at most one pixel from a reference edge pixel.
        around: int64 ``[u, 9]``, each different set of windows at and around a reference edge pixel, filled
            up with 512.
        times: int64 ``[u]``, how often each of these sets occurs.
    """

    seen: NDArray[np.int64]
    near: NDArray[np.int64]
    around: NDArray[np.int64]
    times: NDArray[np.int64]

    def f1(self, patterns: NDArray[np.bool_]) -> float:
        """F1 within one pixel of the filter that holds ``patterns``, bool ``[512]``.

        It is that of `wnn2hdl.edges.agreement`, pooled over the pictures, windows on their rims aside.
        """
        met = self.times[self._members(patterns) > 0].sum()
        found, near = self.seen[patterns].sum(), self.near[patterns].sum()
        return float(self._f1(found, near, met))

    def gains(self, patterns: NDArray[np.bool_]) -> NDArray[np.float64]:
        """For each window, F1 with it less F1 without it, the other ``patterns`` kept: float64 ``[512]``."""
        members = self._members(patterns)
        found, near = self.seen[patterns].sum(), self.near[patterns].sum()
        met = self.times[members > 0].sum()
        sign = np.where(patterns, -1, 1)
        # Flipping a window adds the edge pixels that nothing met, or loses those that it alone met.
        change = np.where(patterns, self._pixels(members == 1), self._pixels(members == 0))
        flipped = self._f1(found + sign * self.seen, near + sign * self.near, met + sign * change)
        return np.asarray(sign * (flipped - self._f1(found, near, met)))

    def _members(self, patterns: NDArray[np.bool_]) -> NDArray[np.int64]:
        return np.asarray(np.append(patterns, False)[self.around].sum(axis=1))

    def _pixels(self, chosen: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Edge pixels of the chosen sets that have each window around them."""
        weights = np.repeat(self.times[chosen], self.around.shape[1])
        pixels = np.bincount(self.around[chosen].ravel(), weights, WINDOW_CODES + 1)
        return pixels[:WINDOW_CODES].astype(np.int64)

    def _f1(
        self, found: NDArray[np.int64], near: NDArray[np.int64], met: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        # 2 P R / (P + R) with P = near / found and R = met / expected.
        expected = self.times.sum()
        return np.asarray(2.0 * near * met / np.maximum(near * expected + met * found, 1))


def gather(pictures: Iterable[tuple[NDArray[np.bool_], NDArray[np.bool_]]]) -> Evidence:
    """Read the evidence off pictures.

    Args:
        pictures: for each picture, the classifier's output, bool ``[height, width]``, true for foreground,
            and Canny's edges of the grey picture, bool ``[height - 2, width - 2]``; at least 5x5 pixels.

    Raises:
        InputError: no picture has an edge.
    """
    seen = np.zeros(WINDOW_CODES, dtype=np.int64)
    near = np.zeros(WINDOW_CODES, dtype=np.int64)
    around = []
    for binary, edges in pictures:
        codes = window_codes(binary)
        seen += np.bincount(codes.ravel(), minlength=WINDOW_CODES)
        near += np.bincount(codes[widened(edges)], minlength=WINDOW_CODES)
        around.append(sliding_window_view(codes, (3, 3))[edges[1:-1, 1:-1]].reshape(-1, 9))
    if not any(map(len, around)):
        raise InputError("Canny finds no edge in the pictures", hint="give pictures with more contrast")
    sets = np.sort(np.concatenate(around), axis=1)
    sets[:, 1:][sets[:, 1:] == sets[:, :-1]] = WINDOW_CODES
    unique, times = np.unique(np.sort(sets, axis=1), axis=0, return_counts=True)
    return Evidence(seen, near, unique, times.astype(np.int64))
