"""`sweep`: thousands of architectures trained and costed, and any of their models rebuilt."""

import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from wnn2hdl.apps.sweep import (
    TRAINING_PIXELS,
    Outcome,
    PixelSets,
    Recipe,
    Trial,
    draw,
    find_trial,
    grid,
    present,
    rebuild,
    run_distributed,
    run_locally,
    run_sweep,
    run_trial,
    seen_colours,
)
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import (
    BleachingType,
    bits_option,
    folder,
    images_option,
    labelled,
    masks_option,
    scheduler_option,
    seed_option,
)
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import MASKS, READING, mask_options, reading_options
from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.images import MaskFormat
from wnn2hdl.raster import Reading

DEFAULT_FOLDER = Path("build/sweep")


class RangeType(click.ParamType[tuple[int, ...] | str]):
    """``2..12``, both ends included, or a single number."""

    name = "LOW..HIGH"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, ...]:
        """All numbers of the range."""
        if isinstance(value, tuple):
            return value
        low, _, high = str(value).partition("..")
        ends = (low, high or low)
        if not all(end.isdecimal() for end in ends) or not 1 <= int(ends[0]) <= int(ends[1]):
            self.fail(f"{value!r} is not a range of whole numbers from 1, as in 2..12", param, ctx)
        return tuple(range(int(ends[0]), int(ends[1]) + 1))


SECTIONS = {
    "Images and labels": ("--images", "--masks", *MASKS, *READING),
    "Trials": (
        "--address-bits",
        "--rams",
        "--trials",
        "--bits",
        "--pixels",
        "--bleach",
        "--mode",
        "--care-min",
        "--beyond-grid",
    ),
    "A model of the sweep": ("--best", "--trial", "--results"),
}


@app.command("sweep", sections=SECTIONS)
@images_option
@masks_option
@mask_options
@reading_options
@click.option(
    "--address-bits",
    type=RangeType(),
    default="2..12",
    show_default=True,
    help="Try these address bits.",
)
@click.option(
    "--rams",
    type=RangeType(),
    default="2..20",
    show_default=True,
    help="Try these numbers of RAMs.",
)
@click.option(
    "--trials",
    type=click.IntRange(min=1),
    metavar="N",
    default=10,
    show_default=True,
    help="Train each architecture N times.",
)
@bits_option
@click.option(
    "--pixels",
    type=click.IntRange(min=1),
    metavar="N",
    default=TRAINING_PIXELS,
    show_default=True,
    help="Train on N pixels.",
)
@click.option(
    "--bleach",
    type=BleachingType(),
    default="auto",
    show_default=True,
    help="Set the bleaching threshold, or cross-validate it.",
)
@click.option(
    "--mode",
    type=click.Choice(["exact", "domain"]),
    default="domain",
    show_default=True,
    help="Equal the classifier on every code, or on those of the training images.",
)
@click.option(
    "--care-min",
    type=click.IntRange(min=1),
    metavar="N",
    default=1,
    show_default=True,
    help="Care for codes that occur this often.",
)
@seed_option
@click.option("--beyond-grid", is_flag=True, help="Also search beyond the grid, by NSGA-II.")
@scheduler_option
@click.option("--best", is_flag=True, help="Write the chosen architecture's best model.")
@click.option("--trial", "name", metavar="ID", help="Write the model of this trial, as in n4-k16-t3.")
@click.option(
    "--results",
    type=folder,
    help=f"Take the model from this sweep.  [default: {DEFAULT_FOLDER}]",
)
@click.option(
    "-o",
    "--output",
    "output",
    type=click.Path(path_type=Path),
    help=f"Write into this folder, or to this model file.  [default: {DEFAULT_FOLDER}]",
)
@json_option
def sweep_command(
    images: Path | None,
    masks: Path | None,
    mask_format: MaskFormat | None,
    reading: Reading,
    address_bits: tuple[int, ...],
    rams: tuple[int, ...],
    trials: int,
    bits: str | None,
    pixels: int,
    bleach: int | str,
    mode: str,
    care_min: int,
    seed: int,
    beyond_grid: bool,
    scheduler: str | None,
    best: bool,
    name: str | None,
    results: Path | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Train and cost every architecture of a grid, and choose one.

    Results are kept as they come: the same command continues where an interrupted one stopped. Half of the
    images are trained on, the others are held out.

    \b
    Examples:
      wnn2hdl sweep --images IMAGES --masks MASKS --address-bits 3..5 --rams 8..16 -o build/sweep
      wnn2hdl sweep --images IMAGES --masks MASKS --best --results build/sweep -o model.json
    """
    where, model_file = _places(output, results, best=best, name=name)
    encoder = parse_bits(bits) if bits else high_bits()
    recipe = Recipe(
        seed,
        encoder.bits,
        bleach if isinstance(bleach, int) else None,
        care_min if mode == "domain" else None,
    )
    plan = grid(recipe, address_bits, rams, trials)
    run = partial(run_distributed, scheduler) if scheduler else run_locally
    with progress() as report:
        dataset = labelled(images, masks, mask_format=mask_format, reading=reading, seed=seed)
        sets = draw(dataset, pixels=pixels, seed=seed, progress=report)
        if name is not None:
            _write_model(sets, find_trial(plan, where, name), model_file, as_json=as_json)
            return
        started = time.perf_counter()
        outcome = run_sweep(sets, plan, where, run, report, search=beyond_grid)
        seconds = time.perf_counter() - started
    if best:
        if outcome.decision is None:
            raise InputError(
                "no trial is valid", value=f"{len(plan)} trials", hint="see their errors in trials.csv"
            )
        trial = find_trial(plan, where, outcome.decision.chosen.best.name)
        _write_model(sets, trial, model_file, as_json=as_json)
        return
    present(outcome, sets, where)
    emit(
        outcome.to_json() | {"folder": str(where), "seconds": seconds},
        _summary(outcome, where),
        as_json=as_json,
    )


def _places(output: Path | None, results: Path | None, *, best: bool, name: str | None) -> tuple[Path, Path]:
    """The sweep's folder and, where one is wanted, the model file."""
    if best and name is not None:
        raise InputError("--best and --trial name different models", hint="give one of them")
    if not best and name is None:
        if results is not None:
            raise InputError("--results goes with --best or --trial", hint="name the sweep's folder with -o")
        return output or DEFAULT_FOLDER, Path()
    if output is None:
        raise InputError("the model has no file to go to", hint="name its file with -o MODEL.json")
    if output.is_dir():
        raise InputError("the model file is a folder", value=output, hint="name a file, as in -o MODEL.json")
    return results or DEFAULT_FOLDER, output


def _write_model(sets: PixelSets, trial: Trial, path: Path, *, as_json: bool) -> None:
    record = run_trial(sets, trial)
    if record.status == "failed":
        raise InputError(
            "the trial failed", value=f"{trial.name} ({record.error})", hint="choose another one"
        )
    replace(rebuild(sets, trial), colours=seen_colours(sets)).save(path)
    text = (
        f"{path}: trial {trial.name}, accuracy {record.accuracy:.4f} on the held-out images, "
        f"{record.luts} LUTs per pixel, bleaching threshold {record.bleaching}, {record.status}"
    )
    emit(record.to_json() | {"model": str(path)}, text, as_json=as_json)


def _summary(outcome: Outcome, where: Path) -> str:
    data = outcome.to_json()
    lines = [
        f"{where}: {data['trials']:,} trials, {data['saturated']:,} saturated, {data['failed']:,} failed",
        *(
            f"peak at {x['address_bits']} address bits, {x['rams']} RAMs: "
            f"mean accuracy {x['accuracy']:.4f}, {x['luts']:.1f} LUTs"
            for x in data["peaks"][:3]
        ),
        data["reasons"],
        *(
            f"{x.luts:>5} LUTs: accuracy {x.circuit_accuracy:.4f} ({x.name})"
            for x in (*outcome.front, *outcome.search_front)
        ),
    ]
    return "\n".join(lines)
