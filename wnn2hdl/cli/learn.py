"""`train`: models from labelled images, or from tables of feature vectors."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from wnn2hdl.cli.front import Candidate, save_front
from wnn2hdl.cli.learned import train_sentence, train_summary
from wnn2hdl.cli.luts import OPTIONS as LUT_NETWORK
from wnn2hdl.cli.luts import (
    distort_option,
    epochs_option,
    luts_sentence,
    max_luts_option,
    train_luts_on_table,
)
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import (
    BleachingType,
    bits_option,
    file,
    folder,
    images_option,
    labelled,
    masks_option,
    output_option,
    refuse,
    seed_option,
    spoken_command,
)
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import MASKS, READING, mask_options, reading_options
from wnn2hdl.cli.vectors import (
    TRAINING,
    WISARD,
    cross_validate_option,
    label_option,
    levels_option,
    mapping_option,
    table_option,
    table_sentence,
    thermometer_option,
    train_on_table,
    words_option,
)
from wnn2hdl.encode import Spacing
from wnn2hdl.errors import InputError
from wnn2hdl.files import held, make_folder
from wnn2hdl.images import MaskFormat
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.context import SIZES
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.ir.models.wisard import MAX_ADDRESS_BITS
from wnn2hdl.raster import Reading
from wnn2hdl.training.budget import ADDRESS_BITS, RAMS, Point, measure, pareto_front
from wnn2hdl.training.discriminators import with_colours
from wnn2hdl.training.tables import TableOptions


@dataclass(frozen=True)
class Discriminators:
    """Options that fix the discriminators; None where the option was left out."""

    bits: str | None
    address_bits: int | None
    rams: int | None
    bleach: int | str | None
    balance: bool | None

    def require_none(self, because: str) -> None:
        """Refuse options that would have no effect."""
        given = [f"--{name.replace('_', '-')}" for name, value in vars(self).items() if value is not None]
        if given:
            raise InputError(
                f"{because} chooses the classifier itself",
                value=" ".join(given),
                hint="leave these options out",
            )


IMAGES = ("--images", "--masks", *MASKS, *READING, "--regions", "--chips")
OTHERS = ("--luts-per-pixel", "--nested", "--neighbourhood", "--context", "--pareto", "--trials")

DISCRIMINATORS = ("--bits", "--address-bits", "--rams", "--bleach", "--balance")

SECTIONS = {
    "Images and labels": IMAGES,
    "Other classifiers": (*LUT_NETWORK, *OTHERS),
    "Discriminators": DISCRIMINATORS,
    "Feature vectors": TRAINING,
}


@app.command("train", sections=SECTIONS)
@images_option
@masks_option
@mask_options
@reading_options
@click.option("--regions", type=file, help="Read chip,label,x,y,width,height from this CSV.")
@click.option("--chips", type=folder, help="Find the chips of --regions in this folder.")
@table_option
@label_option
@thermometer_option
@levels_option
@words_option
@mapping_option
@cross_validate_option
@max_luts_option
@epochs_option
@distort_option
@bits_option
@click.option(
    "--address-bits",
    type=click.IntRange(1, MAX_ADDRESS_BITS),
    metavar="N",
    help="Set the address bits of a RAM.  [default: 4; tables: 6]",
)
@click.option(
    "--rams",
    type=click.IntRange(min=1),
    metavar="N",
    help="Set a discriminator's RAMs.  [default: 16; tables: to read all bits]",
)
@click.option(
    "--bleach",
    type=BleachingType(),
    help="Set the bleaching threshold.  [default: auto]",
)
@click.option(
    "--balance", is_flag=True, default=None, help="Weigh all classes equally, so that rare ones are found."
)
@click.option(
    "--luts-per-pixel",
    type=click.IntRange(min=1),
    metavar="N",
    help="Find the best of at most N LUTs per pixel.",
)
@click.option("--nested", is_flag=True, help="State its accuracy by choosing it once more inside each fold.")
@click.option(
    "--neighbourhood",
    type=click.Choice(["3", "5"]),
    help="Classify pixels by the 3x3 or 5x5 around them.",
)
@click.option(
    "--context",
    type=click.Choice([str(size) for size in SIZES]),
    help="Classify pixels by counts in the NxN around them.",
)
@click.option("--pareto", is_flag=True, help="Write each best model by LUTs and accuracy.")
@click.option(
    "--trials",
    type=click.IntRange(min=0),
    metavar="N",
    default=20,
    show_default=True,
    help="Try N random mappings of each.",
)
@seed_option
@output_option("Write the model to this file.", is_file=True, required=True)
@json_option
def train_command(
    images: Path | None,
    masks: Path | None,
    mask_format: MaskFormat | None,
    reading: Reading,
    regions: Path | None,
    chips: Path | None,
    table: Path | None,
    label: str | None,
    max_luts: int | None,
    epochs: int | None,
    distort: int,
    luts_per_pixel: int | None,
    nested: bool,
    neighbourhood: str | None,
    context: str | None,
    pareto: bool,
    trials: int,
    seed: int,
    output: Path,
    as_json: bool,
    thermometer: Spacing,
    levels: int,
    words: FixedPoint | None,
    mapping: str,
    seeds: int,
    **discriminators: Any,
) -> None:
    """Train a classifier of pixels on labelled images, or of feature vectors on a table.

    \b
    Examples:
      wnn2hdl train --images IMAGES --masks MASKS -o model.json
      wnn2hdl train --table data.csv --label COLUMN --levels 16 -o model.json
    """
    if table is not None and max_luts is not None:
        pictures = tuple(option for option in OTHERS if option != "--pareto")
        refuse((*IMAGES, *pictures, *DISCRIMINATORS, *WISARD), "--max-luts trains no discriminators")
        network = partial(
            train_luts_on_table,
            table,
            label,
            max_luts=max_luts,
            levels=levels,
            words=words,
            epochs=epochs,
            distort=distort,
            pareto=pareto,
            seed=seed,
        )
        _train_on_table(network, luts_sentence, output, as_json=as_json)
        return
    refuse(LUT_NETWORK, "networks of look-up tables are trained with both --table and --max-luts")
    if table is not None:
        refuse((*IMAGES, *OTHERS, "--bits", "--balance"), "a table has no pictures")
        bleach = discriminators["bleach"]
        options = TableOptions(
            levels=levels,
            thermometer=thermometer,
            words=words,
            address_bits=discriminators["address_bits"] or TableOptions.address_bits,
            rams=discriminators["rams"],
            per_class=mapping == "per-class",
            bleaching=bleach if isinstance(bleach, int) else None,
        )
        wisard = partial(train_on_table, table, label, options, seed=seed, seeds=seeds)
        _train_on_table(wisard, table_sentence, output, as_json=as_json)
        return
    # Not at the top: the functions for Python load what tables need not wait for.
    from wnn2hdl.api import train

    refuse(TRAINING, "only a table has feature vectors, and none is given with --table")
    dataset = labelled(
        images, masks, regions=regions, chips=chips, mask_format=mask_format, reading=reading, seed=seed
    )
    chosen = Discriminators(**discriminators)
    if context is not None:
        refuse(("--luts-per-pixel", "--neighbourhood", "--pareto"), "--context chooses the classifier itself")
    if luts_per_pixel is None or neighbourhood is not None or pareto:
        refuse(("--nested",), "only a choice within --luts-per-pixel is nested")
    if not pareto and (luts_per_pixel is None or neighbourhood is not None):
        refuse(("--trials",), "random mappings are tried within --luts-per-pixel and for --pareto only")
    # Before the training, so that a place that cannot be written is reported at once.
    make_folder(output.parent)
    points: tuple[Point, ...] = ()
    with held(output, "model"), progress() as report:
        if pareto:
            chosen.require_none("--pareto")
            if neighbourhood is not None:
                raise InputError("--pareto compares pixel classifiers", hint="leave --neighbourhood out")
            points = measure(
                dataset, trials=trials, seed=seed, progress=report, luts_per_pixel=luts_per_pixel
            )
            model = max(pareto_front(points), key=lambda point: point.accuracy).model
            model = with_colours(model, dataset, report)
        else:
            choices = {
                "--neighbourhood": neighbourhood,
                "--context": context,
                "--luts-per-pixel": luts_per_pixel,
            }
            for option, given in choices.items():
                if given is not None:
                    chosen.require_none(option)
            trained = train(
                dataset,
                luts_per_pixel=luts_per_pixel,
                nested=nested,
                neighbourhood=None if neighbourhood is None else int(neighbourhood),
                context=None if context is None else int(context),
                bits=chosen.bits,
                address_bits=chosen.address_bits or ADDRESS_BITS,
                rams=chosen.rams or RAMS,
                bleaching=chosen.bleach if isinstance(chosen.bleach, int) else None,
                balanced=bool(chosen.balance),
                trials=trials,
                seed=seed,
                progress=report,
            ).model
            assert isinstance(trained, WisardModel)
            model = trained
        command = spoken_command({"output", "as_json"})
        model = replace(model, training={**model.training, COMMAND: command})
        model.save(output)
        summary = train_summary(model, output, len(dataset))
        if pareto:
            candidates = [
                Candidate(
                    point.luts, point.accuracy, point.method, replace(point.model, colours=model.colours)
                )
                for point in points
            ]
            summary["front"] = save_front(candidates, output)
    emit(summary, train_sentence(summary), as_json=as_json)


def _train_on_table(
    train: Callable[..., dict[str, Any]],
    sentence: Callable[[dict[str, Any]], str],
    output: Path,
    *,
    as_json: bool,
) -> None:
    """Train, and say what came of it.

    Args:
        train: takes the command that trains, the place of the model and the progress.
        sentence: says in words what it returns.
        output: where the model goes.
        as_json: say it as JSON instead.
    """
    make_folder(output.parent)
    command = spoken_command({"output", "as_json"})
    with held(output, "model"), progress() as report:
        summary = train(command=command, output=output, progress=report)
    emit(summary, sentence(summary), as_json=as_json)
