"""Markdown (GitHub's): tables, and text of which no character is taken for markup."""

import re
from collections.abc import Iterable, Sequence
from typing import Any, Literal

from wnn2hdl.errors import printable

MISSING = "n/a"
"""What a cell shows where there is no value."""

Align = Literal["left", "right"]

_RULES: dict[Align, str] = {"left": "---", "right": "---:"}

_MARKUP = re.compile(r"[\\`*\[\]<>|&~]|(?<!\w)_|_(?!\w)")


def table(headers: Sequence[str], rows: Iterable[Sequence[Any]], align: Sequence[Align] = ()) -> str:
    """A table, without the end of its last line.

    Args:
        headers: of the columns.
        rows: cells; None shows as `MISSING`, floats with four significant digits, all else as its text,
            which may hold any character.
        align: of each column; all are aligned to the left by default.
    """
    return "\n".join([head(headers, align), *map(row, rows)])


def head(headers: Sequence[str], align: Sequence[Align] = ()) -> str:
    """The first two lines of a table, for one whose rows are printed as they come."""
    rules = [_RULES[side] for side in align or ["left"] * len(headers)]
    return f"{row(headers)}\n| {' | '.join(rules)} |"


def row(cells: Sequence[Any]) -> str:
    """One line of a table."""
    return f"| {' | '.join(map(_cell, cells))} |"


def escaped(text: object) -> str:
    """Any text, such as a file's name, on one line and with all its characters standing for themselves."""
    return _MARKUP.sub(r"\\\g<0>", printable(" ".join(str(text).split())))


def _cell(value: Any) -> str:
    if value is None:
        return MISSING
    if isinstance(value, float):
        return f"{value:.4g}"
    return escaped(value)
