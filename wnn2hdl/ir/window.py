"""The 3x3 window: the order of its nine bits, and the edge filter that reads them."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir.tables import TruthTable

SIDE = 3
WINDOW_BITS = SIDE * SIDE
"""Bits of a window; bit ``3 * row + column``, so bit 0 is top left, bit 4 the centre, bit 8 bottom right."""

WINDOW_CODES = 1 << WINDOW_BITS
"""Different binary windows: the words of the reference design's 512-entry look-up table."""

CENTRE = 4


def window_codes(image: ArrayLike) -> NDArray[np.int64]:
    """The code of every 3x3 window that lies wholly inside a binary image.

    Args:
        image: bool ``[height, width]``, both at least 3.

    Returns:
        int64 ``[height - 2, width - 2]``.
    """
    windows = sliding_window_view(np.asarray(image, dtype=np.bool_), (SIDE, SIDE))
    weights = 1 << np.arange(WINDOW_BITS).reshape(SIDE, SIDE)
    return np.asarray(np.tensordot(windows.astype(np.int64), weights, axes=2))


def framed_window_codes(image: ArrayLike) -> NDArray[np.int64]:
    """The code of the window around every pixel; beyond the image its nearest pixel is repeated.

    Args:
        image: bool ``[height, width]``.

    Returns:
        int64 ``[height, width]``.
    """
    return window_codes(np.pad(np.asarray(image, dtype=np.bool_), SIDE // 2, mode="edge"))


@dataclass(frozen=True, eq=False)
class EdgeFilter:
    """The 3x3 edge filter: a RAM of 512 one-bit words that holds the patterns taken for an edge.

    Attributes:
        name: the pattern set: ``boundary``, ``half-plane``, ``learned`` …
        patterns: bool ``[512]``, indexed by window code.
    """

    name: str
    patterns: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if self.patterns.shape != (WINDOW_CODES,) or self.patterns.dtype != np.bool_:
            raise ValueError(f"an edge filter holds {WINDOW_CODES} bools, not {self.patterns.shape}")

    @property
    def size(self) -> int:
        """How many patterns count as an edge."""
        return int(self.patterns.sum())

    def table(self) -> TruthTable:
        """The filter as a table over ``bit0`` … ``bit8`` with the output ``edge_bit``, no don't-cares."""
        names = tuple(f"bit{i}" for i in range(WINDOW_BITS))
        return TruthTable.exact(names, ("edge_bit",), self.patterns[:, np.newaxis])

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Edge bit of window codes of any shape."""
        return self.patterns[np.asarray(codes, dtype=np.int64)]

    def to_json(self) -> dict[str, Any]:
        """A JSON object: the name and the codes of the patterns, ascending."""
        return {"name": self.name, "patterns": np.flatnonzero(self.patterns).tolist()}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises `ModelFileError` on anything else."""
        try:
            codes = data["patterns"]
            if not all(type(code) is int and 0 <= code < WINDOW_CODES for code in codes):
                raise ValueError(f"a pattern is a whole number from 0 to {WINDOW_CODES - 1}")
            patterns = np.zeros(WINDOW_CODES, dtype=np.bool_)
            patterns[codes] = True
            return cls(str(data["name"]), patterns)
        except (KeyError, TypeError, ValueError) as error:
            raise ModelFileError("not a list of edge patterns", value=error) from error
