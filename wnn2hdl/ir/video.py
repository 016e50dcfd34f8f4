"""The words of the video streams that go into and come out of a video core."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import permutations
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir.pixel_bits import CHANNEL_BITS, CHANNELS

Answer = Literal["class", "edge", "both"]
"""What is sent of each pixel: its class, whether it is an edge, or both."""

ANSWER_BITS = 8
"""Bits of an answer: the class in the low ones, the edge in the highest; an edge alone in all of them."""

ORDERS = tuple("".join(order) for order in permutations(CHANNELS))
"""The orders that the channels of a pixel can have."""

MAX_WIDTH = 4096
"""The longest line that a core can be made for, in pixels."""

MAX_HEIGHT = 4096
"""The most lines of a frame."""

MAX_CLASSES = 1 << ANSWER_BITS - 1
"""Classes that an answer has room for."""


@dataclass(frozen=True)
class VideoFormat:
    """What goes into a video core and what comes out of it.

    Attributes:
        max_width: pixels of the longest line, 2 to `MAX_WIDTH`.
        channels: of a pixel, from the least significant byte; AXI4-Stream Video (AMD UG934) has ``GBR``.
        answer: what is sent of each pixel.
    """

    max_width: int = 1920
    channels: str = "GBR"
    answer: Answer = "both"

    def __post_init__(self) -> None:
        if not 2 <= self.max_width <= MAX_WIDTH:
            raise ValueError(f"the longest line has 2 to {MAX_WIDTH} pixels, not {self.max_width}")
        if self.channels not in ORDERS:
            raise ValueError(f"a pixel has the channels {''.join(CHANNELS)}, not {self.channels}")
        if self.answer not in get_args(Answer):
            raise ValueError(f"a video core answers one of {get_args(Answer)}, not {self.answer!r}")

    @property
    def has_edges(self) -> bool:
        """Whether edges are sent."""
        return self.answer != "class"

    def pixels(self, pictures: NDArray[np.uint8]) -> NDArray[np.uint32]:
        """The words of pixels, uint32 ``S``; the pixels are uint8 ``S + (3,)`` in the order of `CHANNELS`."""
        places = CHANNEL_BITS * np.arange(len(CHANNELS), dtype=np.uint32)
        channels = pictures[..., [CHANNELS.index(channel) for channel in self.channels]]
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
    """What goes into a video core and what has to come out, frame after frame, pixel by pixel.

    Attributes:
        pixels: the words that go in, uint32 ``[beats]``.
        answers: the words that come out, uint8 ``[beats]``.
        starts: which are the first of a frame, bool ``[beats]``.
        ends: which are the last of a line, bool ``[beats]``.
        height: lines of the highest frame.
    """

    pixels: NDArray[np.uint32]
    answers: NDArray[np.uint8]
    starts: NDArray[np.bool_]
    ends: NDArray[np.bool_]
    height: int

    def __len__(self) -> int:
        return len(self.pixels)

    @classmethod
    def of(cls, pixels: Sequence[NDArray[np.uint32]], answers: Sequence[NDArray[np.uint8]]) -> Self:
        """The beats of frames, whose words are ``[height, width]`` each."""
        starts, ends = [], []
        for frame in pixels:
            start, end = np.zeros((2, *frame.shape), dtype=np.bool_)
            start[0, 0] = True
            end[:, -1] = True
            starts.append(start)
            ends.append(end)
        return cls(
            np.concatenate([frame.ravel() for frame in pixels]),
            np.concatenate([frame.ravel() for frame in answers]),
            np.concatenate([frame.ravel() for frame in starts]),
            np.concatenate([frame.ravel() for frame in ends]),
            max(len(frame) for frame in pixels),
        )
