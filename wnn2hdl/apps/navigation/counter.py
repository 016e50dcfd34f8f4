"""The order of flight, and its clock: the numbers that cameras and video tools give to frames' names."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import pairwise

from wnn2hdl.errors import InputError

_ROLLED_SHARE = 0.25
"""A counter that rolled over in flight has taken at most this share of its numbers since its first frame."""


def in_order(names: Sequence[str]) -> list[int]:
    """The order of flight.

    The order is the names' own where all are numbered alike: 7 before 12, and 9999 before 0001 where the
    lines say that the counter rolled over in between. Where names give no order, it is that of the lines.

    Args:
        names: of the frames' files, in the order of the lines.

    Returns:
        indices of the names.

    Raises:
        InputError: the lines have another order than the numbers, or a counter has probably rolled over and
            the lines do not show where.
    """
    numbered = _numbers(names)
    if numbered is None or _unrolled(*numbered) is not None:
        rolled = numbered and _gap_of_rollover(*numbered)
        if rolled:
            before, after = (names[index] for index in rolled)
            raise InputError(
                "the camera's counter seems to have rolled over",
                value=f"{after} may be from before {before}",
                hint="put the lines in the order of flight, the highest numbers first",
            )
        return list(range(len(names)))
    numbers, _ = numbered
    # Programs that sort names as texts put 10 before 9: such an order says nothing.
    if list(names) == sorted(names):
        return sorted(range(len(names)), key=numbers.__getitem__)
    one, other = next((i, i + 1) for i, (low, high) in enumerate(pairwise(numbers)) if high < low)
    raise InputError(
        "the lines have another order than the numbers of their frames",
        value=f"{names[one]} before {names[other]}",
        hint="sort the lines by name, or number the frames in the order of flight",
    )


def frame_times(names: Sequence[str]) -> list[int] | None:
    """When frames were taken by their names: ``IMG_0447.jpg``, or ``20240229_235959.jpg`` in seconds.

    Args:
        names: in the order of flight.

    Returns:
        a number for each, rising, also where the counter rolled over; None unless all names have different
        numbers after the same text, and they rise.
    """
    numbered = _numbers(names)
    return _unrolled(*numbered) if numbered else None


def time_among(names: Sequence[str], name: str) -> tuple[list[int], int] | None:
    """The times of frames in the order of flight, and that of another frame by the same clock.

    Returns:
        as `frame_times`; None if the names give no times. After a rollover, the time nearest to the others.
    """
    times = frame_times(names)
    numbered = _numbers([*names, name]) if name not in names else None
    if times is None or numbered is None:
        return None
    numbers, period = numbered
    turns = (numbers[-1] + turn * period for turn in (0, 1, -1)) if period else iter(numbers[-1:])
    return times, min(turns, key=lambda at: max(times[0] - at, at - times[-1], 0))


def _numbers(names: Sequence[str]) -> tuple[list[int], int] | None:
    """The number of each name, and after how many a counter starts again: 0 for never."""
    found = [re.fullmatch(r"(.*?)([0-9]+)(\.[^.]*)?", name) for name in names]
    parts = [(match[1], match[2]) for match in found if match is not None]
    if len(parts) < len(names):
        return None
    seconds = [_seconds(before + digits) for before, digits in parts]
    if all(second is not None for second in seconds):
        numbers, period = [second for second in seconds if second is not None], 0
    else:
        if len({before for before, _ in parts}) > 1:
            return None
        numbers = [int(digits) for _, digits in parts]
        lengths = {len(digits) for _, digits in parts}
        period = 10 ** lengths.pop() if len(lengths) == 1 else 0
    return (numbers, period) if len({*numbers}) == len(numbers) else None


def _seconds(text: str) -> int | None:
    """A date and a time of day at the end of a name, as seconds."""
    match = re.search(r"(?<![0-9])([0-9]{8})[-_T]?([0-9]{6})$", text)
    if match is None:
        return None
    try:
        return int(datetime.strptime(match[1] + match[2], "%Y%m%d%H%M%S").replace(tzinfo=UTC).timestamp())
    except ValueError:
        return None


def _unrolled(numbers: Sequence[int], period: int) -> list[int] | None:
    """Numbers in the order of the lines, rising; None if they fall, other than by one rollover."""
    falls = [i for i, (low, high) in enumerate(pairwise(numbers), start=1) if high < low]
    if not falls:
        return list(numbers)
    unrolled = [*numbers[: falls[0]], *(number + period for number in numbers[falls[0] :])]
    rolled = len(falls) == 1 and unrolled[-1] - unrolled[0] <= _ROLLED_SHARE * period
    return unrolled if rolled else None


def _gap_of_rollover(numbers: Sequence[int], period: int) -> tuple[int, int] | None:
    """Indices beside a gap of most of the counter's numbers, in numbers that rise."""
    if not period or len(numbers) < 2 or numbers[-1] < numbers[0]:
        return None
    widest = max(range(len(numbers) - 1), key=lambda i: numbers[i + 1] - numbers[i])
    gap = numbers[widest + 1] - numbers[widest]
    return (widest, widest + 1) if gap >= (1 - _ROLLED_SHARE) * period else None
