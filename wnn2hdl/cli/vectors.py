"""Options for tables of feature vectors, the same in every command, and training on them."""

from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import click
import numpy as np

from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.cli.options import file
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.encode.thermometer import Spacing
from wnn2hdl.evaluation.measures import CONFIDENCE, accuracy, wilson
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.ir.models import SparseWisardModel
from wnn2hdl.progress import Progress
from wnn2hdl.training.folds import FOLDS
from wnn2hdl.training.tables import TableOptions, cross_validate_table, train_table

MAPPINGS = ("shared", "per-class")

TRAINING = ("--table", "--label", "--thermometer", "--levels", "--input", "--mapping", "--cross-validate")
"""The options of training on a table, for the sections of a command's help."""


WISARD = ("--thermometer", "--mapping", "--cross-validate")
"""Those of them that only a WiSARD has."""


class WordsType(click.ParamType[FixedPoint]):
    """``Q3.12`` or ``UQ8.0``: a format of fixed-point words."""

    name = "format"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> FixedPoint:
        """The format."""
        if isinstance(value, FixedPoint):
            return value
        try:
            return FixedPoint.parse(str(value))
        except ValueError:
            self.fail(f"{value!r} is not a format of words, as Q3.12 or UQ8.0", param, ctx)


table_option = click.option("--table", type=file, help="Read feature vectors from this CSV or .npz file.")
label_option = click.option("--label", metavar="COLUMN", help="Take the classes from this column of the CSV.")
raw_option = click.option(
    "--raw/--scaled",
    default=None,
    help="Scale features as the model says, or leave them.",
)
most_changed_option = click.option(
    "--most-changed",
    type=FiniteRange(0, 1),
    metavar="SHARE",
    default=0.0,
    show_default=True,
    help="Let this share of them change.",
)
thermometer_option = click.option(
    "--thermometer",
    type=click.Choice(get_args(Spacing)),
    metavar="NAME",
    default="quantiles",
    show_default=True,
    help="Use quantiles, uniform, gaussian.",
)
levels_option = click.option(
    "--levels",
    type=click.IntRange(min=1),
    metavar="N",
    default=8,
    show_default=True,
    help="Set thresholds per feature.",
)
words_option = click.option(
    "--input",
    "words",
    type=WordsType(),
    metavar="FORMAT",
    help="Read features as words of this format, as in Q3.12.",
)
mapping_option = click.option(
    "--mapping",
    type=click.Choice(MAPPINGS),
    metavar="NAME",
    default="shared",
    show_default=True,
    help="Draw it shared or per-class.",
)
cross_validate_option = click.option(
    "--cross-validate",
    "seeds",
    type=click.IntRange(min=0),
    metavar="N",
    default=1,
    show_default=True,
    help="Cross-validate with N seeds.",
)


def train_on_table(
    table: Path,
    label: str | None,
    options: TableOptions,
    *,
    seed: int,
    seeds: int,
    command: str,
    output: Path,
    progress: Progress,
) -> dict[str, Any]:
    """Train on a table, write the model, and say what it is.

    Args:
        table: CSV file or arrays, see `read_table`.
        label: its column of labels.
        options: how the network is built.
        seed: of the mapping; the seeds of cross-validation count up from it.
        seeds: how many of these; 0 leaves cross-validation out.
        command: what the model notes as the command that trained it.
        output: where the model goes.
        progress: reports each fold.

    Raises:
        InputError: the table cannot be used, or the options do not fit it.
    """
    rows = read_table(table, label, "train")
    validation = None
    if seeds:
        numbers = range(seed, seed + seeds)
        confusion = cross_validate_table(rows, options, numbers, progress)
        found = [float(accuracy(one)) for one in confusion]
        validation = {
            "folds": FOLDS,
            "accuracy": float(np.mean(found)),
            "seeds": [
                {"seed": number, "accuracy": share, "interval": list(wilson(one))}
                for number, share, one in zip(numbers, found, confusion, strict=True)
            ],
            "interval": {"method": "Wilson score", "confidence": CONFIDENCE},
        }
    model = train_table(rows, options, seed)
    notes = {"cross_validation": validation, COMMAND: command}
    if isinstance(model, WisardModel):
        model = replace(model, training={**model.training, **notes})
    else:
        model = replace(model, origin={**model.origin, **notes})
    model.save(output)
    return _summary(model, output, len(rows.columns), len(rows.labels), validation)


def _summary(
    model: WisardModel | SparseWisardModel,
    output: Path,
    features: int,
    rows: int,
    validation: dict[str, Any] | None,
) -> dict[str, Any]:
    encoder = model.encoder
    assert isinstance(encoder, Thermometer)
    stored = model.counts if isinstance(model, SparseWisardModel) else model.counts[model.counts > 0]
    return {
        "model": str(output),
        "kind": model.kind,
        "classes": list(model.classes),
        "rows": rows,
        "features": features,
        "thermometer_bits": encoder.width,
        "input": None if encoder.input is None else str(encoder.input),
        "address_bits": model.address_bits,
        "rams": model.rams,
        "mappings": len(model.mapping),
        "bleaching": model.bleaching,
        "addresses_seen": len(stored),
        "cross_validation": validation,
    }


def table_sentence(summary: dict[str, Any]) -> str:
    """What `train_on_table` found, for people."""
    words = "as real numbers: state a format before compiling, as in compile --input Q3.12"
    if summary["input"] is not None:
        words = f"as words of {summary['input']}"
    lines = [
        f"{summary['model']}: {len(summary['classes'])} classes, {summary['rams']} RAMs of "
        f"{summary['address_bits']} address bits each over {summary['thermometer_bits']} thermometer bits",
        f"{summary['features']} features, {words}",
        f"bleaching threshold {summary['bleaching']}, trained on {summary['rows']} rows",
    ]
    validation = summary["cross_validation"]
    if validation is not None:
        lines += [
            f"cross-validation, {validation['folds']} folds, seed {one['seed']}: accuracy "
            f"{one['accuracy']:.4f} ({one['interval'][0]:.4f} to {one['interval'][1]:.4f})"
            for one in validation["seeds"]
        ]
        if len(validation["seeds"]) > 1:
            found = [one["accuracy"] for one in validation["seeds"]]
            lines.append(
                f"over {len(found)} seeds: mean {validation['accuracy']:.4f}, "
                f"{min(found):.4f} to {max(found):.4f}"
            )
    return "\n".join(lines)
