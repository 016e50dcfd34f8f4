"""`scan`: maps of deforestation from imagery of any size."""

import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, get_args

import click

from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.apps.deforestation.cleanup import MinimumSize
from wnn2hdl.apps.deforestation.distributed import run_distributed
from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.options import ScanOptions, Vector
from wnn2hdl.apps.deforestation.scanning import Scanner
from wnn2hdl.cli.finite import FiniteRange, SpanType
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import (
    file,
    jobs_option,
    output_option,
    scheduler_option,
    seed_option,
    share_option,
    square_option,
)
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import READING, SCALE_EXAMPLE, BandsType, reading_options
from wnn2hdl.cli.terminal import say
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Reading
from wnn2hdl.tools import cores

SECTIONS = {
    "Classification": ("--square", "--share", "--seed", "--smooth", "--min-area", "--min-pixels"),
    "Pictures": (*READING, "--exclude"),
    "Change since an earlier date": ("--before", "--before-bands", "--before-scale", "--before-exclude"),
}


@app.command("scan", sections=SECTIONS)
@click.argument("model", type=click.Path(exists=True, path_type=Path))
@click.argument("picture", metavar="INPUT", type=click.Path(exists=True, path_type=Path))
@output_option("Write into this folder.", required=True)
@square_option("Let the pixels of squares of this side vote.")
@share_option
@seed_option
@click.option(
    "--smooth",
    type=click.IntRange(0, 100),
    metavar="PIXELS",
    default=0,
    show_default=True,
    help="Smooth by a majority filter.",
)
@click.option(
    "--min-area",
    type=FiniteRange(0, min_open=True),
    metavar="HECTARES",
    help="Dissolve regions of a smaller area.",
)
@click.option(
    "--min-pixels", type=click.IntRange(min=2), metavar="N", help="Dissolve regions of fewer pixels."
)
@reading_options
@click.option("--exclude", type=file, help="Leave out pixels that are not 0 in this raster.")
@click.option("--before", type=file, help="Map what was cleared since this picture.")
@click.option("--before-bands", type=BandsType(), help="Choose its bands.  [default: --bands]")
@click.option(
    "--before-scale", type=SpanType(SCALE_EXAMPLE), help="Map its values to 0 and 255.  [default: --scale]"
)
@click.option("--before-exclude", type=file, help="Leave out its pixels that are not 0 in this raster.")
@click.option(
    "--vector",
    type=click.Choice(get_args(Vector)),
    default="geojson",
    show_default=True,
    help="Write polygons in this format.",
)
@jobs_option("windows")
@scheduler_option
@json_option
def scan_command(
    model: Path,
    picture: Path,
    output: Path,
    square: int | None,
    share: float,
    seed: int,
    smooth: int,
    min_area: float | None,
    min_pixels: int | None,
    reading: Reading,
    exclude: Path | None,
    before: Path | None,
    before_bands: tuple[int, ...] | None,
    before_scale: tuple[float, float] | None,
    before_exclude: Path | None,
    vector: Vector,
    jobs: int | None,
    scheduler: str | None,
    as_json: bool,
) -> None:
    """Map deforestation in INPUT, a picture, GeoTIFF or folder of them, with MODEL.

    MODEL is a model file, or a build folder, whose circuit then answers, bit by bit. Written are classes.tif,
    polygons, overlay.png, and a summary as a page, as Markdown and as JSON. The same command continues where
    an interrupted one stopped.

    \b
    Examples:
      wnn2hdl scan build/mine sentinel.tif --bands 3,2,1 --scale 0..3000 --exclude clouds.tif -o build/map
      wnn2hdl scan model.json 2024.tif --before 2023.tif --min-area 1 --vector gpkg -o build/change
    """
    if min_area is not None and min_pixels is not None:
        raise InputError("--min-area and --min-pixels limit the same regions", hint="give one of them")
    if not before and (before_bands or before_scale or before_exclude):
        raise InputError(
            "--before-bands, --before-scale and --before-exclude say how --before is read",
            hint="give --before",
        )
    if scheduler and jobs:
        raise InputError("--jobs is for this machine, --scheduler for others", hint="give one of them")
    options = ScanOptions(
        replace(reading, exclude=exclude),
        Method(square, share, seed, smooth),
        MinimumSize(min_pixels or 0, min_area or 0) if min_pixels or min_area else None,
        vector,
    )
    run = partial(run_distributed, scheduler) if scheduler else partial(run_locally, jobs or cores())
    with progress() as report:
        started = time.perf_counter()
        earlier = Reading(before_bands, before_scale, exclude=before_exclude)
        summary = Scanner.open(model, options, run, report).scan(picture, output, before, earlier)
        seconds = time.perf_counter() - started
    for warning in summary["warnings"]:
        say(f"wnn2hdl: warning: {warning}", error=True)
    # Not in the summary's file: the same scan is to write the same bytes.
    speed = {"seconds": seconds, "megapixels_per_second": summary["pixels"] / seconds / 1e6}
    emit(summary | speed | {"output": str(output)}, _text(summary | speed, output), as_json=as_json)


def _text(summary: dict[str, Any], output: Path) -> str:
    lines = [_line(summary["input"], summary["deforested"], "deforested")]
    if "change" in summary:
        lines.append(_line(f"since {summary['before']}", summary["change"]["newly_cleared"], "newly cleared"))
    shared = summary["overlap"]["pixels"] if "overlap" in summary else 0
    left_out = 1 - (summary["classified_pixels"] + shared) / summary["pixels"]
    if left_out:
        lines.append(f"{left_out:.2%} of the pixels left out: no data, or excluded")
    known = summary["coverage"]["share"]
    lines.append(
        f"{'none' if known is None else format(known, '.2%')} of the pixels have colours the model knows; "
        f"{summary['seconds']:.1f} s, {summary['megapixels_per_second']:.1f} megapixels per second"
    )
    return "\n".join([*lines, f"written to {output}"])


def _line(what: str, figures: dict[str, Any], verb: str) -> str:
    share = "none" if figures["share"] is None else f"{figures['share']:.2%}"
    hectares = "" if figures["hectares"] is None else f", {figures['hectares']:,.2f} ha"
    return f"{what}: {share} {verb}{hectares}"
