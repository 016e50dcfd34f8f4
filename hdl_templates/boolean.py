"""Small Boolean functions as equations: irredundant sums of products, and their Amaranth expressions."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

from amaranth.hdl import Const, Value

Term = tuple[int, int]
"""A product term ``(mask, value)``: true for the codes with ``code & mask == value``."""


@dataclass(frozen=True)
class Equation:
    """One output as an equation over the bits of a code.

    Attributes:
        kind: ``sum`` is the OR of ANDs; ``product`` is the complement of such a sum, an AND of ORs;
            ``parity`` is the XOR of the inputs in ``terms[0]``'s mask, complemented if its value is not 0.
        terms: product terms of the sum.
    """

    kind: str
    terms: tuple[Term, ...]

    @property
    def literals(self) -> int:
        """How many literals the equation has."""
        return sum(mask.bit_count() for mask, _ in self.terms)

    def expression(self, bits: Sequence[Value]) -> Value:
        """The equation over ``bits``, each one bit wide, in the order of the code."""
        if self.kind == "parity":
            mask, complement = self.terms[0]
            parity = _tree([bits[i] for i in _ones(mask)], lambda a, b: a ^ b)
            return ~parity if complement else parity
        if self.kind == "product":
            clauses = [
                _tree([_literal(bits, i, not value >> i & 1) for i in _ones(mask)], lambda a, b: a | b)
                for mask, value in self.terms
            ]
            return _tree(clauses, lambda a, b: a & b) if clauses else Const(1, 1)
        return sum_of_products(self.terms, bits)


def sum_of_products(terms: Sequence[Term], bits: Sequence[Value]) -> Value:
    """The OR of product terms over ``bits``, one bit wide; no term is 0, a term without literals is 1."""
    if any(mask == 0 for mask, _ in terms):
        return Const(1, 1)
    products = [
        _tree([_literal(bits, i, bool(value >> i & 1)) for i in _ones(mask)], lambda a, b: a & b)
        for mask, value in terms
    ]
    return any_of(products)


def any_of(values: Sequence[Value]) -> Value:
    """The OR of one-bit values; 0 of none."""
    return _tree(values, lambda a, b: a | b) if values else Const(0, 1)


@cache
def equation(contents: int, width: int) -> Equation:
    """The shortest of three writings of a look-up table.

    Args:
        contents: bit ``a`` is the output at address ``a``; below ``2**(2**width)``.
        width: inputs, at most 6 in practice; the work grows with ``2**width``.

    Returns:
        A parity where the function is one of two or more inputs, else the sum or the product with fewer
        literals; the sum on a tie.
    """
    full = (1 << (1 << width)) - 1
    for mask in range(1, 1 << width):
        if mask.bit_count() > 1:
            parity = sum(((a & mask).bit_count() & 1) << a for a in range(1 << width))
            if contents in (parity, parity ^ full):
                return Equation("parity", ((mask, int(contents != parity)),))
    positive = Equation("sum", irredundant_cover(contents, contents, width))
    negative = Equation("product", irredundant_cover(full ^ contents, full ^ contents, width))
    return negative if negative.literals < positive.literals else positive


def irredundant_cover(lower: int, upper: int, width: int) -> tuple[Term, ...]:
    """An irredundant sum of products between two bounds, after Minato and Morreale.

    Args:
        lower: table of the codes that must be covered; bit ``a`` belongs to code ``a``.
        upper: table of the codes that may be covered, a superset of ``lower``.
        width: inputs.
    """
    return _cover(lower, upper, width)[0]


def _cover(lower: int, upper: int, width: int) -> tuple[tuple[Term, ...], int]:
    """The cover and the table it computes."""
    if lower == 0:
        return (), 0
    size = 1 << width
    if upper == (1 << size) - 1:
        return ((0, 0),), upper
    half, top = size >> 1, 1 << (width - 1)
    low = (1 << half) - 1
    lower0, lower1, upper0, upper1 = lower & low, lower >> half, upper & low, upper >> half
    terms0, table0 = _cover(lower0 & ~upper1, upper0, width - 1)
    terms1, table1 = _cover(lower1 & ~upper0, upper1, width - 1)
    rest = lower0 & ~table0 | lower1 & ~table1
    shared, table = _cover(rest, upper0 & upper1, width - 1)
    terms = (
        *((mask | top, value) for mask, value in terms0),
        *((mask | top, value | top) for mask, value in terms1),
        *shared,
    )
    return terms, (table0 | table) | (table1 | table) << half


def _ones(mask: int) -> list[int]:
    return [i for i in range(mask.bit_length()) if mask >> i & 1]


def _literal(bits: Sequence[Value], position: int, positive: bool) -> Value:
    return bits[position] if positive else ~bits[position]


def _tree(items: Sequence[Value], join: Callable[[Value, Value], Value]) -> Value:
    """Join from left to right, balanced: a simulator's parser limits how deep expressions nest."""
    if len(items) == 1:
        return items[0]
    middle = len(items) // 2
    return join(_tree(items[:middle], join), _tree(items[middle:], join))
