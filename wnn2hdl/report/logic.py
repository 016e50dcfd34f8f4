"""What a LUT computes, for a person to read: contents, expression, and a table of at most eight by eight."""

from collections.abc import Sequence
from dataclasses import dataclass

from wnn2hdl.ir import Lut

Literals = tuple[tuple[int, bool], ...]
"""A product term: pairs (input, value it must have)."""


@dataclass(frozen=True)
class Grid:
    """A truth table folded into two dimensions.

    Attributes:
        across: inputs that the columns count through, the least significant last, as numbers are written.
        down: inputs that the rows count through, likewise; empty for a table of one row.
        columns: their values at each column, as in ``010``.
        rows: (values of `down`, output at each column) of each row.
    """

    across: tuple[str, ...]
    down: tuple[str, ...]
    columns: tuple[str, ...]
    rows: tuple[tuple[str, tuple[int, ...]], ...]


def contents(lut: Lut) -> str:
    """The INIT value as Verilog writes it: ``64'h8000000000000000``."""
    size = 1 << len(lut.inputs)
    return f"{size}'h{lut.init:0{max(1, size // 4)}x}"


def grid(lut: Lut) -> Grid:
    """The truth table with the lower half of the inputs across and the rest down."""
    width = (len(lut.inputs) + 1) // 2
    height = len(lut.inputs) - width
    rows = tuple(
        (
            f"{row:0{height}b}" if height else "",
            tuple(lut.init >> (row << width | column) & 1 for column in range(1 << width)),
        )
        for row in range(1 << height)
    )
    return Grid(
        lut.inputs[:width][::-1],
        lut.inputs[width:][::-1],
        tuple(f"{column:0{width}b}" for column in range(1 << width)),
        rows,
    )


def expression(lut: Lut) -> str:
    """The function in Verilog's operators: the shortest of a sum of products, one inverted, and an XOR."""
    size = 1 << len(lut.inputs)
    full = (1 << size) - 1
    if lut.init in (0, full):
        return "1" if lut.init else "0"
    candidates = [_sum(lut.init, lut.inputs)]
    inverted = _sum(lut.init ^ full, lut.inputs)
    candidates.append(f"~({inverted})" if " " in inverted else f"~{inverted}")
    parity = _parity(lut)
    if parity:
        candidates.append(parity)
    return min(candidates, key=len)


def _sum(init: int, names: Sequence[str]) -> str:
    terms, _ = _irredundant(init, init, len(names))
    texts = [
        " & ".join(names[position] if value else f"~{names[position]}" for position, value in sorted(term))
        for term in terms
    ]
    alone = len(texts) == 1
    return " | ".join(f"({text})" if " " in text and not alone else text for text in texts)


def _irredundant(lower: int, upper: int, inputs: int) -> tuple[list[Literals], int]:
    """Product terms that cover `lower` within `upper`, none of them to spare, and what they cover.

    S. Minato, "Fast generation of irredundant sum-of-products forms from binary decision diagrams", SASIMI
    1992; here on truth tables as integers.
    """
    if lower == 0:
        return [], 0
    if upper == (1 << (1 << inputs)) - 1:
        return [()], upper
    half = 1 << (inputs - 1)
    mask, top = (1 << half) - 1, inputs - 1
    (low0, low1), (up0, up1) = ((x & mask, x >> half) for x in (lower, upper))
    terms0, done0 = _irredundant(low0 & ~up1, up0, top)
    terms1, done1 = _irredundant(low1 & ~up0, up1, top)
    both, done = _irredundant(low0 & ~done0 | low1 & ~done1, up0 & up1, top)
    terms = [(*term, (top, False)) for term in terms0] + [(*term, (top, True)) for term in terms1] + both
    return terms, (done1 | done) << half | done0 | done


def _parity(lut: Lut) -> str | None:
    """The function as an XOR of inputs, perhaps inverted; None if it is none."""
    first = lut.init & 1
    read = [i for i in range(len(lut.inputs)) if (lut.init >> (1 << i) & 1) != first]
    mask = sum(1 << i for i in read)
    if any(
        (lut.init >> address & 1) != first ^ ((address & mask).bit_count() & 1)
        for address in range(1 << len(lut.inputs))
    ):
        return None
    text = " ^ ".join(lut.inputs[i] for i in read)
    if not first:
        return text
    return f"~({text})" if len(read) > 1 else f"~{text}"
