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
from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import file, folder, seed_option, share_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import BandsType, ScaleType, reading_options
from wnn2hdl.cli.terminal import say
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.squares import MAX_SIDE
from wnn2hdl.raster import Reading
from wnn2hdl.tools import cores


@app.command("scan")
@click.argument("model", type=click.Path(exists=True, path_type=Path))
@click.argument("picture", metavar="INPUT", type=click.Path(exists=True, path_type=Path))
@click.option("-o", "output", type=folder, required=True, help="The folder to write into.")
@click.option(
    "--square",
    type=click.IntRange(1, MAX_SIDE),
    help="Let squares of this side vote.  [default: each pixel alone]",
)
@share_option
@seed_option
@click.option(
    "--smooth",
    type=click.IntRange(0, 100),
    default=0,
    show_default=True,
    help="Radius in pixels of a majority filter.",
)
@click.option(
    "--minimum-area", type=FiniteRange(0, min_open=True), help="Dissolve smaller regions, in hectares."
)
@click.option("--minimum-pixels", type=click.IntRange(min=2), help="The same, in pixels.")
@reading_options
@click.option(
    "--mask", type=file, help="A raster of INPUT's size; where it is not 0, INPUT is left out (clouds)."
)
@click.option("--before", type=file, help="The same area at an earlier date: maps what was cleared since.")
@click.option("--before-bands", type=BandsType(), help="Bands of --before.  [default: those of --bands]")
@click.option(
    "--before-scale", type=ScaleType(), help="Values of --before that become 0 and 255.  [default: --scale]"
)
@click.option("--before-mask", type=file, help="As --mask, of the picture of --before.")
@click.option(
    "--vector",
    type=click.Choice(get_args(Vector)),
    default="geojson",
    show_default=True,
    help="Format of polygons.",
)
@click.option("--jobs", type=click.IntRange(min=1), help="Threads.  [default: one a core]")
@click.option("--scheduler", metavar="ADDRESS", help="Run on this Dask scheduler, as in tcp://host:8786.")
@json_option
def scan_command(
    model: Path,
    picture: Path,
    output: Path,
    square: int | None,
    share: float,
    seed: int,
    smooth: int,
    minimum_area: float | None,
    minimum_pixels: int | None,
    reading: Reading,
    mask: Path | None,
    before: Path | None,
    before_bands: tuple[int, ...] | None,
    before_scale: tuple[float, float] | None,
    before_mask: Path | None,
    vector: Vector,
    jobs: int | None,
    scheduler: str | None,
    as_json: bool,
) -> None:
    """Map deforestation in INPUT, a picture, GeoTIFF or folder of them, with MODEL.

    MODEL is a model file, or a build folder: then its circuit answers, bit by bit. OUTPUT gets classes.tif,
    polygons, overlay.png, summary.json and summary.md. The same command goes on where a killed one stopped.

    \b
    Examples:
      wnn2hdl scan model.json earth.jpg --square 20 -o build/earth
      wnn2hdl scan build/mine sentinel.tif --bands 3,2,1 --scale 0:3000 --mask clouds.tif -o build/map
      wnn2hdl scan model.json 2024.tif --before 2023.tif --minimum-area 1 --vector gpkg -o build/change
    """
    if minimum_area is not None and minimum_pixels is not None:
        raise InputError("--minimum-area and --minimum-pixels say the same", hint="give one of them")
    if not before and (before_bands or before_scale or before_mask):
        raise InputError(
            "--before-bands, --before-scale and --before-mask say how --before is read", hint="give --before"
        )
    if scheduler and jobs:
        raise InputError("--jobs is for this machine, --scheduler for others", hint="give one of them")
    options = ScanOptions(
        replace(reading, mask=mask),
        Method(square, share, seed, smooth),
        MinimumSize(minimum_pixels or 0, minimum_area or 0) if minimum_pixels or minimum_area else None,
        vector,
    )
    run = partial(run_distributed, scheduler) if scheduler else partial(run_locally, jobs or cores())
    with progress() as report:
        started = time.perf_counter()
        earlier = Reading(before_bands, before_scale, mask=before_mask)
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
        lines.append(f"{left_out:.2%} of the pixels left out: no data, or masked")
    known = summary["coverage"]["share"]
    lines.append(
        f"{'none' if known is None else format(known, '.2%')} of the pixels have colours the model knows; "
        f"{summary['seconds']:.1f} s, {summary['megapixels_per_second']:.1f} megapixels a second"
    )
    return "\n".join([*lines, f"written to {output}"])


def _line(what: str, figures: dict[str, Any], verb: str) -> str:
    share = "none" if figures["share"] is None else f"{figures['share']:.2%}"
    hectares = "" if figures["hectares"] is None else f", {figures['hectares']:,.2f} ha"
    return f"{what}: {share} {verb}{hectares}"
