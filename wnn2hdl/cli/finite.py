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
    """``0.8..1.5``: two finite numbers, the first below the second."""

    name = "LOW..HIGH"

    def __init__(self, example: str, least: float = -math.inf, most: float = math.inf) -> None:
        """Numbers are ``least`` to ``most``; complaints show an example."""
        self._example, self._least, self._most = example, least, most

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Both numbers."""
        if isinstance(value, tuple):
            return value
        try:
            low, high = map(float, str(value).split(".."))
        except ValueError:
            self.fail(f"{value!r} is not a range, as in {self._example}", param, ctx)
        if not -math.inf < low < high < math.inf:
            self.fail(
                f"{value!r} does not rise from one number to another, as in {self._example}", param, ctx
            )
        if not self._least <= low < high <= self._most:
            self.fail(f"{value!r} is not within {self._least:g}..{self._most:g}", param, ctx)
        return low, high

    def spoken(self, value: tuple[float, float]) -> str:
        """The value as users write it."""
        return "..".join(map(repr, value))
