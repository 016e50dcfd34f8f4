"""Two-level covers: cubes, sums of products, and the one algorithm that finds an irredundant one."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Term = tuple[int, int]
"""A product term ``(mask, value)``: true for the codes with ``code & mask == value``."""


@dataclass(frozen=True)
class Cube:
    """A product term: true for the codes with ``code & mask == value``.

    Attributes:
        mask: bit ``i`` is set if input ``i`` is a literal of the term.
        value: the literals' required values, a subset of ``mask``.
        outputs: bit ``j`` is set if the term feeds output ``j``.
    """

    mask: int
    value: int
    outputs: int

    @property
    def literals(self) -> int:
        """How many inputs the term reads."""
        return self.mask.bit_count()


@dataclass(frozen=True)
class Cover:
    """A sum of products: each output is the OR of the cubes that feed it."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    cubes: tuple[Cube, ...]

    @property
    def literals(self) -> int:
        """Literals of all cubes together."""
        return sum(cube.literals for cube in self.cubes)

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Outputs for codes of shape ``S``: bool ``S + (len(outputs),)``."""
        flat = np.asarray(codes, dtype=np.int64)
        result = np.zeros((*flat.shape, len(self.outputs)), dtype=np.bool_)
        for cube in self.cubes:
            hit = (flat & cube.mask) == cube.value
            for position in range(len(self.outputs)):
                if cube.outputs >> position & 1:
                    result[..., position] |= hit
        return result


def irredundant_cover(lower: int, upper: int, width: int) -> tuple[Term, ...]:
    """An irredundant sum of products between two bounds, in time that grows with its terms.

    S. Minato, "Fast generation of irredundant sum-of-products forms from binary decision diagrams", SASIMI
    1992, here on truth tables as integers (see `wnn2hdl.ir.pack_contents`): six inputs are one machine word,
    and at twenty inputs the integers' bitwise operations still take most of the time.

    Args:
        lower: the codes that must be covered; bit ``c`` belongs to code ``c``.
        upper: the codes that may be covered, a superset of ``lower``.
        width: inputs.

    Returns:
        Terms of which none can be left out; none at all if ``lower`` is 0.
    """
    return _cover(lower, upper, width)[0]


def _cover(lower: int, upper: int, width: int) -> tuple[tuple[Term, ...], int]:
    """The terms, and the table they compute."""
    if lower == 0:
        return (), 0
    if upper == (1 << (1 << width)) - 1:
        return ((0, 0),), upper
    half, literal = 1 << (width - 1), 1 << (width - 1)
    low = (1 << half) - 1
    lower0, lower1, upper0, upper1 = lower & low, lower >> half, upper & low, upper >> half
    terms0, table0 = _cover(lower0 & ~upper1, upper0, width - 1)
    terms1, table1 = _cover(lower1 & ~upper0, upper1, width - 1)
    rest = lower0 & ~table0 | lower1 & ~table1
    shared, table = _cover(rest, upper0 & upper1, width - 1)
    terms = (
        *((mask | literal, value) for mask, value in terms0),
        *((mask | literal, value | literal) for mask, value in terms1),
        *shared,
    )
    return terms, (table0 | table) | (table1 | table) << half
