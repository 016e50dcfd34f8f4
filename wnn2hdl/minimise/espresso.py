"""Two-level minimisation with PyEDA's espresso, and irredundant covers for tables too wide for it."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Self

import numpy as np
from pyeda.boolalg.espresso import DTYPE, FTYPE, RTYPE, get_config, set_config
from pyeda.boolalg.espresso import espresso as _espresso

from wnn2hdl.ir import Cover, Cube, TruthTable, codes_to_bits, irredundant_cover, pack_contents
from wnn2hdl.minimise.check import require_equal

# The library keeps these in a global, for all who call it. Its improvement loop gives equal
# calls different covers (measured: 4 of 15 random tables of 8 inputs), so only the first pass is used: it is
# repeatable, found the same covers on trained tables and 2 to 6 per cent more literals on random ones.
_CONFIG = {
    "single_expand": True,
    "remove_essential": True,
    "force_irredundant": True,
    "unwrap_onset": True,
    "recompute_onset": False,
    "use_super_gasp": False,
    "skip_make_sparse": False,
}
_ONE_AT_A_TIME = threading.Lock()

# Codes handed to espresso, one cube each. Measured on exact threshold functions: 1.6 s for 2**13 ON codes of
# 14 inputs, 22 to 101 s for 2**15 of 16, where the irredundant cover took 0.1 s for the same 943 cubes.
MAX_CODES = 1 << 14


@dataclass(frozen=True)
class Minimised:
    """A minimised cover with the size it started from.

    Attributes:
        cover: equal to the table on every cared-for code.
        method: "espresso", or "irredundant" for a table beyond `MAX_CODES`.
        cubes_before: cared-for codes with some output on; each is one cube at first.
        literals_before: the literals of those cubes, one for each input.
    """

    cover: Cover
    method: str
    cubes_before: int
    literals_before: int

    @classmethod
    def of(cls, table: TruthTable, cover: Cover, method: str) -> Self:
        """A cover of a table."""
        codes = int((table.care & table.values.any(axis=1)).sum())
        return cls(cover, method, codes, codes * len(table.inputs))


def espresso(table: TruthTable) -> Minimised:
    """Minimise the ON sets against the don't-cares; with espresso outputs share cubes.

    Raises:
        CheckError: the cover differs from the table on a cared-for code.
    """
    on_codes = np.flatnonzero(table.care & table.values.any(axis=1))
    # Cubes that describe the table as ON and OFF codes, or as ON codes and don't-cares.
    cared = int(table.care.sum())
    rows = {RTYPE: cared, DTYPE: len(on_codes) + len(table.care) - cared}
    other = RTYPE if rows[RTYPE] <= rows[DTYPE] else DTYPE
    small = rows[other] <= MAX_CODES and bool(table.inputs)
    cubes = _espresso_cubes(table, other) if small else _irredundant_cubes(table)
    cover = Cover(table.inputs, table.outputs, tuple(cubes))
    method = "espresso" if small else "irredundant"
    require_equal(table, cover, f"the {method} cover")
    return Minimised.of(table, cover, method)


def _espresso_cubes(table: TruthTable, other: int) -> list[Cube]:
    """Espresso's cover, in a fixed order; it returns a set. ``other``: what is listed beside ON codes."""
    rows = np.where(table.care, table.values.any(axis=1) | (other == RTYPE), other == DTYPE)
    codes = np.flatnonzero(rows)
    # Cubes of the library: input literals (1 false, 2 true, 3 either), then outputs (0, 1, 2 free).
    literals = (codes_to_bits(codes, len(table.inputs)) + np.uint8(1)).tolist()
    outputs = np.where(table.care[:, np.newaxis], table.values, 2)[codes].tolist()
    given = [(tuple(x), tuple(y)) for x, y in zip(literals, outputs, strict=True)]
    with _configured():
        found = _espresso(len(table.inputs), len(table.outputs), given, intype=FTYPE | other)
    cubes = [
        Cube(
            mask=sum(1 << x for x, literal in enumerate(inputs) if literal != 3),
            value=sum(1 << x for x, literal in enumerate(inputs) if literal == 2),
            outputs=sum(1 << x for x, flag in enumerate(flags) if flag == 1),
        )
        for inputs, flags in found
    ]
    return sorted(cubes, key=lambda cube: (cube.outputs, cube.mask, cube.value))


@contextmanager
def _configured() -> Iterator[None]:
    """The library with `_CONFIG`, for one thread at a time; its other users find it as they left it."""
    with _ONE_AT_A_TIME:
        before = get_config()
        set_config(**_CONFIG)
        try:
            yield
        finally:
            set_config(**before)


def _irredundant_cubes(table: TruthTable) -> list[Cube]:
    """An irredundant sum of products for each output."""
    cubes = []
    for position, column in enumerate(table.values.T):
        lower, upper = pack_contents(column & table.care), pack_contents(column | ~table.care)
        terms = irredundant_cover(lower, upper, len(table.inputs))
        cubes += [Cube(mask, value, 1 << position) for mask, value in terms]
    return cubes
