"""The scores of a template at a position of a map, and the sums that they are made of.

All count only *common* pixels: those that the template's mask and the map's valid pixels both hold.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError

Picture = NDArray[np.bool_] | NDArray[np.uint8] | NDArray[np.float32]
"""What is matched: edges or any other binary image, grey levels, or real numbers; ``[height, width]``."""

Score = Literal["correlation", "ncc", "match_count"]
"""How a position is judged, from its common pixels; more is better.

- ``correlation``: the sum of products, which favours where the map has many edges (Eq. 1 of the reference).
- ``ncc``: Pearson's correlation coefficient, -1 to 1; 0 where either picture is constant.
- ``match_count``: the share of pixels that agree (XNOR and popcount), 0 to 1; of binary pictures only.
"""

Values = NDArray[np.floating[Any]]


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over the common pixels of map pixels f and template pixels w, an element for each position.

    Each broadcasts against the others. Sums that the score does not need may be anything.

    Attributes:
        count: how many pixels are common, n.
        f: sum of f.
        ff: sum of f squared.
        w: sum of w.
        ww: sum of w squared.
        fw: sum of f times w.
    """

    count: Values
    f: Values
    ff: Values
    w: Values
    ww: Values
    fw: Values


def evaluate(score: Score, sums: Sums) -> Values:
    """The score at each position, of the sums' shape and type; 0 where no pixel is common."""
    if score == "correlation":
        return sums.fw
    count = np.maximum(sums.count, np.asarray(1e-6, dtype=sums.count.dtype))
    if score == "match_count":
        differing = sums.f + sums.w - 2 * sums.fw
        return np.asarray(np.where(sums.count > 0, (count - differing) / count, 0))

    covariance = sums.fw * count
    covariance -= sums.f * sums.w
    covariance /= _spread(sums.f, sums.ff, count)
    covariance /= _spread(sums.w, sums.ww, count)
    return covariance


def _spread(total: Values, squares: Values, count: Values) -> Values:
    """Count times standard deviation; infinite where a picture is constant, so that its score is 0."""
    variance = squares * count - total * total
    # Above the rounding errors that a constant picture has for a variance.
    floor = squares * (count * count.dtype.type({"f": 1e-5, "d": 1e-12}[count.dtype.char]))
    return np.asarray(np.sqrt(np.where(variance > floor, variance, np.inf)))


def check_score(score: Score, picture: Picture) -> None:
    """Refuse a match count of pictures that are not binary.

    Raises:
        InputError: the score cannot be computed of this picture.
    """
    if score == "match_count" and picture.dtype != np.bool_:
        raise InputError(
            "the match count compares bits, not grey levels",
            value=picture.dtype,
            hint="use a binary picture, or the score ncc",
        )
