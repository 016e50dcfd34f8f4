"""`compile`: a model becomes a build folder."""

from pathlib import Path
from typing import Any, get_args

import click

from wnn2hdl.build.compile import compile_model, require_luts
from wnn2hdl.build.design import Mode
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import file, folder
from wnn2hdl.cli.output import emit, json_option, parts_table, progress
from wnn2hdl.cli.pictures import alpha_option, bands_option, ignore_option, palette_option, scale_option
from wnn2hdl.errors import CheckError
from wnn2hdl.ir import Style
from wnn2hdl.ir.models import load_model
from wnn2hdl.lower.targets import TARGETS


@app.command("compile")
@click.argument("model", type=file)
@click.option("-o", "output", type=folder, required=True, help="The build folder to write, as in build/NAME.")
@click.option(
    "--target",
    type=click.Choice(list(TARGETS)),
    help="What to compile.  [default: neighbourhood for models that look at neighbours, else block]",
)
@click.option(
    "--name",
    help="What the names of all Verilog modules begin with.  [default: the name of the build folder]",
)
@click.option(
    "--input",
    metavar="Q3.12",
    help="Format of the features that a network reads: whole and fraction bits.  [default: the model's]",
)
@click.option(
    "--mode",
    type=click.Choice(get_args(Mode)),
    default="exact",
    show_default=True,
    help="Equal to the model on every input, or on the codes that occur in --care.",
)
@click.option("--care", type=folder, help="Folder of imagery that makes the care set of domain mode.")
@click.option(
    "--care-min",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="How often a code must occur in it to be cared for.",
)
@click.option(
    "--edges",
    default="boundary",
    show_default=True,
    metavar="boundary|half-plane|learned|FILE",
    help="Pattern set of the edge filter.",
)
@click.option("--edge-images", type=folder, help="Imagery to learn edge patterns from; --care by default.")
@click.option(
    "--edge-patterns",
    type=click.IntRange(1, 510),
    default=75,
    show_default=True,
    help="How many patterns are learned.",
)
@click.option(
    "--edge-luts", type=click.IntRange(1, 3), help="Learn only patterns whose filter fits so many LUTs."
)
@click.option(
    "--style",
    type=click.Choice(get_args(Style)),
    default="cells",
    show_default=True,
    help="Write LUTs as cells, which synthesis keeps, or as equations, which it may restructure.",
)
@click.option(
    "--effort",
    type=click.IntRange(0, 3),
    default=1,
    show_default=True,
    help="How long to look for fewer LUTs.",
)
@click.option("--test-images", type=folder, help="Pictures for the accuracies in the report.")
@click.option("--test-masks", type=folder, help="Masks of --test-images.")
@palette_option
@ignore_option
@bands_option
@scale_option
@alpha_option
@click.option("--max-luts", type=click.IntRange(min=0), help="Fail if the target takes more LUTs.")
@json_option
def compile_command(
    model: Path,
    output: Path,
    max_luts: int | None,
    as_json: bool,
    **choices: Any,
) -> None:
    """Compile MODEL to Verilog, prove that it equals the model, and count its LUTs.

    \b
    Examples:
      wnn2hdl compile model.json -o build/mine
      wnn2hdl compile model.json --mode domain --care IMAGES -o build/mine
      wnn2hdl compile model.json --edges learned --edge-images IMAGES --edge-luts 2 -o build/mine
    """
    options = CompileOptions(care_minimum=choices.pop("care_min"), **choices)
    with progress() as report:
        build = compile_model(load_model(model), output, options, report)
    lines = [parts_table(build.report, build.folder)]
    for pictures, share in build.report["options"]["left_out"].items():
        if share:
            option = pictures.replace("_", "-")
            lines.append(f"{share:.2%} of the pixels of --{option} left out: not labelled, or no data")
    emit(build.report, "\n".join(lines), as_json=as_json)
    if build.failure is not None:
        raise CheckError("the circuit is not the model", value=build.failure, hint=f"see {build.folder}")
    if max_luts is not None:
        require_luts(build, max_luts)
