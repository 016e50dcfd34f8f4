"""The words of the video streams that go into and come out of a video core."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import permutations
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir.pixel_bits import CHANNEL_BITS, CHANNELS, PIXEL_BITS

Answer = Literal["class", "edge", "both"]
"""What is sent of each pixel: its class, whether it is an edge, or both."""

ANSWER_BITS = 8
"""Bits of an answer: the class in the low ones, the edge in the highest; an edge alone in all of them."""

MONO = "mono"
"""The format of grey pixels, of 8 bits: the model sees them in all three channels."""

FORMATS = (*("".join(order) for order in permutations(CHANNELS)), MONO)
"""What a pixel of a stream can be: channels from the least significant byte, or grey."""

MAX_WIDTH = 4096
"""The longest line that a core can be made for, in pixels."""

WIDTH_BITS = MAX_WIDTH.bit_length()
"""Bits of a number of pixels in a line."""

MAX_HEIGHT = 4096
"""The most lines of a frame."""

HEIGHT_BITS = (MAX_HEIGHT - 1).bit_length()
"""Bits of a number of lines; 0 stands for `MAX_HEIGHT`."""

PIXELS_PER_CLOCK = (1, 2, 4)
"""How many pixels a beat can have."""

MAX_SQUARE = 256
"""The longest side of squares, in pixels."""

MAX_CLOCK = 300.0
"""Megahertz for which the registers around the circuits of a core are made: 4K60 at two pixels takes 297."""

MAX_CLASSES = 1 << ANSWER_BITS - 1
"""Classes that an answer has room for."""


@dataclass(frozen=True)
class VideoFormat:
    """What goes into a video core and what comes out of it.

    Attributes:
        max_width: pixels of the longest line, 2 to `MAX_WIDTH`.
        format: of a pixel, one of `FORMATS`; AXI4-Stream Video (AMD UG934) has ``GBR``.
        answer: what is sent of each pixel.
        pixels_per_clock: pixels of a beat, one of `PIXELS_PER_CLOCK`; the left one is the least significant.
        square: pixels of the side of squares whose majorities are sent as well, at most `MAX_SQUARE` and a
            multiple of the pixels of a beat; None for no squares.
    """

    max_width: int = 1920
    format: str = "GBR"
    answer: Answer = "both"
    pixels_per_clock: int = 1
    square: int | None = None

    def __post_init__(self) -> None:
        if not 2 <= self.max_width <= MAX_WIDTH:
            raise ValueError(f"the longest line has 2 to {MAX_WIDTH} pixels, not {self.max_width}")
        if self.format not in FORMATS:
            raise ValueError(f"a pixel is one of {FORMATS}, not {self.format!r}")
        if self.answer not in get_args(Answer):
            raise ValueError(f"a video core answers one of {get_args(Answer)}, not {self.answer!r}")
        if self.pixels_per_clock not in PIXELS_PER_CLOCK:
            raise ValueError(f"a beat has one of {PIXELS_PER_CLOCK} pixels, not {self.pixels_per_clock}")
        if self.square is not None and (
            not 2 <= self.square <= MAX_SQUARE or self.square % self.pixels_per_clock
        ):
            raise ValueError(f"no squares of {self.square} pixels with {self.pixels_per_clock} in a beat")

    @property
    def has_edges(self) -> bool:
        """Whether edges are sent."""
        return self.answer != "class"

    @property
    def pixel_bits(self) -> int:
        """Bits of a pixel in the stream."""
        return CHANNEL_BITS if self.is_mono else PIXEL_BITS

    @property
    def is_mono(self) -> bool:
        """Whether pixels are grey."""
        return self.format == MONO

    def beats_of(self, pixels: int) -> int:
        """How many beats so many pixels take."""
        return -(-pixels // self.pixels_per_clock)

    def padded(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """A picture, uint8 ``[height, width, ...]``, whose last column is repeated up to whole beats."""
        missing = -picture.shape[1] % self.pixels_per_clock
        return np.concatenate([picture, *[picture[:, -1:]] * missing], axis=1)

    def pixels(self, pictures: NDArray[np.uint8]) -> NDArray[np.uint32]:
        """The words of pixels, uint32 ``S``.

        Args:
            pictures: uint8 ``S + (3,)``, in the order of `CHANNELS`; grey if the pixels are.
        """
        if self.is_mono:
            return pictures[..., 0].astype(np.uint32)
        places = CHANNEL_BITS * np.arange(len(CHANNELS), dtype=np.uint32)
        channels = pictures[..., [CHANNELS.index(channel) for channel in self.format]]
        return np.asarray((channels.astype(np.uint32) << places).sum(axis=-1, dtype=np.uint32))

    def answers(self, classes: NDArray[np.uint8], edges: NDArray[np.bool_] | None) -> NDArray[np.uint8]:
        """The words of answers, uint8 ``S``.

        Args:
            classes: class indices below `MAX_CLASSES`, uint8 ``S``.
            edges: bool ``S``; None if they are not sent.
        """
        if edges is None:
            return classes
        if self.answer == "edge":
            return np.where(edges, np.uint8(255), np.uint8(0))
        return classes | edges.astype(np.uint8) << np.uint8(ANSWER_BITS - 1)

    def to_json(self) -> dict[str, Any]:
        """The format as a JSON object."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises TypeError or ValueError on anything else."""
        return cls(**data)


@dataclass(frozen=True, eq=False)
class Beats:
    """What goes into a video core and what has to come out, frame after frame, beat by beat.

    Attributes:
        pixels: the words of the pixels that go in, uint32 ``[beats, pixels per clock]``.
        answers: the words that come out, uint8 of the same shape.
        starts: which are the first of a frame, bool ``[beats]``.
        ends: which are the last of a line, bool ``[beats]``.
        height: lines of the highest frame.
        squares: the majorities that have to come out beside them, uint8 ``[rows, columns]`` for each frame;
            empty of a core without squares.
    """

    pixels: NDArray[np.uint32]
    answers: NDArray[np.uint8]
    starts: NDArray[np.bool_]
    ends: NDArray[np.bool_]
    height: int
    squares: tuple[NDArray[np.uint8], ...] = ()

    def __len__(self) -> int:
        return len(self.pixels)

    @property
    def lines(self) -> list[int]:
        """Lines of each frame."""
        places = np.flatnonzero(self.starts)
        return [int(ends.sum()) for ends in np.split(self.ends, places[1:])]

    @property
    def width(self) -> int:
        """Pixels of the first line of the last frame."""
        first = int(np.flatnonzero(self.starts)[-1])
        return (int(self.ends[first:].argmax()) + 1) * int(self.pixels.shape[1])

    def sent(self, pixel_bits: int) -> list[int]:
        """TDATA of each beat that goes in, whose pixels have so many bits."""
        return _joined(self.pixels, pixel_bits)

    def expected(self) -> list[int]:
        """TDATA of each beat that comes out."""
        return _joined(self.answers, ANSWER_BITS)

    def voted(self) -> list[tuple[int, bool, bool]]:
        """Of each beat of squares the class, whether it is the first of a frame and the last of a row."""
        return [
            (int(majority), row == column == 0, column == squares.shape[1] - 1)
            for squares in self.squares
            for (row, column), majority in np.ndenumerate(squares)
        ]

    @classmethod
    def of(
        cls,
        pixels: Sequence[NDArray[np.uint32]],
        answers: Sequence[NDArray[np.uint8]],
        pixels_per_clock: int = 1,
        squares: Sequence[NDArray[np.uint8]] = (),
    ) -> Self:
        """The beats of frames of whole beats, whose words are ``[height, width]`` each, and of squares."""
        starts, ends = [], []
        for frame in pixels:
            start, end = np.zeros((2, len(frame), frame.shape[1] // pixels_per_clock), dtype=np.bool_)
            start[0, 0] = True
            end[:, -1] = True
            starts.append(start.ravel())
            ends.append(end.ravel())
        return cls(
            np.concatenate([frame.reshape(-1, pixels_per_clock) for frame in pixels]),
            np.concatenate([frame.reshape(-1, pixels_per_clock) for frame in answers]),
            np.concatenate(starts),
            np.concatenate(ends),
            max(len(frame) for frame in pixels),
            tuple(squares),
        )


def _joined(words: NDArray[np.uint32] | NDArray[np.uint8], bits: int) -> list[int]:
    """The words of each row side by side, the first the least significant."""
    return [sum(word << place * bits for place, word in enumerate(row)) for row in words.tolist()]
