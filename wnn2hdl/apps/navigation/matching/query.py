"""A template made ready for a search."""

import numpy as np

from wnn2hdl.apps.navigation.matching.scores import Score, Sums, Values, evaluate
from wnn2hdl.apps.navigation.matching.spectra import Layers, TemplateSpectra


class Query:
    """What is searched for: a template, how it is judged, and how much of it must be common with the map.

    Args:
        layers: the template's.
        score: how a position is judged.
        min_overlap: least share of the mask's pixels that must be common.
        area: pixels of the full map that one of these stands for.
    """

    def __init__(self, layers: Layers, score: Score, min_overlap: float, area: int = 1) -> None:
        self.layers = layers
        self.score: Score = score
        self._min_overlap = min_overlap
        self._area = area
        # At least one common pixel, also where no share is asked for.
        self._least = max(min_overlap * float(layers.inside.sum(dtype=np.float64)), 1.0)
        self._spectra: tuple[tuple[int, int], TemplateSpectra] | None = None

    def spectra(self, shape: tuple[int, int]) -> TemplateSpectra:
        """The template's spectra for patches of ``shape``; those of the last shape are kept."""
        if self._spectra is None or self._spectra[0] != shape:
            self._spectra = shape, TemplateSpectra.of(self.layers, shape)
        return self._spectra[1]

    def shrink(self, factor: int) -> "Query":
        """The query shrunk, in single precision."""
        small = self.layers.shrink(factor).single()
        return Query(small, self.score, self._min_overlap, factor**2)

    def evaluate(self, sums: Sums, slack: float) -> Values:
        """Scores, minus infinity where more than ``slack`` pixels lack to the least overlap."""
        scores = evaluate(self.score, sums)
        if self.score == "correlation" and self._area > 1:
            scores = scores * scores.dtype.type(self._area)
        enough = sums.count > self._least - slack
        return scores if bool(enough.all()) else np.where(enough, scores, scores.dtype.type(-np.inf))
