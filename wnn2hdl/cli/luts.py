"""`train --max-luts`: networks of look-up tables, trained by gradient within a budget."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from wnn2hdl.dataset.tables import read_table
from wnn2hdl.files import beside
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.progress import Progress
from wnn2hdl.training.gradient import train_rows

OPTIONS = ("--max-luts", "--epochs", "--distort")

CHECKPOINT = ".training"
"""The end of the hidden name, beside the model's, of the file through which a killed training goes on."""

max_luts_option = click.option(
    "--max-luts",
    type=click.IntRange(min=1),
    metavar="N",
    help="Train a network of at most N LUTs on a table.",
)
epochs_option = click.option(
    "--epochs",
    type=click.IntRange(min=2),
    metavar="N",
    help="Train it for N epochs.  [default: by rows]",
)
distort_option = click.option(
    "--distort",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Distort each picture N times.",
)


def train_luts_on_table(
    table: Path,
    label: str | None,
    *,
    max_luts: int,
    levels: int,
    words: FixedPoint | None,
    epochs: int | None,
    distort: int,
    seed: int,
    command: str,
    output: Path,
    progress: Progress,
) -> dict[str, Any]:
    """Train on a table, write the model, and say what it is.

    Args:
        table: CSV file or arrays, see `read_table`.
        label: its column of labels.
        max_luts: of the whole compiled network.
        levels: thresholds for each feature.
        words: format of the features in hardware; None for the narrowest one, if all features are whole.
        epochs: passes over the rows; None for `enough_epochs`.
        distort: how often each picture is distorted.
        seed: of everything that is random.
        command: what the model notes as the command that trained it.
        output: where the model goes.
        progress: reports each epoch.

    Raises:
        InputError: the table cannot be used, the format of its features is not known, it holds no pictures
            to distort, or nothing fits.
    """
    rows = read_table(table, label, "train")
    trained = train_rows(
        rows,
        max_luts=max_luts,
        levels=levels,
        words=words,
        epochs=epochs,
        distort=distort,
        seed=seed,
        progress=progress,
        checkpoint=beside(output, CHECKPOINT),
        source=table,
    )
    figures = trained.model.origin["training"]
    model = replace(trained.model, origin={"training": figures | {COMMAND: command}})
    assert isinstance(model.encoder, Thermometer)
    model.save(output)
    return {
        "model": str(output),
        "kind": model.kind,
        "classes": list(model.classes),
        "features": len(rows.columns),
        "input": str(model.encoder.input),
        "input_bits": model.encoder.width,
        "nodes": model.layers[-1].nodes,
        **figures,
    }


def luts_sentence(summary: dict[str, Any]) -> str:
    """What `train_luts_on_table` found, for people."""
    validated = "no row was kept for validation"
    if "teacher" in summary:
        validated = (
            f"{summary['made_up_rows']} made up\ntaught by {summary['teacher']}, accuracy "
            f"{summary['teacher_accuracy']:.4f} in cross-validation, with which it agrees on "
            f"{summary['validation']:.4f} of the rows made up for validation"
        )
    elif summary["validation"] is not None:
        validated = f"accuracy {summary['validation']:.4f} on rows kept for validation"
    return (
        f"{summary['model']}: {len(summary['classes'])} classes, {summary['luts']} LUTs in all\n"
        f"{summary['nodes']} tables of 6 inputs over {summary['input_bits']} bits of {summary['features']} "
        f"features, words of {summary['input']}\n"
        f"{summary['epochs']} epochs on {summary['rows']} rows, {validated}"
    )
