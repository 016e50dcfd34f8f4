"""`compile`: a model becomes a build folder."""

from pathlib import Path
from typing import Any, get_args

import click

from wnn2hdl.build.compile import compile_model, require_equal, require_luts, require_proved
from wnn2hdl.build.design import Mode
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import SizeType, allow_unproved_option, file, folder, output_option
from wnn2hdl.cli.output import emit, json_option, parts_table, progress
from wnn2hdl.cli.pictures import (
    MASKS,
    READING,
    alpha_option,
    bands_option,
    ignore_option,
    palette_option,
    scale_option,
)
from wnn2hdl.cli.vectors import label_option, most_changed_option, raw_option
from wnn2hdl.ir import Style, VideoFormat
from wnn2hdl.ir.models import load_model
from wnn2hdl.ir.video import FORMATS, MAX_SQUARE, MAX_WIDTH, PIXELS_PER_CLOCK, Answer
from wnn2hdl.lower.targets import TARGETS
from wnn2hdl.schedule import MAX_STAGES

SECTIONS = {
    "Circuit": (
        "--target",
        "--name",
        "--input",
        "--mode",
        "--care",
        "--care-min",
        "--stages",
        "--clock",
        "--max-width",
        "--pixels-per-clock",
        "--format",
        "--answer",
        "--square",
        "--style",
        "--effort",
    ),
    "Checks": ("--max-luts", "--allow-unproved"),
    "Edge filter": ("--edges", "--edge-images", "--edge-patterns", "--edge-luts"),
    "Match engine": ("--template", "--segment", "--frames-per-second"),
    "Pictures": ("--test-images", "--test-masks", *MASKS, *READING),
    "Feature vectors": ("--prune", "--prune-table", "--most-changed", "--test-table", "--label", "--raw"),
}


@app.command("compile", sections=SECTIONS)
@click.argument("model", type=file)
@output_option("Write the build here, as in build/NAME.", required=True)
@click.option(
    "--target",
    type=click.Choice(list(TARGETS)),
    metavar="TARGET",
    help=f"Compile this: {', '.join(TARGETS)}.  [default: by the model]",
)
@click.option(
    "--name",
    help="Begin module names so.  [default: the folder's name]",
)
@click.option(
    "--input",
    metavar="FORMAT",
    help="Read words, as in Q3.12.  [default: the model's]",
)
@click.option(
    "--mode",
    type=click.Choice(get_args(Mode)),
    metavar="MODE",
    default="exact",
    show_default=True,
    help="Be exact, or equal on --care (domain).",
)
@click.option("--care", type=folder, help="Take the care set of domain mode from this imagery.")
@click.option(
    "--care-min",
    type=click.IntRange(min=1),
    metavar="N",
    default=1,
    show_default=True,
    help="Care for codes so frequent.",
)
@click.option(
    "--edges",
    default="boundary",
    metavar="NAME|FILE",
    help="Use half-plane, learned or a file, not boundary.",
)
@click.option("--edge-images", type=folder, help="Learn from this imagery.  [default: --care]")
@click.option(
    "--edge-patterns",
    type=click.IntRange(1, 510),
    metavar="N",
    default=75,
    show_default=True,
    help="Learn N patterns.",
)
@click.option(
    "--edge-luts",
    type=click.IntRange(1, 3),
    metavar="N",
    help="Learn only filters of at most N LUTs.",
)
@click.option(
    "--stages",
    type=click.IntRange(1, MAX_STAGES),
    metavar="N",
    help="Make a pipeline: N stages, latency N cycles.",
)
@click.option(
    "--clock",
    type=FiniteRange(min=0, min_open=True),
    metavar="MHZ",
    help="Make as few stages as this clock allows.",
)
@click.option(
    "--style",
    type=click.Choice(get_args(Style)),
    metavar="STYLE",
    default="cells",
    show_default=True,
    help="Write LUTs as cells, or as equations.",
)
@click.option(
    "--effort",
    type=click.IntRange(0, 3),
    metavar="N",
    default=1,
    show_default=True,
    help="Set the search effort.",
)
@click.option(
    "--max-width",
    type=click.IntRange(2, MAX_WIDTH),
    metavar="N",
    default=VideoFormat.max_width,
    show_default=True,
    help="Take video of N columns.",
)
@click.option(
    "--pixels-per-clock",
    type=click.Choice(PIXELS_PER_CLOCK),
    metavar="N",
    default=VideoFormat.pixels_per_clock,
    show_default=True,
    help="Take 1, 2 or 4 pixels of video at once.",
)
@click.option(
    "--format",
    type=click.Choice(FORMATS),
    metavar="ORDER",
    default=VideoFormat.format,
    show_default=True,
    help="Take video so, low byte first; or mono.",
)
@click.option(
    "--answer",
    type=click.Choice(get_args(Answer)),
    metavar="KIND",
    default=VideoFormat.answer,
    show_default=True,
    help="Send class, edge or both of video.",
)
@click.option(
    "--square",
    type=click.IntRange(2, MAX_SQUARE),
    metavar="N",
    help="Also send the majorities of NxN squares.",
)
@click.option("--template", type=SizeType(), help="Make an engine for templates of this size.")
@click.option("--segment", type=SizeType(), help="Let it look for them in segments of this size.")
@click.option(
    "--frames-per-second",
    type=FiniteRange(min=0, min_open=True),
    metavar="N",
    help="Let it match N templates per second.",
)
@click.option("--test-images", type=folder, help="Measure the report's accuracies on these pictures.")
@click.option("--test-masks", type=folder, help="Find the masks of --test-images in this folder.")
@click.option("--prune", is_flag=True, help="Leave out tables of a network that change no answer.")
@click.option("--prune-table", type=file, help="Also those that hardly change this table's answers.")
@most_changed_option
@click.option("--test-table", type=file, help="Measure accuracies on this CSV or .npz file.")
@label_option
@raw_option
@palette_option
@ignore_option
@bands_option
@scale_option
@alpha_option
@click.option(
    "--max-luts", type=click.IntRange(min=0), metavar="N", help="Fail if the whole target takes more LUTs."
)
@allow_unproved_option
@json_option
def compile_command(
    model: Path,
    output: Path,
    allow_unproved: tuple[str, ...],
    as_json: bool,
    **choices: Any,
) -> None:
    """Compile MODEL to Verilog, prove that it equals the model, and count its LUTs.

    \b
    Examples:
      wnn2hdl compile model.json --mode domain --care IMAGES -o build/mine
      wnn2hdl compile model.json --target video -o build/core
    """
    options = CompileOptions(care_minimum=choices.pop("care_min"), **choices)
    with progress() as report:
        build = compile_model(load_model(model), output, options, report)
    lines = [parts_table(build.report, build.folder)]
    for pictures, share in build.report["options"]["left_out"].items():
        if share:
            option = pictures.replace("_", "-")
            lines.append(f"{share:.2%} of the pixels of --{option} left out: not labelled, or no data")
    if unproved := build.report["proof"]["unproved"]:
        lines.append(f"UNPROVED: {', '.join(unproved)}")
    emit(build.report, "\n".join(lines), as_json=as_json)
    require_equal(build)
    require_proved(build.report["proof"]["unproved"], allow_unproved)
    if options.max_luts is not None:
        require_luts(build, options.max_luts)
