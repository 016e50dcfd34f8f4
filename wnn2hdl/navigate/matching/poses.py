"""Search over small errors of heading and scale."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.navigate.matching.index import MapIndex
from wnn2hdl.navigate.matching.peaks import Match, Window
from wnn2hdl.navigate.matching.scores import Picture, Score

MakeTemplate = Callable[[float, float], tuple[Picture, NDArray[np.bool_]]]
"""From corrections of yaw (degrees) and scale (a factor) to a template and its mask."""


@dataclass(frozen=True)
class PoseMatch:
    """The best match over several poses.

    Attributes:
        match: where.
        yaw: the winner's correction of the yaw, degrees.
        scale: the winner's correction of the scale, a factor.
    """

    match: Match
    yaw: float
    scale: float


def search_poses(
    index: MapIndex,
    make_template: MakeTemplate,
    yaws: Iterable[float],
    scales: Iterable[float] = (1.0,),
    score: Score = "ncc",
    window: Callable[[float, float], Window] | Window | None = None,
    *,
    min_overlap: float = 0.75,
    exclusion: int = 20,
) -> PoseMatch | None:
    """Try every yaw with every scale and keep the match of the best score.

    Scores of templates of different sizes are comparable for ``ncc`` and ``match_count``; the ``correlation``
    favours larger templates.

    Args:
        index: the map.
        make_template: gives the template of a pose.
        yaws: corrections of the yaw, degrees.
        scales: corrections of the scale, factors.
        score: how a position is judged.
        window: allowed positions of the template's top left pixel, or how to find them for a pose, since
            templates of different poses are of different sizes; by default all.
        min_overlap: as in `MapIndex.search`.
        exclusion: as there.

    Returns:
        the best match, of equal ones the first tried; None if no pose has enough common pixels anywhere.
    """
    best: PoseMatch | None = None
    for yaw, scale in product(tuple(yaws), tuple(scales)):
        template, mask = make_template(yaw, scale)
        allowed = window(yaw, scale) if callable(window) else window
        match = index.search(template, mask, score, allowed, min_overlap=min_overlap, exclusion=exclusion)
        if match is not None and (best is None or match.score > best.match.score):
            best = PoseMatch(match, yaw, scale)
    return best
