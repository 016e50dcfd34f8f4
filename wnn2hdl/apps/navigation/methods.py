"""The ways of seeing that are compared: how a frame is laid on the ground, and what of it is matched."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.binarise import binary_images, shrunk
from wnn2hdl.apps.navigation.channels import ChannelIndex, Channels
from wnn2hdl.apps.navigation.matching import MapIndex, Match, Picture, Score, SegmentIndex, Window
from wnn2hdl.apps.navigation.weightless import GSD_M, WeightlessEdges
from wnn2hdl.edges import boundary, canny, grey, sobel
from wnn2hdl.edges.reference import CANNY_SIGMA
from wnn2hdl.errors import InputError
from wnn2hdl.ir import window_codes
from wnn2hdl.ir.engine import EngineFormat, Shape

EDGE_SHARE = 0.2
"""Share of a picture's pixels whose gradient reaches the threshold of Sobel, and the lower one of Canny."""

CANNY_RATIO = 2.5
"""Canny's upper threshold, to start an edge with, over his lower; he advised 2 to 3."""

Description = Picture | Channels
"""What is matched: one picture, or several binary ones of the same scene."""

Describe = Callable[[NDArray[np.uint8], NDArray[np.bool_]], tuple[Description, NDArray[np.bool_]]]
"""Of a picture, uint8 ``[h, w, 3]``, and its valid pixels to a description and which of its pixels count."""


class Index(Protocol):
    """A described map that is searched for described frames."""

    def search(
        self,
        template: Any,
        mask: NDArray[np.bool_],
        score: Score = ...,
        window: Window | None = ...,
        *,
        min_overlap: float = ...,
        exclusion: int = ...,
    ) -> Match | None:
        """As `wnn2hdl.apps.navigation.matching.MapIndex.search`."""


@dataclass(frozen=True)
class Method:
    """One row of the table.

    Attributes:
        key: its name in JSON, ``perspective-canny``.
        title: its name in tables, "perspective + Canny".
        describe: what is matched; the same for the map and for patches of frames.
        index: of a described map.
        perspective: frames are laid on the ground by all angles; else by yaw and scale alone.
        gsd_m: ground sample distance it works at; the map's own if none.
    """

    key: str
    title: str
    describe: Describe
    index: Callable[[Any, NDArray[np.bool_]], Index] = MapIndex
    perspective: bool = True
    gsd_m: float | None = None


WEIGHTLESS = "perspective-weightless"
"""Key of the project's own method."""

METHODS = ("perspective-canny", "rotation-canny", WEIGHTLESS, "perspective-sobel", "grey")
"""Keys of the methods that are compared by default, in the order of the tables."""

ENGINE_METHODS = ("engine", "engine-edges")
"""Keys of the methods that answer as a match engine does, whose sizes have to be given."""


def engine_of(template: Shape | None, segment: Shape | None, keys: Collection[str]) -> EngineFormat | None:
    """The engine that methods answer as; None if none of them does.

    Args:
        template: rows and columns, in pixels of `GSD_M`.
        segment: the same.
        keys: of the methods that are compared.

    Raises:
        InputError: there is no such method or engine, or sizes are missing or are not for any of the methods.
    """
    known = (*METHODS, *ENGINE_METHODS)
    if unknown := [key for key in keys if key not in known]:
        raise InputError("there is no such method", value=unknown[0], hint=f"choose of {', '.join(known)}")
    asked = [key for key in keys if key in ENGINE_METHODS]
    if template is None and segment is None and not asked:
        return None
    if not asked:
        raise InputError(
            "--template and --segment are for a match engine", hint=f"give --methods {ENGINE_METHODS[0]}"
        )
    if template is None or segment is None:
        raise InputError(
            "a match engine has a template and a segment",
            value=asked[0],
            hint=f"give both --template and --segment, in pixels of {GSD_M:g} m: 32x32 and 128x128",
        )
    try:
        return EngineFormat(template, segment, lanes=1, columns=template[1])
    except ValueError as error:
        raise InputError("there is no such match engine", value=error, hint="give other sizes") from error


def compared_methods(
    weightless: WeightlessEdges, keys: Collection[str] = METHODS, engine: EngineFormat | None = None
) -> tuple[Method, ...]:
    """The rows of these keys.

    Args:
        weightless: edges that were learned or chosen before.
        keys: of the rows.
        engine: sizes of the match engine that `ENGINE_METHODS` answer as; None if none of them is wanted.
    """
    rows: tuple[Method, ...] = (
        Method("perspective-canny", "perspective + Canny", canny_edges),
        Method("rotation-canny", "rotation + Canny", canny_edges, perspective=False),
        Method(
            WEIGHTLESS,
            "perspective + weightless",
            weightless.extract,
            ChannelIndex,
            gsd_m=weightless.gsd_m,
        ),
        Method("perspective-sobel", "perspective + Sobel", sobel_edges),
        Method("grey", "perspective + grey levels", grey_levels),
    )
    if engine is not None:
        index = partial(SegmentIndex, engine=engine)
        describe = partial(brighter, side=weightless.side), partial(outlines, side=weightless.side)
        rows += (
            Method("engine", "match engine", describe[0], index, gsd_m=weightless.gsd_m),
            Method("engine-edges", "match engine, edges", describe[1], index, gsd_m=weightless.gsd_m),
        )
    return tuple(row for row in rows if row.key in keys)


def canny_edges(
    picture: NDArray[np.uint8], valid: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Canny's edges, one pixel thicker all around: a thin line may miss its counterpart by one pixel.

    Thresholds are the picture's own: an edge in sunlit streets is much stronger than one on ploughed fields.
    """
    levels = grey(picture)
    # The Gaussian before and the line's growth after reach five pixels.
    inside = shrunk(valid, 5)
    smooth = cv2.GaussianBlur(levels, (0, 0), CANNY_SIGMA)
    across, down = (cv2.Sobel(smooth, cv2.CV_32F, *axis, ksize=3) for axis in ((1, 0), (0, 1)))
    low = _threshold(np.hypot(across, down), inside)
    edges = np.pad(canny(levels, round(low), round(CANNY_RATIO * low)), 1).astype(np.uint8)
    cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    return np.asarray(cv2.dilate(edges, cross) > 0), inside


def sobel_edges(
    picture: NDArray[np.uint8], valid: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Sobel's edges in whole numbers, as the hardware baseline, with the picture's own threshold."""
    levels = grey(picture)
    inside = shrunk(valid, 1)
    across, down = (cv2.Sobel(levels, cv2.CV_32F, *axis, ksize=3) for axis in ((1, 0), (0, 1)))
    threshold = _threshold(np.abs(across) + np.abs(down), inside)
    return np.pad(sobel(levels, round(threshold)), 1), inside


def _threshold(gradient: NDArray[np.floating], inside: NDArray[np.bool_]) -> float:
    """What `EDGE_SHARE` of the gradients reach, at least 1."""
    known = gradient[inside]
    return max(1.0, float(np.quantile(known, 1 - EDGE_SHARE))) if known.size else 1.0


def grey_levels(
    picture: NDArray[np.uint8], valid: NDArray[np.bool_]
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """The picture in grey, without any edges."""
    return grey(picture), valid


def brighter(
    picture: NDArray[np.uint8], valid: NDArray[np.bool_], *, side: int
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where red exceeds its mean over the square of ``side`` pixels around, one bit per pixel.

    About half of the bits are set, wherever it is, so that plain counts of agreeing bits favour no place.
    """
    return binary_images(picture, valid, side)[0], valid


def outlines(
    picture: NDArray[np.uint8], valid: NDArray[np.bool_], *, side: int
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """The edges of `brighter`, by the edge filter that video cores have by default."""
    bits, _ = brighter(picture, valid, side=side)
    inside = shrunk(valid, 1)
    return np.pad(boundary().evaluate(window_codes(bits)), 1) & inside, inside
