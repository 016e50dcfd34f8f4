"""`narrow`: the fewest bits of features with which a model's answers hardly change."""

from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from wnn2hdl.build.narrowing import Narrowed, encoder_luts, narrow_features, narrow_formats
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import file, output_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.vectors import label_option, most_changed_option, raw_option, table_option
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import VectorClassifier, feature_answers, load_vector_classifier, scaled
from wnn2hdl.progress import reported

SECTIONS = {"Feature vectors": ("--table", "--label", "--raw", "--most-changed")}


@app.command("narrow", sections=SECTIONS)
@click.argument("model", type=file)
@output_option("Write the narrowed model to this file.", is_file=True, required=True)
@table_option
@label_option
@raw_option
@most_changed_option
@json_option
def narrow_command(
    model: Path,
    output: Path,
    table: Path | None,
    label: str | None,
    raw: bool | None,
    most_changed: float,
    as_json: bool,
) -> None:
    """Narrow the words that MODEL reads, as long as its answers on a table hardly change.

    Thresholds are moved to coarser and coarser numbers, feature by feature, and the model that is written
    states the format that they need. The same rows choose and judge; so the search is also done on every
    other row alone, and judged on the rest.

    \b
    Examples:
      wnn2hdl narrow model.json --table data.csv --label class -o narrow.json
      wnn2hdl narrow model.json --table test.npz --most-changed 0.002 -o narrow.json
    """
    if table is None:
        raise InputError("narrowing needs rows whose answers are compared", hint="give a table with --table")
    wide = load_vector_classifier(model)
    rows = read_table(table, label)
    features = scaled(wide, rows, raw)
    feature_answers(wide, features)  # refuses rows that the model cannot read
    most = int(most_changed * len(features))
    with progress() as report:
        found = narrow_features(wide, features, most, report)
        half = None
        if len(features) > 1:
            other = narrow_features(wide, features[::2], int(most_changed * len(features[::2])), report)
            half = _judged(other, wide, features[1::2])
        formats = list(narrow_formats(wide, features))
        tried = [
            {
                "format": str(one.words),
                "unmoved": one.unmoved,
                "changed": one.changed,
                "encoder_luts": encoder_luts(one.model),
            }
            for one in reported(formats, "estimating LUTs", len(formats), report)
        ]
        found.model.save(output)
    data = {
        "model": str(output),
        "rows": len(features),
        "most_changed": most,
        "changed": found.changed,
        "format": str(found.words),
        "fractions": list(found.fractions),
        "encoder_luts": encoder_luts(found.model),
        "unseen": half,
        "formats": tried,
    }
    emit(data, _text(data), as_json=as_json)


def _judged(found: Narrowed, wide: VectorClassifier, features: NDArray[np.float64]) -> dict[str, int]:
    """How many answers a narrowed model changes on rows that had no part in its search."""
    changed = feature_answers(found.model, features) != feature_answers(wide, features)
    return {"rows": len(features), "changed": int(np.count_nonzero(changed))}


def _text(data: dict[str, Any]) -> str:
    table = Table(title="One format for all features", title_justify="left")
    table.add_column("format")
    for heading in ("changed", "if not moved", "LUTs of the encoder"):
        table.add_column(heading, justify="right")
    for one in data["formats"]:
        luts = one["encoder_luts"]
        table.add_row(
            one["format"], str(one["changed"]), str(one["unmoved"]), "n/a" if luts is None else str(luts)
        )
    console = Console(width=100, markup=False, emoji=False)
    with console.capture() as captured:
        console.print(table)
    fractions = " ".join("-" if bits is None else str(bits) for bits in data["fractions"])
    lines = [
        captured.get().rstrip(),
        f"feature by feature: {data['format']}, fraction bits {fractions}",
        f"{data['changed']} of {data['rows']} answers change",
    ]
    if data["encoder_luts"] is not None:
        lines[-1] += f"; the encoder takes about {data['encoder_luts']} LUTs"
    if data["unseen"] is not None:
        lines.append(
            f"the same search on every other row changes {data['unseen']['changed']} of the "
            f"{data['unseen']['rows']} answers that it did not see"
        )
    return "\n".join([*lines, f"written to {data['model']}"])
