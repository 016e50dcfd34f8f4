"""What is done to one window: classify, let squares vote, smooth."""

import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.cleanup import despeckle
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.images import Source, whole_windows
from wnn2hdl.raster import NODATA

_STRIP_PIXELS = 1 << 17
_STRIP_ROWS = 32
"""A window is classified some rows at a time, so that what is made on the way stays in the cache."""


@dataclass(frozen=True)
class Method:
    """How pixels get their classes.

    Attributes:
        square: side of the squares that vote; None for each pixel by itself.
        share: share of a square's pixels that vote.
        seed: which ones.
        smooth: radius of the majority filter afterwards; 0 for none.
    """

    square: int | None = None
    share: float = 0.5
    seed: int = 0
    smooth: int = 0

    @property
    def side(self) -> int:
        """What windows must be multiples of."""
        return self.square or 1

    @property
    def margin(self) -> int:
        """Pixels around a window whose classes count for those within: a multiple of `side`."""
        return -(-self.smooth // self.side) * self.side


@dataclass(frozen=True)
class WindowResult:
    """The classes of a window.

    Attributes:
        index: the window's number.
        packed: compressed class indices, `NODATA` where nothing was classified.
        valid: pixels that were classified.
        covered: those among them whose colours the classifier knows.
    """

    index: int
    packed: bytes
    valid: int
    covered: int


def classify_window(
    source: Source, classifier: PictureClassifier, method: Method, window: Window
) -> WindowResult:
    """Classify a window; the classes do not depend on how the picture is cut into windows.

    At the picture's borders a classifier that looks at neighbours sees the outermost pixels repeated.

    Raises:
        InputError: the picture cannot be read there.
    """
    margin = method.margin
    top, left = max(window.row - margin, 0), max(window.column - margin, 0)
    bottom = min(window.row + window.height + margin, source.height)
    right = min(window.column + window.width + margin, source.width)
    inner = np.s_[
        window.row - top : window.row - top + window.height,
        window.column - left : window.column - left + window.width,
    ]
    picture, valid = _read(source, top, left, bottom, right, classifier.halo)
    classes, known = _by_strips(classifier, picture, (bottom - top, right - left))
    if method.square:
        classes = vote(
            classes,
            valid,
            side=method.square,
            share=method.share,
            seed=method.seed,
            count=len(classifier.classes),
            row=top,
            column=left,
        )
    if method.smooth:
        everywhere = np.ones(classes.shape, dtype=np.bool_)
        classes = despeckle(classes, everywhere if valid is None else valid, method.smooth)
    classes, known = classes[inner], known[inner]
    if valid is not None:
        valid = valid[inner]
        known &= valid
        classes[~valid] = NODATA
    return WindowResult(
        window.index,
        zlib.compress(classes.tobytes(), level=1),
        classes.size if valid is None else int(np.count_nonzero(valid)),
        int(np.count_nonzero(known)),
    )


def unpack(result: bytes, window: Window) -> NDArray[np.uint8]:
    """The classes in `WindowResult.packed`: uint8 ``[height, width]``."""
    flat = np.frombuffer(zlib.decompress(result), dtype=np.uint8)
    return flat.reshape(window.height, window.width)


def _read(
    source: Source, top: int, left: int, bottom: int, right: int, halo: int
) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
    """The picture from (top, left) to before (bottom, right) with its halo, and what is valid without it.

    A pixel whose halo is not all data is not valid.
    """
    first, start = max(top - halo, 0), max(left - halo, 0)
    last, end = min(bottom + halo, source.height), min(right + halo, source.width)
    picture, valid = source.read(first, start, last - first, end - start)
    beyond = [
        (halo - (top - first), halo - (last - bottom)),
        (halo - (left - start), halo - (end - right)),
        (0, 0),
    ]
    if valid is not None:
        valid = whole_windows(valid, halo)[top - first : bottom - first, left - start : right - start]
    return np.pad(picture, beyond, mode="edge") if halo else picture, valid


def _by_strips(
    classifier: PictureClassifier, picture: NDArray[np.uint8], shape: tuple[int, int]
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """Class of each pixel, and whether the classifier knows its colours."""
    classes, known = np.empty(shape, dtype=np.uint8), np.empty(shape, dtype=np.bool_)
    rows = max(_STRIP_PIXELS // shape[1], _STRIP_ROWS)
    for top in range(0, shape[0], rows):
        strip = picture[top : top + rows + 2 * classifier.halo]
        classes[top : top + rows], known[top : top + rows] = classifier.answer(strip)
    return classes, known
