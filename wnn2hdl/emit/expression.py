"""Verilog expressions: trees of one-bit operations, and words of bits."""

from collections.abc import Sequence
from dataclasses import dataclass

ASSOCIATIVE = ("&", "|", "^")


@dataclass(frozen=True)
class Operation:
    """A one-bit operation: ``~``, ``&``, ``|``, ``^`` or ``?``, over references, constants or operations."""

    operator: str
    operands: "tuple[Operation | str, ...]"

    def flat(self) -> "Operation":
        """``(a & b) & c`` as one operation of three operands."""
        if self.operator not in ASSOCIATIVE:
            return self
        operands: list[Operation | str] = []
        for operand in self.operands:
            same = isinstance(operand, Operation) and operand.operator == self.operator
            operands.extend(operand.operands if isinstance(operand, Operation) and same else (operand,))
        return Operation(self.operator, tuple(operands))


def render(value: Operation | str) -> str:
    """An operation as Verilog, with parentheses around operations of another kind; text as it is."""
    if isinstance(value, str):
        return value
    inner = [
        f"({render(operand)})"
        if isinstance(operand, Operation) and operand.operator != "~"
        else render(operand)
        for operand in value.operands
    ]
    if value.operator == "~":
        return f"~{inner[0]}"
    if value.operator == "?":
        return f"{inner[0]} ? {inner[1]} : {inner[2]}"
    return f" {value.operator} ".join(inner)


Piece = tuple[str, int, int]
"""Consecutive bits of a net: its name, the lowest bit and how many; the name ``""`` is a constant, whose
value stands in place of the lowest bit."""


def pieces(references: Sequence[Piece]) -> list[Piece]:
    """References to single bits, the least significant first, joined where they are neighbours."""
    joined: list[Piece] = []
    for net, low, width in references:
        if joined:
            last, start, size = joined[-1]
            if net == last == "":
                joined[-1] = ("", start | low << size, size + width)
                continue
            if net == last and start + size == low:
                joined[-1] = (net, start, size + width)
                continue
        joined.append((net, low, width))
    return joined


def render_word(word: Sequence[Piece], widths: dict[str, int]) -> str:
    """A word as Verilog.

    Args:
        word: its pieces, the least significant first.
        widths: bits of each net.
    """
    texts = [_render_piece(piece, widths) for piece in reversed(word)]
    return texts[0] if len(texts) == 1 else f"{{{', '.join(texts)}}}"


def constant(value: int, width: int) -> str:
    """A constant in hexadecimal, all of its digits written."""
    return f"{width}'h{value:0{-(-width // 4)}x}"


def _render_piece(piece: Piece, widths: dict[str, int]) -> str:
    net, low, width = piece
    if not net:
        return constant(low, width)
    if width == widths[net]:
        return net
    return f"{net}[{low}]" if width == 1 else f"{net}[{low + width - 1}:{low}]"


def range_of(width: int) -> str:
    """The range in a declaration of a net of this many bits, with a space after it; empty for one bit."""
    return f"[{width - 1}:0] " if width > 1 else ""
