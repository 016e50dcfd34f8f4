"""The front of accuracy against LUTs that `train --pareto` writes."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.ir.models import AnyModel
from wnn2hdl.training.budget import pareto_front


@dataclass(frozen=True)
class Candidate:
    """A trained model, what it costs and what it is worth.

    Attributes:
        luts: of its circuit.
        accuracy: share right, 0 to 1.
        method: how it was trained.
        model: what is written if no other is better and smaller.
    """

    luts: int
    accuracy: float
    method: str
    model: AnyModel


def save_front(
    candidates: Sequence[Candidate],
    output: Path,
    *,
    cost: str = "LUTs per pixel",
    worth: str = "accuracy on unseen images",
) -> list[dict[str, Any]]:
    """Write a model for each point of the front, and the plot, beside the best model.

    Args:
        candidates: all that were trained.
        output: the best model's file, after which the others are named.
        cost: what the LUTs are of.
        worth: what the accuracy is of.
    """
    # Not at the top: other trainings need not wait for it.
    from wnn2hdl.report.plots import plot_pareto

    front = pareto_front(candidates)
    rows = []
    for point in front:
        path = output.with_name(f"{output.stem}-{point.luts}luts.json")
        point.model.save(path)
        rows.append(
            {"luts": point.luts, "accuracy": point.accuracy, "method": point.method, "model": str(path)}
        )
    plot_pareto(
        [(point.luts, point.accuracy, point.method) for point in candidates],
        [(point.luts, point.accuracy, point.method) for point in front],
        output.with_name(f"{output.stem}-pareto"),
        cost=cost,
        worth=worth,
    )
    return rows
