"""`evaluate`: how good a model or a circuit is on labelled or tagged pictures, or on tables."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from wnn2hdl.build.classifier import open_classifier
from wnn2hdl.build.design import MODEL_FILE
from wnn2hdl.build.folder import require_build
from wnn2hdl.build.reporting import read_report
from wnn2hdl.cli.light import LIGHT, Light, in_light, light_lines, light_options
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import (
    file,
    folder,
    images_option,
    labelled,
    masks_option,
    refuse,
    seed_option,
    share_option,
    square_option,
)
from wnn2hdl.cli.output import emit, json_option, printed, progress
from wnn2hdl.cli.pictures import MASKS, READING, mask_options, reading_options
from wnn2hdl.cli.vectors import label_option, raw_option, table_option
from wnn2hdl.dataset import SAMPLE_IMAGES, SAMPLE_SIDE, Dataset, from_samples
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import Evaluation, Squares, evaluate, majority_labels
from wnn2hdl.evaluation.classifiers import PictureClassifier, PixelTable
from wnn2hdl.evaluation.light import worst_image
from wnn2hdl.evaluation.measures import (
    CONFIDENCE,
    METHOD,
    accuracy,
    class_scores,
    defined,
    interval,
    kappa,
    mean_iou,
)
from wnn2hdl.evaluation.rows import require_vector_classifier
from wnn2hdl.evaluation.tagged import RULE, evaluate_tagged
from wnn2hdl.images import MaskFormat
from wnn2hdl.lower.targets import TARGETS
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Reading
from wnn2hdl.samples import CLASSES as SAMPLE_CLASSES

MEASURES = {"accuracy": accuracy, "kappa": kappa, "mean_iou": mean_iou}


SECTIONS = {
    "Pictures with masks": ("--images", "--masks", *MASKS, *READING, "--square", "--share"),
    "Changed light, with masks": LIGHT,
    "Pictures with tags": ("--chips", "--tags"),
    "Feature vectors": ("--table", "--label", "--raw"),
}


@app.command("evaluate", sections=SECTIONS)
@click.argument("model", type=click.Path(exists=True, path_type=Path))
@images_option
@masks_option
@mask_options
@reading_options
@click.option("--chips", type=folder, help="Read pictures tagged as a whole (needs --tags).")
@click.option("--tags", type=file, help="Read image_name,tags of the chips from this CSV.")
@light_options
@table_option
@label_option
@raw_option
@square_option("Also measure squares whose pixels vote.")
@share_option
@seed_option
@json_option
def evaluate_command(
    model: Path,
    images: Path | None,
    masks: Path | None,
    mask_format: MaskFormat | None,
    reading: Reading,
    chips: Path | None,
    tags: Path | None,
    light: Light,
    table: Path | None,
    label: str | None,
    raw: bool | None,
    square: int | None,
    share: float,
    seed: int,
    as_json: bool,
) -> None:
    """Measure MODEL, a model file or a build folder (its circuit and its model).

    On pictures with masks, or on embedded landscapes if none are given: accuracy, kappa, mean intersection
    over union, and each class's precision, recall, F1 and IoU; the image with the fewest pixels right; and
    in one line whether brighter ground may be answered differently. On pictures with tags: how well the share
    called deforested separates cleared land from forest. Intervals are bootstrapped over images. On feature
    vectors: the same measures, with Wilson's interval of the accuracy. An undefined figure (0/0) is null.

    \b
    Examples:
      wnn2hdl evaluate build/mine --images IMAGES --masks MASKS --exposure 0.8..1.5
      wnn2hdl evaluate model.json --table data.csv --label class --json
    """
    if table is None:
        refuse(("--label", "--raw"), "only a table has feature vectors, and none is given with --table")
    else:
        refuse(LIGHT, "a table has no light")
        if images or masks or mask_format or chips or tags or square or reading != Reading():
            raise InputError("a table has no pictures", hint="leave out the options for pictures")
        data, text = _with_table(model, table, label, raw)
        emit({"classifier": str(model), **data}, text, as_json=as_json)
        return
    parts, mode = _parts(model)
    head = {"classifier": str(model), **mode}
    with progress() as report:
        if chips is None and tags is None:
            first = next(iter(parts.values()))
            dataset = _dataset(first, images, masks, mask_format, reading, seed)
            squares = None if square is None else Squares(square, share, seed)
            data, text = _with_masks(parts, dataset, squares, light, seed, report)
        else:
            if chips is None or tags is None:
                raise InputError("these options go together", value="--chips and --tags", hint="give both")
            refuse(LIGHT, "light is varied with masks")
            if images or masks or mask_format or square:
                raise InputError(
                    "chips with tags have no masks and no squares",
                    hint="leave --images, --masks, --palette, --ignore and --square out",
                )
            data, text = _with_tags(parts, chips, tags, reading, seed, report)
    bootstrap = {"method": METHOD, "confidence": CONFIDENCE, "seed": seed}
    emit({**head, **data, "bootstrap": bootstrap}, text, as_json=as_json)


def _parts(model: Path) -> tuple[dict[str, PixelTable], dict[str, str]]:
    """What is to be measured: a model; or of a build its circuit, then its model, and the mode."""
    if not model.is_dir():
        return {"model": open_classifier(model)}, {}
    require_build(model)
    report = read_report(model)
    if not TARGETS[report["target"]].classifies:
        raise InputError(
            "the build holds no classifier, so there is nothing to measure",
            value=f"{model} (target {report['target']})",
            hint="give its model.json, or a build of another target",
        )
    parts = {"circuit": open_classifier(model), "model": open_classifier(model / MODEL_FILE)}
    return parts, {"mode": report["mode"]}


def _dataset(
    classifier: PictureClassifier,
    images: Path | None,
    masks: Path | None,
    mask_format: MaskFormat | None,
    reading: Reading,
    seed: int,
) -> Dataset:
    given = images or masks or mask_format or reading != Reading()
    if not given and classifier.classes == SAMPLE_CLASSES:
        return from_samples(SAMPLE_IMAGES, SAMPLE_SIDE, seed=seed, every_kind=True)
    return labelled(images, masks, mask_format=mask_format, reading=reading, seed=seed)


def _with_masks(
    parts: dict[str, PixelTable],
    dataset: Dataset,
    squares: Squares | None,
    light: Light,
    seed: int,
    report: Progress,
) -> tuple[dict[str, Any], str]:
    found: dict[str, dict[str, Any]] = {}
    for name, classifier in parts.items():
        result = evaluate(classifier, dataset, report)
        found[name] = {
            **_overall(result, seed),
            "worst_image": worst_image(result.names, result.confusion),
            **in_light(classifier, dataset, light, seed, report),
        }
        if squares is not None:
            truth = majority_labels(dataset, squares.side)
            found[name]["squares"] = {
                "side": squares.side,
                "share": squares.share,
                **_overall(evaluate(classifier, truth, report, squares), seed),
                "pixels": _overall(evaluate(classifier, dataset, report, squares), seed),
            }
        found[name]["per_image"] = {
            image: _figures(confusion, result.classes)
            for image, confusion in zip(result.names, result.confusion, strict=True)
        }
    first = next(iter(found.values()))
    data = {
        "accuracy": first["accuracy"],
        "images": len(dataset),
        "classes": list(dataset.classes),
        **found,
    }
    return data, "\n".join(
        _lines(f"{name}, {len(dataset)} images", figures) for name, figures in found.items()
    )


def _overall(result: Evaluation, seed: int) -> dict[str, Any]:
    return {
        **_figures(result.confusion.sum(axis=0), result.classes),
        "coverage": result.coverage,
        "left_out": {"pixels": int(result.left_out.sum()), "share": result.left_out_share},
        "intervals": {name: interval(result.confusion, measure, seed) for name, measure in MEASURES.items()},
    }


def _figures(confusion: NDArray[np.int64], classes: tuple[str, ...]) -> dict[str, Any]:
    return {
        **{name: defined(measure(confusion)) for name, measure in MEASURES.items()},
        "per_class": {
            name: asdict(scores) for name, scores in zip(classes, class_scores(confusion), strict=True)
        },
        "confusion": confusion.tolist(),
    }


def _with_table(model: Path, table: Path, label: str | None, raw: bool | None) -> tuple[dict[str, Any], str]:
    # Not at the top: it loads what pictures need not wait for.
    from wnn2hdl.api import Build, Model, evaluate_table, load, open_build

    if model.is_dir():
        require_build(model)
    path = model / MODEL_FILE if model.is_dir() else model
    given = load(path)
    classes = require_vector_classifier(given.model, path).classes
    rows = read_table(table, label)
    subjects: dict[str, Model | Build] = {"model": given}
    if model.is_dir():
        subjects = {"circuit": open_build(model), **subjects}
    found: dict[str, dict[str, Any]] = {}
    for name, subject in subjects.items():
        measured = evaluate_table(subject, rows, raw=raw)
        found[name] = _figures(measured.confusion, measured.classes)
        found[name]["intervals"] = {"accuracy": measured.interval, "kappa": None, "mean_iou": None}
    data = {
        "accuracy": next(iter(found.values()))["accuracy"],
        "samples": len(rows.labels),
        "classes": list(classes),
        **found,
        "interval": {"method": "Wilson score", "confidence": CONFIDENCE},
    }
    lines = [_lines(f"{name}, {len(rows.labels)} samples", figures) for name, figures in found.items()]
    return data, "\n".join(lines)


def _with_tags(
    parts: dict[str, PixelTable],
    chips: Path,
    tags: Path,
    reading: Reading,
    seed: int,
    report: Progress,
) -> tuple[dict[str, Any], str]:
    found: dict[str, dict[str, Any]] = {}
    lines = []
    for name, classifier in parts.items():
        result = evaluate_tagged(classifier, chips, tags, seed, report, reading)
        cleared = sum(result.cleared.values())
        found[name] = {
            "auc": result.auc,
            "interval": result.interval,
            "chips": {
                chip: {"cleared": result.cleared[chip], "deforested_share": share}
                for chip, share in result.shares.items()
            },
        }
        lines.append(
            f"{name}: area under the ROC curve {_figure(result.auc)}{_span(result.interval)}, "
            f"{cleared} chips of cleared land against {len(result.cleared) - cleared} of forest"
        )
    lines += [f"left out: {count} {reason}" for reason, count in result.left_out.items()]
    data = {
        "auc": next(iter(found.values()))["auc"],
        "images": len(result.cleared),
        "left_out": result.left_out,
        "rule": RULE,
        **found,
    }
    return data, "\n".join([*lines, RULE])


def _lines(heading: str, figures: dict[str, Any]) -> str:
    lines = [f"{heading}: {_sentence(figures)}"]
    left_out = figures.get("left_out", {"pixels": 0})
    if left_out["pixels"]:
        lines.append(f"{left_out['share']:.2%} of the pixels left out: not labelled, or no data")
    table = Table("class", "precision", "recall", "F1", "IoU")
    for label, scores in figures["per_class"].items():
        table.add_row(label, *(_figure(score) for score in scores.values()))
    lines.append(printed(table))
    if "worst_image" in figures:
        worst = figures["worst_image"]
        lines += [f"worst image: {worst['name']}, accuracy {worst['accuracy']:.4f}", *light_lines(figures)]
    if "squares" in figures:
        squares = figures["squares"]
        lines += [
            f"squares of {squares['side']}, {squares['share']:g} of the pixels voting:",
            f"  against the majority of each square of the mask: {_sentence(squares)}",
            f"  against each pixel of the mask: {_sentence(squares['pixels'])}",
        ]
    return "\n".join(lines)


def _sentence(figures: dict[str, Any]) -> str:
    names = {"accuracy": "accuracy", "kappa": "kappa", "mean_iou": "mean IoU"}
    return ", ".join(
        f"{text} {_figure(figures[key])}{_span(figures['intervals'][key])}" for key, text in names.items()
    )


def _figure(value: float | None) -> str:
    return "n/a" if value is None else f"{value:.4f}"


def _span(span: tuple[float, float] | None) -> str:
    return "" if span is None else f" ({span[0]:.4f} to {span[1]:.4f})"
