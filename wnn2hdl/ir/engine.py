"""The match engine: where in a segment of a map a template agrees in most bits, and how long that takes.

Template and segment are binary pictures. At each position of the template inside the segment the score is
the number of pixels in which the two agree. The engine answers with the best position, a second one
elsewhere, and the sums from which mean and deviation of all scores follow.

Positions are divided into cells of `CELL` x `CELL`. The second position is the best one of all cells that
neither are nor touch the cell of the best one, so it is more than `CELL` rows or columns away from it. Of
equal scores the one in the lowest row counts, and there the one in the lowest column.

An engine has lanes of a number of columns. A lane compares one row of the template, or a part of one that is
``columns`` wide, with the segment at one position per cycle. The lanes hold successive rows of the template
and see the same row of the segment, which streams past them a bit per cycle; so each works on another row of
positions. Bands of as many position rows as there are lanes follow each other; within a band all column
groups of the template, and within a group all rows of the segment that the band touches.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate

CELL = 32
"""Rows and columns of positions in a cell."""

MAX_SIDE = 2048
"""The most rows or columns of a segment: sums of squares fit into 64 bits."""

WORD_BITS = 32
"""Bits of a word, of segments and of results."""

RESULT_WORDS = 8
"""Words in a result, see `EngineAnswer.words`."""

EDGE_BIT = 7
"""The bit of a template's pixel that counts: where a video core puts an edge."""

_OVERHEAD = 12
"""Cycles of a match beside those of `EngineFormat.cycles`: the stages that the last score passes."""

_LANE_LUTS = 40
"""What a lane takes beside its comparison, roughly, in LUTs."""

_BIT_LUTS = 1.3
"""What comparing and counting a bit takes, roughly, in LUTs."""

_LONGEST = 16
"""More cycles than any lane's comparison takes; the shape of an engine is chosen before its registers."""

Shape = tuple[int, int]
"""Rows and columns."""


@dataclass(frozen=True)
class EngineFormat:
    """Sizes of a match engine.

    Attributes:
        template: rows and columns of the template.
        segment: rows and columns of the segment, each more than the template's.
        lanes: how many rows of positions are scored at once, at most as many as there are.
        columns: of the template that a lane compares per cycle; at least 2, and a divisor of the template's.
    """

    template: Shape
    segment: Shape
    lanes: int
    columns: int

    def __post_init__(self) -> None:
        _check_sizes(self.template, self.segment)
        if not 1 <= self.lanes <= self.positions[0]:
            raise ValueError(f"an engine has 1 to {self.positions[0]} lanes, not {self.lanes}")
        if self.columns < 2 or self.template[1] % self.columns:
            raise ValueError(f"lanes of {self.columns} columns do not make up {self.template[1]}")

    @classmethod
    def fast_enough(cls, template: Shape, segment: Shape, cycles: int) -> Self:
        """The engine that takes the fewest LUTs, roughly, of those that match in so many cycles.

        Raises:
            ValueError: the sizes are out of range, or no engine is fast enough; the message says so.
        """
        _check_sizes(template, segment)
        engines = [cls(template, segment, *shape) for shape in _shapes(template, segment)]
        fitting = [engine for engine in engines if engine.cycles(_LONGEST) <= cycles]
        if not fitting:
            least = min(engine.cycles(_LONGEST) for engine in engines)
            raise ValueError(f"a match takes at least {least} cycles, not {cycles}")
        return min(fitting, key=lambda engine: (engine.luts, engine.lanes))

    @property
    def bits(self) -> int:
        """Pairs of bits that are compared per cycle."""
        return self.lanes * self.columns

    @property
    def luts(self) -> float:
        """What the lanes take, very roughly: for choosing between engines only."""
        return self.lanes * (_BIT_LUTS * self.columns + _LANE_LUTS)

    @property
    def positions(self) -> Shape:
        """Rows and columns of positions."""
        rows, columns = (outer - inner + 1 for outer, inner in zip(self.segment, self.template, strict=True))
        return rows, columns

    @property
    def cells(self) -> Shape:
        """Rows and columns of cells."""
        rows, columns = (-(-count // CELL) for count in self.positions)
        return rows, columns

    @property
    def score_bits(self) -> int:
        """Bits of a score."""
        return math.prod(self.template).bit_length()

    @property
    def step(self) -> int:
        """Cycles in which a row of the segment passes the lanes."""
        return self.positions[1] + self.columns - 1

    @property
    def segment_words(self) -> int:
        """Words of 32 bits in which a segment is sent."""
        return -(-math.prod(self.segment) // 32)

    def cycles(self, latency: int) -> int:
        """Cycles of a match, from the last pixel of the template to the result.

        Args:
            latency: cycles that a lane takes to compare.
        """
        bands = -(-self.positions[0] // self.lanes)
        groups = self.template[1] // self.columns
        # One step more: while a row passes, the lanes' next row of the template is fetched.
        steps = 1 + groups * (bands * (self.template[0] - 1) + self.positions[0])
        return steps * self.step + latency + 2 * math.prod(self.cells) + _OVERHEAD

    def small(self) -> Self:
        """An engine of such lanes, but few of them, that matches in few cycles: for a quick simulation."""
        lanes, rows = min(self.lanes, 3), min(self.template[0], 2)
        positions = min(self.positions[0], lanes + 1), min(self.positions[1], 5)
        template = rows, self.template[1]
        segment = positions[0] + rows - 1, positions[1] + template[1] - 1
        return replace(self, template=template, segment=segment, lanes=lanes)

    def answer(self, template: NDArray[np.bool_], segment: NDArray[np.bool_]) -> "EngineAnswer":
        """What the engine answers.

        Args:
            template: bool of the shape `template`.
            segment: bool of the shape `segment`.
        """
        if template.shape != self.template or segment.shape != self.segment:
            raise ValueError(f"an engine of other sizes: {template.shape} in {segment.shape}")
        return self.chosen(agreement(template, segment))

    def chosen(self, scores: NDArray[np.int64]) -> "EngineAnswer":
        """What the engine answers where it finds these scores, int64 ``[rows, columns]`` of `positions`."""
        rows, columns = self.positions
        best = _first_best(scores)
        row, column = (place // CELL * CELL for place in best)
        elsewhere = scores.copy()
        elsewhere[max(row - CELL, 0) : row + 2 * CELL, max(column - CELL, 0) : column + 2 * CELL] = -1
        second = _first_best(elsewhere)
        return EngineAnswer(
            best,
            int(scores[best]),
            second if elsewhere[second] >= 0 else None,
            max(int(elsewhere[second]), 0),
            int(scores.sum()),
            int((scores * scores).sum()),
            rows * columns,
        )

    def answers(self, rounds: "Sequence[Round]") -> list["EngineAnswer"]:
        """What the engine answers in matches that follow each other, of which the first one has a segment."""
        found, segment = list[EngineAnswer](), None
        for match in rounds:
            segment = segment if match.segment is None else match.segment
            assert segment is not None
            found.append(self.answer(match.template, segment))
        return found

    def sample_rounds(self) -> tuple["Round", ...]:
        """Three matches on two segments of random bits: of a piece of the first one, then of other bits."""
        rng = np.random.default_rng(0)
        first, second = (rng.random(self.segment) < 0.4 for _ in range(2))
        (height, width), (rows, columns) = self.template, self.positions
        row, column = int(rng.integers(rows)), int(rng.integers(columns))
        piece = first[row : row + height, column : column + width]
        other = rng.random(self.template) < 0.4
        return Round(first, piece), Round(second, other), Round(None, piece)

    def to_json(self) -> dict[str, Any]:
        """The format as a JSON object."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises KeyError, TypeError or ValueError on anything else."""
        (height, width), (rows, columns) = data["template"], data["segment"]
        return cls((height, width), (rows, columns), data["lanes"], data["columns"])


@dataclass(frozen=True, eq=False)
class Round:
    """A match.

    Attributes:
        segment: bool ``[rows, columns]``, loaded before it; None where the one before is used again.
        template: bool ``[height, width]``.
    """

    segment: NDArray[np.bool_] | None
    template: NDArray[np.bool_]


@dataclass(frozen=True)
class EngineAnswer:
    """What an engine answers for a template and a segment.

    Attributes:
        best: row and column of the best position.
        score: pixels that agree there.
        second: row and column of the best position elsewhere; None if there are no cells elsewhere.
        second_score: pixels that agree there; 0 if there is none.
        total: sum of the scores of all positions.
        squares: sum of their squares.
        positions: how many there are; an engine does not say that.
    """

    best: Shape
    score: int
    second: Shape | None
    second_score: int
    total: int
    squares: int
    positions: int

    @property
    def mean(self) -> float:
        """Mean score of all positions."""
        return self.total / self.positions

    @property
    def std(self) -> float:
        """Standard deviation of the scores of all positions."""
        # In whole numbers: the difference of the two terms may be much smaller than either.
        return math.sqrt(self.squares * self.positions - self.total**2) / self.positions

    @property
    def words(self) -> tuple[int, ...]:
        """The result as words of 32 bits, the first in the lowest bits of the beat.

        Row of the best position in the low half of a word and column in the high half; its score; the same of
        the second one, bit 31 of whose score says that there is none; sum of the scores; sum of their
        squares, both of two words, the low one first.
        """
        sums = [sum_ >> 32 * half & 0xFFFFFFFF for sum_ in (self.total, self.squares) for half in range(2)]
        none = 1 << 31 if self.second is None else 0
        return (
            _place(self.best),
            self.score,
            _place(self.second or (0, 0)),
            self.second_score | none,
            *sums,
        )


def agreement(template: NDArray[np.bool_], segment: NDArray[np.bool_]) -> NDArray[np.int64]:
    """In how many pixels a template agrees with a segment at each position, int64 ``[rows, columns]``.

    Sums by transforms in double precision, rounded to the whole numbers that they are: the error before is
    far below a half for all sizes of segments.
    """
    same = correlate(segment * 2.0 - 1, template * 2.0 - 1, mode="valid", method="fft")
    return np.asarray((template.size + np.rint(same)) // 2, dtype=np.int64)


def picture_words(picture: NDArray[np.bool_]) -> NDArray[np.uint32]:
    """A picture as a segment is sent, uint32 ``[words]``: row after row, the first pixel in bit 0."""
    packed = np.packbits(picture.ravel(), bitorder="little")
    return np.pad(packed, (0, -len(packed) % 4)).view("<u4").astype(np.uint32)


def _first_best(scores: NDArray[np.int64]) -> Shape:
    row, column = np.unravel_index(scores.argmax(), scores.shape)
    return int(row), int(column)


def _place(position: Shape) -> int:
    return position[0] | position[1] << 16


def _check_sizes(template: Shape, segment: Shape) -> None:
    small, large = ("x".join(map(str, shape)) for shape in (template, segment))
    for inner, outer in zip(template, segment, strict=True):
        if inner < 2:
            raise ValueError(f"a template has at least 2x2 pixels, not {small}")
        if outer > MAX_SIDE:
            raise ValueError(f"a segment has at most {MAX_SIDE}x{MAX_SIDE} pixels, not {large}")
        if inner >= outer:
            raise ValueError(f"a template of {small} does not move in a segment of {large}")


def _shapes(template: Shape, segment: Shape) -> Iterator[Shape]:
    """Lanes and columns worth looking at: of as many bands, fewer lanes do."""
    rows = segment[0] - template[0] + 1
    lanes = sorted({-(-rows // bands) for bands in range(1, rows + 1)})
    for columns in range(2, template[1] + 1):
        if template[1] % columns == 0:
            yield from ((count, columns) for count in lanes)
