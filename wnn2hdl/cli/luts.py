"""`train --max-luts`: networks of look-up tables, trained by gradient within a budget."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from wnn2hdl.cli.front import Candidate, save_front
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError
from wnn2hdl.files import beside
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.progress import Progress
from wnn2hdl.training.gradient import Trained, train_rows

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
    pareto: bool,
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
        pareto: train networks of half as many LUTs, too, and of half of those, as long as any fits, and write
            those that no other beats.
        seed: of everything that is random.
        command: what the model notes as the command that trained it.
        output: where the model goes.
        progress: reports each epoch.

    Raises:
        InputError: the table cannot be used, the format of its features is not known, it holds no pictures
            to distort, nothing fits, or no row is left to compare networks by.
    """
    rows = read_table(table, label, "train")
    train = partial(
        train_rows,
        rows,
        levels=levels,
        words=words,
        epochs=epochs,
        distort=distort,
        seed=seed,
        progress=progress,
        checkpoint=beside(output, CHECKPOINT),
        source=table,
    )
    trained = [train(max_luts=max_luts)]
    if pareto:
        if trained[0].validation is None:
            raise InputError(
                "no row is kept for validation, by which networks could be compared",
                value=table,
                hint="give at least ten rows of each class",
            )
        trained += _smaller(train, max_luts // 2)
    models = [_commanded(one.model, command) for one in trained]
    model = max(zip(models, trained, strict=True), key=lambda pair: pair[1].validation or 0)[0]
    figures = model.origin["training"]
    assert isinstance(model.encoder, Thermometer)
    model.save(output)
    front = {}
    if pareto:
        candidates = [
            Candidate(one.luts or 0, one.validation or 0, f"{of.layers[-1].nodes} tables", of)
            for one, of in zip(trained, models, strict=True)
        ]
        worth = "accuracy in validation" if trained[0].teacher is None else "agreement with the teacher"
        front = {"front": save_front(candidates, output, cost="LUTs", worth=worth)}
    return {
        "model": str(output),
        "kind": model.kind,
        "classes": list(model.classes),
        "features": len(rows.columns),
        "input": str(model.encoder.input),
        "input_bits": model.encoder.width,
        "nodes": model.layers[-1].nodes,
        **figures,
        **front,
    }


def _smaller(train: Callable[..., Trained], max_luts: int) -> list[Trained]:
    """Networks within a number of LUTs, half as many, and so on, as long as any fits."""
    found = []
    while max_luts:
        try:
            found.append(train(max_luts=max_luts))
        except InputError:  # the first budget showed that nothing else is wrong
            break
        max_luts //= 2
    return found


def _commanded(model: LutGroupModel, command: str) -> LutGroupModel:
    return replace(model, origin={"training": model.origin["training"] | {COMMAND: command}})


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
    steps = ""
    if summary["steps"]:
        learned, dropped, again = summary["steps"]
        steps = (
            f"\n{learned['accuracy']:.4f} with {learned['nodes_per_class']} tables for each class, "
            f"{dropped['accuracy']:.4f} with the best {dropped['nodes_per_class']}, "
            f"{again['accuracy']:.4f} when these were trained again"
        )
    front = "".join(
        f"\n{point['luts']} LUTs: {point['accuracy']:.2%} in validation, {point['method']}, {point['model']}"
        for point in summary.get("front", ())
    )
    return (
        f"{summary['model']}: {len(summary['classes'])} classes, {summary['luts']} LUTs in all\n"
        f"{summary['nodes']} tables of 6 inputs over {summary['input_bits']} bits of {summary['features']} "
        f"features, words of {summary['input']}\n"
        f"{summary['epochs']} epochs on {summary['rows']} rows, {validated}{steps}{front}"
    )
