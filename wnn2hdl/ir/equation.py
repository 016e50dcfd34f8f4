"""A look-up table as an equation: the shortest of a sum, its complement and an XOR, for Verilog and pages."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from wnn2hdl.ir.cover import Term, irredundant_cover

Kind = Literal["sum", "product", "parity"]


@dataclass(frozen=True)
class Equation:
    """One output as an equation over the inputs of a table.

    Attributes:
        kind: ``sum`` is the OR of ANDs; ``product`` is the complement of such a sum, an AND of ORs;
            ``parity`` is the XOR of the inputs in ``terms[0]``'s mask, complemented if its value is not 0.
        terms: product terms of the sum; the constant 0 is a sum of no terms, 1 of one term without literals.
    """

    kind: Kind
    terms: tuple[Term, ...]

    @property
    def literals(self) -> int:
        """How many literals the equation has."""
        return sum(mask.bit_count() for mask, _ in self.terms)

    def text(self, names: Sequence[str]) -> str:
        """The equation with the operators ``~ & ^ |``, which bind in this order in Verilog and in Python.

        Args:
            names: one for each input of the table.

        Returns:
            No more parentheses than the operators' order asks for; a constant is ``0`` or ``1``.
        """
        if self.kind == "parity":
            mask, complement = self.terms[0]
            parity = " ^ ".join(name for position, name in enumerate(names) if mask >> position & 1)
            return f"~({parity})" if complement else parity
        if not any(mask for mask, _ in self.terms):
            return "1" if self.terms else "0"
        if self.kind == "sum":
            return " | ".join(" & ".join(_literals(term, names, inverted=False)) for term in self.terms)
        clauses = [_literals(term, names, inverted=True) for term in self.terms]
        if len(clauses) == 1:
            return " | ".join(clauses[0])
        return " & ".join(f"({' | '.join(clause)})" if len(clause) > 1 else clause[0] for clause in clauses)


def equation(contents: int, width: int) -> Equation:
    """The shortest of three writings of a look-up table.

    Args:
        contents: bit ``a`` is the output at address ``a``; below ``2**(2**width)``.
        width: inputs; a LUT has at most six.

    Returns:
        A parity where the function is one of two or more inputs, else the sum or the product with fewer
        literals; the sum on a tie.
    """
    parity = _parity(contents, width)
    if parity is not None:
        return parity
    complement = contents ^ ((1 << (1 << width)) - 1)
    positive = Equation("sum", _sorted_cover(contents, width))
    negative = Equation("product", _sorted_cover(complement, width))
    return negative if 0 < negative.literals < positive.literals else positive


def _sorted_cover(contents: int, width: int) -> tuple[Term, ...]:
    """An irredundant cover, terms of the first inputs first."""
    return tuple(sorted(irredundant_cover(contents, contents, width)))


def _parity(contents: int, width: int) -> Equation | None:
    """The table as an XOR of two inputs or more; None if it is something else."""
    first = contents & 1
    mask = sum(1 << i for i in range(width) if (contents >> (1 << i) & 1) != first)
    table = first
    for i in range(width):
        size = 1 << i
        half = table ^ ((1 << size) - 1) if mask >> i & 1 else table
        table |= half << size
    return Equation("parity", ((mask, first),)) if table == contents and mask.bit_count() > 1 else None


def _literals(term: Term, names: Sequence[str], *, inverted: bool) -> list[str]:
    mask, value = term
    return [
        name if bool(value >> position & 1) != inverted else f"~{name}"
        for position, name in enumerate(names)
        if mask >> position & 1
    ]
