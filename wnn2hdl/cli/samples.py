"""`samples`: the embedded landscapes as files, for first steps without imagery of one's own."""

from pathlib import Path

import click

from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import SAMPLE_IMAGES, SAMPLE_SIDE, folder, seed_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.pipeline.landscapes import IMAGES, KINDS, MASKS, PALETTE, write_landscapes


@app.command("samples")
@click.option("--images", "count", type=click.IntRange(min=1), default=SAMPLE_IMAGES, show_default=True)
@click.option(
    "--side",
    type=click.IntRange(min=1),
    default=SAMPLE_SIDE,
    show_default=True,
    help="Height and width in pixels.",
)
@seed_option
@click.option("-o", "output", type=folder, required=True, help="The folder to write into.")
@json_option
def samples_command(count: int, side: int, seed: int, output: Path, as_json: bool) -> None:
    """Write generated landscapes, with masks of two classes and of all kinds of ground.

    \b
    Examples:
      wnn2hdl samples -o build/samples
      wnn2hdl train --images build/samples/images --masks build/samples/masks -o build/model.json
      wnn2hdl train --images build/samples/images --masks build/samples/kinds \\
                    --palette build/samples/palette.json -o build/kinds.json
    """
    with progress() as report:
        write_landscapes(output, count, side, seed=seed, progress=report)
    data = {"folder": str(output), "images": count, "side": side, "seed": seed}
    parts = ", ".join((IMAGES, MASKS, KINDS, PALETTE))
    emit(data, f"{count} landscapes of {side}x{side} pixels in {output}: {parts}", as_json=as_json)
