"""The proof that ends every minimisation: equality with the table on every cared-for code, one by one."""

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import CheckError
from wnn2hdl.ir import TruthTable


class Function(Protocol):
    """A cover or a network."""

    @property
    def outputs(self) -> tuple[object, ...]:
        """One for each output."""

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Outputs for codes of shape ``S``: bool ``S + (len(outputs),)``."""


def wrong_codes(table: TruthTable, function: Function) -> NDArray[np.int64]:
    """All cared-for codes on which the function differs from the table, ascending."""
    return table.mismatches(function.evaluate(np.arange(len(table.care))))


def require_equal(table: TruthTable, function: Function, what: str) -> None:
    """Refuse a result that differs from its table.

    Args:
        table: the reference.
        function: what was made of it.
        what: its name, for the error: "espresso's cover".

    Raises:
        CheckError: it differs on a cared-for code.
    """
    wrong = wrong_codes(table, function)
    if wrong.size:
        raise CheckError(
            f"{what} differs from its table on {wrong.size} cared-for codes",
            value=f"first code {wrong[0]}",
            hint="this is a defect of the minimiser; report it with the model",
        )
