"""`import`: other tools' trained models become model files."""

from pathlib import Path
from typing import Any

import click

from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import file, output_option
from wnn2hdl.cli.output import emit, json_option
from wnn2hdl.cli.vectors import label_option, table_option
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.bleaching import compare_thresholds
from wnn2hdl.importers import ImportOptions, import_model, known_formats
from wnn2hdl.ir import Thermometer, ThermometerBits, Words
from wnn2hdl.ir.models import BloomWisardModel, ClassifierModel, LogicModel, SparseWisardModel
from wnn2hdl.training.bthowen import with_thresholds


class FormatType(click.ParamType[str]):
    """The name of a format that can be imported."""

    name = "format"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The name, if there is such a format."""
        if value not in known_formats():
            self.fail(f"{value!r} is not one of {', '.join(known_formats())}", param, ctx)
        return str(value)


@app.command("import")
@click.argument("model", metavar="FILE", type=file)
@output_option("Write the model to this file.", is_file=True, required=True)
@click.option(
    "--format",
    "format_name",
    type=FormatType(),
    help="Take FILE for this format.  [default: recognised by its content]",
)
@click.option(
    "--bleach",
    type=click.IntRange(min=1),
    metavar="N",
    help="Fix the bleaching threshold of a wisardpkg model (this changes the classifier).",
)
@click.option(
    "--config",
    type=file,
    help="Read this config.json of KANELE truth tables.  [default: the one beside FILE]",
)
@click.option(
    "--classes",
    type=click.IntRange(min=2),
    metavar="N",
    help="Say how many classes a DWN has if its checkpoint does not.",
)
@table_option
@label_option
@json_option
def import_command(
    model: Path,
    output: Path,
    format_name: str | None,
    bleach: int | None,
    config: Path | None,
    classes: int | None,
    table: Path | None,
    label: str | None,
    as_json: bool,
) -> None:
    """Turn another tool's trained model, FILE, into a model file.

    Formats: wisardpkg JSON, BTHOWeN .pickle.lzma, DWN checkpoints of PyTorch, KANELE truth tables, AIGER,
    BLIF. Files are read as data: nothing in them is run, and PyTorch is not needed.

    With --table, the thresholds of a BTHOWeN model are found from the rows that it was trained on, and the
    bleaching of a wisardpkg model is compared with fixed thresholds on labelled rows.

    \b
    Examples:
      wnn2hdl import wisard.json --bleach 3 -o model.json
      wnn2hdl import iris.pickle.lzma --table iris.csv --label species -o model.json
    """
    options = ImportOptions(bleach=bleach, config=config, classes=classes)
    if table is None and label is not None:
        raise InputError("only a table has labels", value=f"--label {label}", hint="give it with --table")
    importer, imported = import_model(model, options, format_name)
    measured = None
    if table is not None:
        rows = read_table(table, label, "train")
        if isinstance(imported, BloomWisardModel):
            imported = with_thresholds(imported, rows)
        elif isinstance(imported, SparseWisardModel):
            measured = compare_thresholds(imported, rows)
        else:
            raise InputError(
                "rows say nothing more about the model", value=imported.kind, hint="leave --table out"
            )
    imported.save(output)
    kind, names = (
        ("outputs", imported.outputs) if isinstance(imported, LogicModel) else ("classes", imported.classes)
    )
    data = {
        "model": str(output),
        "format": importer.name,
        "kind": imported.kind,
        "input_bits": imported.width,
        "reads": _reads(imported),
        kind: list(names),
        "digest": imported.digest(),
        "origin": dict(imported.origin),
    }
    text = f"{importer.description}: reads {data['reads']}, has {len(names)} {kind}"
    if measured is not None:
        data["accuracy"] = {"rows": measured.rows, "model": measured.as_given, "fixed": measured.fixed}
        text += (
            f"\n{measured.as_given:.1%} of {measured.rows} rows are right; "
            f"with a fixed threshold at most {measured.fixed[measured.best]:.1%}: --bleach {measured.best}"
        )
    text += f"\nwritten to {output}"
    emit(data, text, as_json=as_json)


def _reads(model: ClassifierModel | LogicModel) -> str:
    """What goes into a model, in words, so that users see whether it encodes features itself."""
    encoder = None if isinstance(model, LogicModel) else model.encoder
    if isinstance(encoder, Thermometer):
        return f"{encoder.features} features as {encoder.width} thermometer bits"
    if isinstance(encoder, ThermometerBits):
        return f"{encoder.width} bits of {encoder.thermometers} thermometers"
    if isinstance(encoder, Words) and encoder.word_bits > 1:
        return f"{encoder.features} words of {encoder.word_bits} bits"
    return f"{model.width} bits as they are"
