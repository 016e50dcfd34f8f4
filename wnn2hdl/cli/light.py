"""Options for changed light, and what a classifier answers there, for programs and for people."""

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

import click
from rich.table import Table

from wnn2hdl.cli.finite import SpanType
from wnn2hdl.cli.output import printed
from wnn2hdl.dataset import Dataset
from wnn2hdl.evaluation.classifiers import PixelTable
from wnn2hdl.evaluation.light import (
    BRIGHTER,
    CHANGES,
    brighter_figures,
    brighter_warning,
    light_curve,
    steps,
)
from wnn2hdl.progress import Progress

Command = Callable[..., None]

Light = Mapping[str, tuple[float, ...]]
"""What is varied, of `wnn2hdl.evaluation.light.CHANGES`, and its values."""

LIGHT = ("--exposure", "--haze", "--white-balance", "--gamma")
"""For the sections of a command's help."""

HAZE_ALONE = "0..0.1"
"""The range of ``--haze`` without one."""

exposure_option = click.option(
    "--exposure",
    type=SpanType("0.8..1.5", 0.1, 10),
    help="Also measure in this range of the light, as in 0.8..1.5.",
)
haze_option = click.option(
    "--haze",
    type=SpanType(HAZE_ALONE, 0, 1),
    is_flag=False,
    flag_value=HAZE_ALONE,
    help=f"Also measure through white haze.  [default: {HAZE_ALONE}]",
)
white_balance_option = click.option(
    "--white-balance",
    type=SpanType("0.9..1.1", 0.5, 2),
    help="Also measure with red times these factors, and blue divided by them.",
)
gamma_option = click.option(
    "--gamma",
    type=SpanType("0.8..1.25", 0.2, 5),
    help="Also measure with levels raised to these powers.",
)


def light_options(command: Command) -> Command:
    """Give a command the options of `LIGHT`, which it gets as ``light``."""

    @wraps(command)
    def reads(**options: Any) -> None:
        spans: dict[str, tuple[float, float] | None] = {name: options.pop(name) for name in CHANGES}
        light = {name: steps(*span, name) for name, span in spans.items() if span is not None}
        command(light=light, **options)

    return exposure_option(haze_option(white_balance_option(gamma_option(reads))))


def in_light(
    classifier: PixelTable, dataset: Dataset, light: Light, seed: int, progress: Progress
) -> dict[str, Any]:
    """What a classifier loses in brighter light, and its accuracy in the light that was asked for.

    Args:
        classifier: what answers.
        dataset: labelled images.
        light: what was asked for.
        seed: of the bootstrap.
        progress: called with each image read.
    """
    brighter = light_curve(classifier, dataset, "exposure", BRIGHTER, progress)
    curves = {
        quantity: light_curve(classifier, dataset, quantity, values, progress)
        for quantity, values in light.items()
    }
    return {
        "brighter": brighter_figures(brighter.shares, classifier.encoder),
        "light": {quantity: curve.figures(seed) for quantity, curve in curves.items()},
    }


def light_lines(figures: Mapping[str, Any]) -> list[str]:
    """What `in_light` found, for people: a table for each quantity, and the warning if there is one."""
    lines = [_table(quantity.replace("_", " "), points) for quantity, points in figures["light"].items()]
    warning = brighter_warning(figures["brighter"])
    return [*lines, warning] if warning else lines


def _table(quantity: str, points: list[dict[str, Any]]) -> str:
    table = Table(quantity, "accuracy", "95 % interval", "worst image", "its accuracy")
    for point in points:
        worst, span = point["worst_image"], point["interval"]
        between = "n/a" if span is None else f"{span[0]:.4f} to {span[1]:.4f}"
        figures = f"{point['accuracy']:.4f}", between, worst["name"], f"{worst['accuracy']:.4f}"
        table.add_row(f"{point['value']:g}", *figures)
    lowest = min(points, key=lambda point: point["accuracy"])
    return f"{printed(table)}\nlowest accuracy {lowest['accuracy']:.4f}, at {quantity} {lowest['value']:g}"
