"""Words of neighbouring pixels side by side: the second half of a window, across a line.

What comes is a word of each pixel, beat by beat: the column of lines that a window sees of it, or anything
that was computed from such a column. What leaves is, for each pixel, its own word and those of its neighbours
on both sides. Beyond the ends of a line the word of its nearest pixel is repeated.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from amaranth.hdl import Module, Mux, Signal, Value

from hdl_templates.scan import Columns


@dataclass(frozen=True)
class Windows:
    """A beat of windows, from registers.

    Attributes:
        valid: whether there is one.
        start: whether it is the first of a frame.
        last: whether it is the last of a line.
        final: whether its line is the last of its frame.
        words: for each pixel, from left to right, the words of its window's columns, from left to right.
        sent: what was given to be delayed by as much.
    """

    valid: Value
    start: Value
    last: Value
    final: Value
    words: list[list[Value]]
    sent: list[Value]


def across(
    m: Module,
    name: str,
    columns: Columns,
    words: Sequence[Value],
    sent: Sequence[Value],
    *,
    reach: int,
    moves: Value,
) -> Windows:
    """Join the words of the pixels of windows.

    A beat waits for as many beats as its windows reach to the right, unless the line ends before. At the end
    of a line beats move on without another one.

    Args:
        m: the module under construction.
        name: what the names of its signals begin with; may be empty.
        columns: the slots that come, one after the other.
        words: of their pixels, from left to right, all of one width.
        sent: what is passed on with a beat; may be nothing.
        reach: words of a window on each side of its middle.
        moves: whether what leaves can be taken; if not, all of it stands still.
    """
    pixels, width = len(words), len(words[0])
    waiting = waits(reach, pixels)

    def register(what: str, bits: int = 1, *, reset_less: bool = True) -> Signal:
        return Signal(bits, name=f"{name}{what}", reset_less=reset_less)

    def beat(where: str) -> _Beat:
        return _Beat(
            register(f"{where}_valid", reset_less=False),
            [register(f"{where}_{pixel}", width) for pixel in range(pixels)],
            register(f"{where}_first"),
            register(f"{where}_last"),
            register(f"{where}_start"),
            register(f"{where}_final"),
            [register(f"{where}_value_{place}", len(value)) for place, value in enumerate(sent)],
        )

    # The newest beat first; the last one of them is the next in the middle.
    queue = [beat("newest"), *(beat(f"waiting_{place}") for place in range(1, waiting))]
    newest, oldest, middle = queue[0], queue[-1], beat("middle")
    # Behind the end of a line nothing that comes could be overtaken.
    shifts = Signal(name=f"{name}shifts")
    m.d.comb += shifts.eq(columns.valid | newest.last)
    with m.If(moves):
        m.d.sync += newest.valid.eq(columns.whole | (newest.valid & ~shifts))
    with m.If(moves & columns.valid):
        newest.loads(
            m, _Beat(columns.whole, words, columns.first, columns.last, columns.start, columns.final, sent)
        )
    # A beat goes on if its line is complete, or continues well.
    complete: Value = newest.last
    for place, (earlier, later) in enumerate(zip(queue, [*queue[1:], middle], strict=True)):
        if place:
            complete = shifts & (complete | earlier.last)
        goes_on = earlier.valid & (complete | columns.whole)
        if later is middle:
            with m.If(moves):
                m.d.sync += later.valid.eq(goes_on)
        with m.If(moves & shifts):
            later.loads(m, earlier)
            if later is not middle:
                m.d.sync += later.valid.eq(goes_on)

    left, right = (
        [register(f"{side}_{distance}", width) for distance in range(1, reach + 1)]
        for side in ("left", "right")
    )
    with m.If(moves & shifts):
        m.d.sync += [
            after.eq(Mux(oldest.first, oldest.words[0], before))
            for after, before in zip(left, [*reversed(middle.words), *left], strict=False)
        ]
    # To the right of a beat those that are newer, as far as the line goes.
    newer = queue[-2::-1]
    for place, after in enumerate(right):
        beats, pixel = divmod(place, pixels)
        word = newer[beats].words[pixel] if beats < len(newer) else words[pixel]
        for nearer in [*reversed(newer[:beats]), oldest]:
            word = Mux(nearer.last, nearer.words[-1], word)
        with m.If(moves & shifts):
            m.d.sync += after.eq(word)

    around = [*reversed(left), *middle.words, *right]
    windows = [around[pixel : pixel + 2 * reach + 1] for pixel in range(pixels)]
    return Windows(middle.valid, middle.start, middle.last, middle.final, windows, list(middle.sent))


def waits(reach: int, pixels: int) -> int:
    """For how many beats of so many pixels a beat waits whose windows reach so far to the right."""
    return -(-reach // pixels)


@dataclass(frozen=True)
class _Beat:
    """A beat that waits, in registers: whether there is one, its pixels' words, and what belongs to it."""

    valid: Value
    words: Sequence[Value]
    first: Value
    last: Value
    start: Value
    final: Value
    sent: Sequence[Value]

    def loads(self, m: Module, before: "_Beat") -> None:
        """Take over all but whether there is a beat."""
        m.d.sync += [
            *(after.eq(word) for after, word in zip(self.words, before.words, strict=True)),
            self.first.eq(before.first),
            self.last.eq(before.last),
            self.start.eq(before.start),
            self.final.eq(before.final),
            *(after.eq(value) for after, value in zip(self.sent, before.sent, strict=True)),
        ]
