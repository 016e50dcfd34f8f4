"""`samples`: the embedded landscapes and the embedded flight as files, for first steps without data."""

from pathlib import Path

import click

from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import output_option, seed_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.dataset import SAMPLE_IMAGES, SAMPLE_SIDE
from wnn2hdl.progress import Progress, reported
from wnn2hdl.samples.flight import FULL_MAP, make_flight, write_flight
from wnn2hdl.samples.landscapes import IMAGES, KINDS, MASKS, PALETTE, write_landscapes

FRAMES = 35
"""As many as the reference design's flight had."""


@app.command("samples")
@click.option("--flight", is_flag=True, help="Write a flight over a map instead of landscapes.")
@click.option(
    "--count",
    type=click.IntRange(min=1),
    metavar="N",
    help=f"Write this many landscapes, or frames.  [default: {SAMPLE_IMAGES}; of a flight {FRAMES}]",
)
@click.option(
    "--side",
    type=click.IntRange(min=1),
    metavar="PIXELS",
    help="Make landscapes, or the flight's map, this high and wide.  "
    f"[default: {SAMPLE_SIDE}; of a map {FULL_MAP[0]} and {FULL_MAP[1]}]",
)
@seed_option
@output_option("Write into this folder.", required=True)
@json_option
def samples_command(
    flight: bool, count: int | None, side: int | None, seed: int, output: Path, as_json: bool
) -> None:
    """Write generated landscapes with masks of two classes and of all kinds of ground, or a flight.

    The flight leads over generated country: a map of 0.5 m per pixel, frames in the light of another season,
    tilted by wind, and their poses, exact to 1 cm. The full map takes a minute and 1 GB of memory.

    \b
    Examples:
      wnn2hdl samples -o build/samples
      wnn2hdl samples --flight --side 1500 --count 12 -o build/country
    """
    with progress() as report:
        if flight:
            shape = (side, side) if side else FULL_MAP
            count = count or FRAMES
            _write_flight(output, count, shape, seed, report)
        else:
            shape = (side or SAMPLE_SIDE, side or SAMPLE_SIDE)
            count = count or SAMPLE_IMAGES
            write_landscapes(output, count, shape[0], seed=seed, progress=report)
    size = f"{shape[0]}x{shape[1]} pixels"
    if flight:
        text = f"{count} frames over a map of {size} in {output}: map.tif, frames, poses.csv, camera.toml"
    else:
        text = f"{count} landscapes of {size} in {output}: {', '.join((IMAGES, MASKS, KINDS, PALETTE))}"
    data = {"folder": str(output), "images": count, "height": shape[0], "width": shape[1], "seed": seed}
    emit(data, text, as_json=as_json)


def _write_flight(output: Path, frames: int, shape: tuple[int, int], seed: int, report: Progress) -> None:
    report("generating country", 0, 1)
    made = make_flight(seed, shape, frames=frames)
    report("generating country", 1, 1)
    # Besides the frames: map, poses and camera.
    for _ in reported(write_flight(output, made), "writing files", frames + 3, report):
        pass
