"""Voting networks of look-up tables from the rows of a table, within a number of LUTs."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.encode import whole_words
from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.progress import Progress
from wnn2hdl.training.gradient.network import Architecture, Trained, train_network
from wnn2hdl.training.gradient.teacher import usual_made_up
from wnn2hdl.training.gradient.training import usual_recipe


def train_rows(
    rows: FeatureTable,
    *,
    max_luts: int,
    levels: int,
    words: FixedPoint | None,
    epochs: int | None = None,
    distort: int = 0,
    seed: int,
    progress: Progress,
    checkpoint: Path | None = None,
    source: Path | None = None,
) -> Trained:
    """Train on rows; the model's ``origin`` says how.

    Few rows that are no pictures teach a teacher first, which labels rows made up between them.

    Args:
        rows: features and classes.
        max_luts: of the whole compiled network.
        levels: thresholds for each feature.
        words: format of the features in hardware; None for the narrowest one, if all features are whole.
        epochs: passes over the rows, made-up ones included; None for `enough_epochs`.
        distort: how often each picture is distorted.
        seed: of everything that is random.
        progress: reports each epoch.
        checkpoint: the file through which a killed training goes on; None for none.
        source: the file of the rows, which complaints name.

    Raises:
        InputError: the format of the features is not known, there are no pictures to distort, or nothing
            fits.
        ToolError: Yosys, which counts LUTs, is missing or failed.
    """
    classes, owners = rows.owned()
    if distort and rows.grid is None:
        raise InputError(
            "only pictures can be distorted",
            value=source,
            hint="give arrays [samples, rows, columns] in an .npz file",
        )
    form = whole_words(rows.features) if words is None else words
    if form is None:
        raise InputError(
            "hardware reads fixed-point words, and the features are no whole numbers",
            value=source,
            hint="state a format, as in --input Q3.12 or TableOptions(words=FixedPoint.parse('Q3.12'))",
        )
    made_up = usual_made_up(len(rows.labels), pictures=rows.grid is not None)
    architecture = Architecture(
        form, max_luts=max_luts, levels=levels, grid=rows.grid, distortions=distort, made_up=made_up
    )
    recipe = usual_recipe(len(rows.labels) + made_up, epochs=epochs, seed=seed)
    trained = train_network(rows.features, owners, classes, architecture, recipe, progress, checkpoint)
    figures: dict[str, Any] = {
        "luts": trained.luts,
        "validation": trained.validation,
        "epochs": trained.epochs,
        "nodes_per_class": trained.nodes,
        "seed": seed,
        "rows": len(rows.labels),
        "steps": [{"nodes_per_class": nodes, "accuracy": right} for nodes, right in trained.steps],
    }
    if trained.teacher is not None:
        figures |= {
            "teacher": trained.teacher.name,
            "teacher_accuracy": trained.teacher.accuracy,
            "made_up_rows": made_up,
        }
    return replace(trained, model=replace(trained.model, origin={"training": figures}))
