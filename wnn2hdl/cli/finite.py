"""Numbers on the command line that are numbers, and ranges of them."""

import math
from typing import Any

import click


class FiniteRange(click.FloatRange):
    """A range without nan, which click lets into every range, and without infinity."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """The number."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number", param, ctx)
        return number


class SpanType(click.ParamType[tuple[float, float]]):
    """``0.8..1.5``: the least and the greatest of several numbers."""

    name = "LOW..HIGH"

    def __init__(self, least: float, most: float) -> None:
        """Numbers are ``least`` to ``most``."""
        self._least, self._most = least, most

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Both numbers, the first below the second."""
        if isinstance(value, tuple):
            return value
        try:
            low, high = map(float, str(value).split(".."))
        except ValueError:
            self.fail(f"{value!r} is not a range, as in {self._least:g}..{self._most:g}", param, ctx)
        if not self._least <= low < high <= self._most:
            self.fail(f"{value!r} does not rise within {self._least:g}..{self._most:g}", param, ctx)
        return low, high
