"""Verilog expressions: one-bit operations as trees, and operands brought to the width of their operator."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

_OPERAND = r"(?:\$signed\([^()]*\)|[\w$]+(?:\[\d+(?::\d+)?\])?|\d+'h[0-9a-f]+)"
_ARITHMETIC = re.compile(rf"({_OPERAND}) (\+|-|>=|<=|>|<|==|!=) ({_OPERAND})")
_CONSTANT = re.compile(r"(\d+)'h([0-9a-f]+)")
_SLICE = re.compile(r"([\w$]+)\[(\d+)(?::(\d+))?\]")
_ASSOCIATIVE = ("&", "|", "^")


@dataclass(frozen=True)
class Operation:
    """A one-bit operation: ``~``, ``&``, ``|``, ``^`` or ``?``, over names, bits, constants or operations."""

    operator: str
    operands: "tuple[Operation | str, ...]"

    def map(self, text: Callable[[str], str]) -> "Operation":
        """The same operation over rewritten names."""
        return Operation(
            self.operator, tuple(x.map(text) if isinstance(x, Operation) else text(x) for x in self.operands)
        )

    def flat(self) -> "Operation":
        """``(a & b) & c`` as one operation of three operands."""
        if self.operator not in _ASSOCIATIVE:
            return self
        operands: list[Operation | str] = []
        for operand in self.operands:
            same = isinstance(operand, Operation) and operand.operator == self.operator
            operands.extend(operand.operands if isinstance(operand, Operation) and same else (operand,))
        return Operation(self.operator, tuple(operands))


def close(text: str) -> str:
    """Reductions and concatenations without the blanks that the back end puts into them."""
    return re.sub(r"^([&|^]) ", r"\1", text.strip()).replace("{ ", "{").replace(" }", "}")


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


def widen(text: str, width: int, widths: Mapping[str, int]) -> str:
    """An expression whose operands have the width of their operator.

    Args:
        text: as Amaranth's back end writes it: one operator over names, slices and constants, signed or not.
        width: bits of the wire that it drives.
        widths: bits of each wire.

    Returns:
        Sums and comparisons with operands extended by zeros or by their sign;
        anything else unchanged.
    """
    match = _ARITHMETIC.fullmatch(text)
    if not match:
        return text
    left, operator, right = match.groups()
    comparison = operator not in "+-"
    target = max(_width(left, widths), _width(right, widths)) if comparison else width
    extended = [_extend(operand, target, widths) for operand in (left, right)]
    if comparison and left.startswith("$signed"):
        extended = [f"$signed({operand})" for operand in extended]
    return f" {operator} ".join(extended)


def _bare(operand: str) -> str:
    return operand.removeprefix("$signed(").rstrip(")")


def _width(operand: str, widths: Mapping[str, int]) -> int:
    bare = _bare(operand)
    if match := _CONSTANT.fullmatch(bare):
        return int(match[1])
    if match := _SLICE.fullmatch(bare):
        return int(match[2]) - int(match[3] or match[2]) + 1
    return widths[bare]


def _extend(operand: str, target: int, widths: Mapping[str, int]) -> str:
    bare, signed = _bare(operand), operand.startswith("$signed")
    width = _width(operand, widths)
    if match := _CONSTANT.fullmatch(bare):
        value = int(match[2], 16)
        if signed and value >> (width - 1):
            value += (1 << target) - (1 << width)
        return f"{target}'h{value:x}"
    if width == target:
        return bare
    if not signed:
        return f"{{{target - width}'h0, {bare}}}"
    match = _SLICE.fullmatch(bare)
    top = f"{match[1]}[{match[2]}]" if match else (f"{bare}[{width - 1}]" if width > 1 else bare)
    return f"{{{', '.join([top] * (target - width))}, {bare}}}"
