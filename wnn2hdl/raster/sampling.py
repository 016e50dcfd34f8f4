"""Parts of a raster that stand for the whole, so that what is wrong with a large one is reported at once."""

from collections.abc import Iterator, Sequence
from typing import Any

_SIDE = 512
_PLACES = ((0, 0), (1, 1), (0, 1), (1, 0), (0.5, 0.5))


def sampled(source: Any, bands: Sequence[int], *, masked: bool = False) -> Iterator[Any]:
    """Up to five windows of a dataset, from its corners and its middle: arrays ``[bands, rows, columns]``.

    Args:
        source: the dataset.
        bands: band numbers from 1.
        masked: whether the arrays are masked where the file's own mask says so.
    """
    seen = set()
    for place in _PLACES:
        starts = tuple(int(x * max(n - _SIDE, 0)) for x, n in zip(place, source.shape, strict=True))
        if starts not in seen:
            seen.add(starts)
            window = tuple((start, start + _SIDE) for start in starts)
            yield source.read(list(bands), window=window, masked=masked)
