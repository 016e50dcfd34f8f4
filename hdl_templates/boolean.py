"""Equations of look-up tables as Amaranth expressions."""

from collections.abc import Callable, Sequence

from amaranth.hdl import Const, Value

from wnn2hdl.ir.equation import Equation


def expression(equation: Equation, bits: Sequence[Value]) -> Value:
    """An equation over ``bits``, each one bit wide, in the order of the table's inputs."""
    if equation.kind == "parity":
        mask, complement = equation.terms[0]
        parity = _tree([bits[i] for i in _ones(mask)], lambda a, b: a ^ b)
        return ~parity if complement else parity
    if equation.kind == "product":
        clauses = [
            _tree([_literal(bits, i, not value >> i & 1) for i in _ones(mask)], lambda a, b: a | b)
            for mask, value in equation.terms
        ]
        return _tree(clauses, lambda a, b: a & b)
    if not any(mask for mask, _ in equation.terms):
        return Const(int(bool(equation.terms)), 1)
    products = [
        _tree([_literal(bits, i, bool(value >> i & 1)) for i in _ones(mask)], lambda a, b: a & b)
        for mask, value in equation.terms
    ]
    return _tree(products, lambda a, b: a | b)


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
