"""Numbers on the command line that are numbers."""

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
