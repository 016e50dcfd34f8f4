"""Exclusive ors of bits: a mask of bits stands for the exclusive or of those that are set in it."""

from collections.abc import Iterable, Sequence

_MAX_ENUMERATED = 12
"""Rank up to which all sums are looked at for those of few bits: 4096 of them."""


def basis(masks: Iterable[int]) -> tuple[int, ...]:
    """Masks of few bits whose exclusive ors are those of the given masks, and no more of them than needed.

    Up to a rank of `_MAX_ENUMERATED` no other basis has a mask of fewer bits in place of one of its own.

    Args:
        masks: not negative, of any width.

    Returns:
        Masks by their number of bits, then by their value; the same for all masks with the same exclusive
        ors, up to that rank.
    """
    rows = _independent(masks)
    if len(rows) > _MAX_ENUMERATED:
        return tuple(sorted(rows, key=_size))
    sums = [0]
    for row in rows:
        sums += [found ^ row for found in sums]
    # Taking the smallest one that is independent of those before is best (a matroid's greedy choice).
    return tuple(_independent(sorted(sums, key=_size)))


def combination(mask: int, of: Sequence[int]) -> int:
    """Which masks of a basis have this exclusive or: bit ``i`` of the answer stands for ``of[i]``.

    Raises:
        ValueError: the mask is no exclusive or of them.
    """
    rest, taken = _reduced(mask, _echelon(of))
    if rest:
        raise ValueError(f"mask {mask:#x} is no exclusive or of the masks given")
    return taken


def _size(mask: int) -> tuple[int, int]:
    return mask.bit_count(), mask


def _independent(masks: Iterable[int]) -> list[int]:
    """The masks that are no exclusive or of those before."""
    kept: list[int] = []
    pivots: dict[int, tuple[int, int]] = {}
    for mask in masks:
        rest, _ = _reduced(mask, pivots)
        if rest:
            pivots[rest.bit_length()] = rest, 0
            kept.append(mask)
    return kept


def _echelon(masks: Sequence[int]) -> dict[int, tuple[int, int]]:
    """By the place of its highest bit an exclusive or of the masks, and of which ones it is."""
    pivots: dict[int, tuple[int, int]] = {}
    for place, mask in enumerate(masks):
        rest, taken = _reduced(mask, pivots)
        if rest:
            pivots[rest.bit_length()] = rest, taken ^ 1 << place
    return pivots


def _reduced(mask: int, pivots: dict[int, tuple[int, int]]) -> tuple[int, int]:
    """What is left of a mask, and of which masks what was taken from it is the exclusive or."""
    taken = 0
    while mask and (pivot := pivots.get(mask.bit_length())):
        mask ^= pivot[0]
        taken ^= pivot[1]
    return mask, taken
