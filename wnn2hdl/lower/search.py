"""Binary search for the thresholds that a number lies between: which constants it is compared with.

A constant is a threshold, or a round number between two thresholds: the last levels of a search have to tell
thresholds apart exactly, the first ones need not, and a round number has fewer bits to compare.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Shape:
    """A search: for each of its levels, what each code of the answers before it stands for.

    Attributes:
        intervals: per level and code, where the word lies: from the first number to below the second.
        constants: per level and code, what the word is compared with; None where it does not matter.
        leaves: the intervals after the last level.
    """

    intervals: tuple[tuple[tuple[int, int], ...], ...]
    constants: tuple[tuple[int | None, ...], ...]
    leaves: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Cut:
    """A constant that parts the thresholds of an interval.

    Attributes:
        constant: the constant.
        zeros: trailing zeros of it.
        imbalance: difference of the numbers of thresholds below and above it.
        below: the thresholds below it.
        above: the thresholds above it.
    """

    constant: int
    zeros: int
    imbalance: int
    below: tuple[int, ...]
    above: tuple[int, ...]


def shape(width: int, levels: tuple[int, ...], depth: int, round_levels: int) -> Shape | None:
    """A search with the fewest thresholds on the longer side of each constant.

    Args:
        width: bits of the word.
        levels: the thresholds, ascending.
        depth: levels of the search.
        round_levels: for how many levels, from the first one on, the constants are as round as can be.

    Returns:
        The shape; None if ``depth`` levels are too few, or more than there are thresholds for.
    """
    nodes: list[tuple[int, int, tuple[int, ...]]] = [(0, 1 << width, levels)]
    intervals, constants = [], []
    for level in range(depth):
        room = (1 << (depth - level - 1)) - 1
        choices = [_cuts(low, high, inside, room) for low, high, inside in nodes]
        if not any(choices) or any(
            inside and not found for (_, _, inside), found in zip(nodes, choices, strict=True)
        ):
            return None
        zeros = 0
        if level < round_levels:
            zeros = min((max(cut.zeros for cut in found) for found in choices if found), default=0)
        intervals.append(tuple((low, high) for low, high, _ in nodes))
        chosen = [
            min((x for x in found if x.zeros >= zeros), key=lambda x: (x.imbalance, -x.zeros), default=None)
            for found in choices
        ]
        constants.append(tuple(cut.constant if cut else None for cut in chosen))
        both = list(zip(nodes, chosen, strict=True))
        nodes = [
            (low, cut.constant, cut.below) if cut else (low, high, ()) for (low, high, _), cut in both
        ] + [(cut.constant, high, cut.above) if cut else (low, high, ()) for (low, high, _), cut in both]
    return Shape(tuple(intervals), tuple(constants), tuple((low, high) for low, high, _ in nodes))


def _cuts(low: int, high: int, inside: tuple[int, ...], room: int) -> list[Cut]:
    """Ways to part the thresholds inside an interval so that at most ``room`` are on either side."""
    found = []
    for below in range(len(inside) + 1):
        if below > room:
            break
        start = inside[below - 1] if below else low
        end = inside[below] if below < len(inside) else high
        if below < len(inside) and len(inside) - below - 1 <= room:
            zeros = (end & -end).bit_length() - 1
            rest = inside[below + 1 :]
            found.append(Cut(end, zeros, abs(below - len(rest)), inside[:below], rest))
        if 0 < below < len(inside) and len(inside) - below <= room and end - start > 1:
            # The roundest number between the two thresholds.
            zeros = next(z for z in reversed(range(high.bit_length())) if ((start >> z) + 1) << z < end)
            rest = inside[below:]
            constant = ((start >> zeros) + 1) << zeros
            found.append(Cut(constant, zeros, abs(below - len(rest)), inside[:below], rest))
    return found
