"""Search as a match engine does it: by counts of agreeing bits, one segment of the map after the other."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching.peaks import Match, Peak, Window, keep_apart
from wnn2hdl.apps.navigation.matching.scores import Score
from wnn2hdl.apps.navigation.matching.spectra import cut
from wnn2hdl.ir.engine import EngineAnswer, EngineFormat

Bits = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Segment:
    """A segment as an engine loads it.

    Attributes:
        top: map row of its first row; negative where it reaches beyond the map.
        left: map column of its first column.
        bits: bool of the engine's `segment`, false beyond the map.
    """

    top: int
    left: int
    bits: Bits


class SegmentIndex:
    """A binary map, searched by a match engine.

    The engine's template is the rectangle of its size that shows most of the frame, nearest the frame's
    middle. It has no masks: what the frame or the map do not show is false there. The segments lie side by
    side, so that their positions cover the window; a segment with more positions than the window has its
    middle there. An answer counts if it is a position of the window where map and frame have enough in
    common.

    Args:
        image: bool ``[height, width]``.
        valid: bool ``[height, width]``, the pixels that hold the map.
        engine: sizes of template and segment; what the answer is does not depend on its lanes and columns.
    """

    def __init__(self, image: Bits, valid: Bits, *, engine: EngineFormat) -> None:
        self._image = image & valid
        self._valid = valid
        self._engine = engine

    def search(
        self,
        template: Bits,
        mask: Bits,
        score: Score = "match_count",  # noqa: ARG002  # an engine knows no other
        window: Window | None = None,
        *,
        min_overlap: float = 0.75,
        exclusion: int = 20,
    ) -> Match | None:
        """What the engine answers, taken together over all segments.

        Args:
            template: bool ``[h, w]``, the frame.
            mask: bool ``[h, w]``, its pixels that count.
            score: not looked at, agreeing bits are counted.
            window: allowed positions of the frame's top left pixel; by default all at which the engine's
                template lies on the map.
            min_overlap: least share of the engine's template that the frame has to show; and of what the
                frame shows there, the share that has to be on the map.
            exclusion: peaks of different segments are more than this many rows or columns apart.

        Returns:
            the match, whose scores are whole numbers of pixels; mean and deviation are those of all positions
            of all segments. None if no answer counts.
        """
        row, column = self.piece(mask)
        piece, shown = (cut(bits, row, column, self._engine.template) for bits in (template & mask, mask))
        if shown.mean() < min_overlap:
            return None
        peaks, answers = list[Peak](), list[EngineAnswer]()
        for segment in self.segments(self._moved(window, row, column)):
            answer = self._engine.answer(piece, segment.bits)
            answers.append(answer)
            for place, count in ((answer.best, answer.score), (answer.second, answer.second_score)):
                if place is not None:
                    peak = Peak(segment.top + place[0] - row, segment.left + place[1] - column, float(count))
                    if self._counts(peak, window, (row, column), shown, min_overlap):
                        peaks.append(peak)
        if not peaks:
            return None
        positions = sum(answer.positions for answer in answers)
        mean = sum(answer.total for answer in answers) / positions
        variance = sum(answer.squares for answer in answers) / positions - mean**2
        return Match(keep_apart(peaks, exclusion), mean, math.sqrt(max(variance, 0.0)))

    def piece(self, mask: Bits) -> tuple[int, int]:
        """Row and column in a frame from where the engine's template is taken."""
        height, width = self._engine.template
        rows, columns = (max(side, most) for side, most in zip(mask.shape, (height, width), strict=True))
        # A frame smaller than the template lies in its middle.
        top, left = (rows - mask.shape[0]) // 2, (columns - mask.shape[1]) // 2
        counted = cv2.integral(cut(mask, -top, -left, (rows, columns)).astype(np.uint8))
        strips = counted[height:] - counted[:-height]
        shown = strips[:, width:] - strips[:, :-width]
        places = np.argwhere(shown == shown.max())
        middle = np.array(((rows - height) / 2, (columns - width) / 2))
        nearest = places[((places - middle) ** 2).sum(axis=1).argmin()]
        return int(nearest[0]) - top, int(nearest[1]) - left

    def segments(self, window: Window) -> Iterator[Segment]:
        """The segments whose positions cover a window of the engine's template, row by row."""
        tops, lefts = (
            _starts(first, span, positions)
            for first, span, positions in zip(
                (window.top, window.left), window.shape, self._engine.positions, strict=True
            )
        )
        for top in tops:
            for left in lefts:
                yield Segment(top, left, cut(self._image, top, left, self._engine.segment))

    def _moved(self, window: Window | None, row: int, column: int) -> Window:
        """The positions of the engine's template for those of the frame, at which it touches the map."""
        height, width = self._image.shape
        rows, columns = self._engine.template
        if window is None:
            return Window(0, 0, max(height - rows, 0) + 1, max(width - columns, 0) + 1)
        moved = Window(window.top + row, window.left + column, window.bottom + row, window.right + column)
        return moved.clip(Window(1 - rows, 1 - columns, height, width))

    def _counts(
        self, peak: Peak, window: Window | None, piece: tuple[int, int], shown: Bits, min_overlap: float
    ) -> bool:
        at = Window(peak.row, peak.col, peak.row + 1, peak.col + 1)
        if window is not None and not window.clip(at).positions:
            return False
        under = cut(self._valid, peak.row + piece[0], peak.col + piece[1], self._engine.template)
        return bool((under & shown).sum() >= min_overlap * shown.sum())


def _starts(first: int, span: int, positions: int) -> list[int]:
    """Where segments of so many positions start along one side, to cover a span of positions."""
    count = -(-span // positions)
    if count == 1:
        return [first - (positions - span) // 2]
    return [first + number * (span - positions) // (count - 1) for number in range(count)]
