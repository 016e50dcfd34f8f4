"""`demo`: everything on the embedded default."""

from pathlib import Path

import click

from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import folder, seed_option
from wnn2hdl.cli.output import emit, json_option, parts_table, progress
from wnn2hdl.errors import CheckError
from wnn2hdl.pipeline.demo import run_demo


@app.command("demo")
@click.option("-o", "output", type=folder, default=Path("build/demo"), show_default=True)
@seed_option
@json_option
def demo_command(output: Path, seed: int, as_json: bool) -> None:
    """Landscapes to proved Verilog: generate, train, compile, simulate, without a file of yours."""
    with progress() as report:
        demo = run_demo(output, seed, report)
    data = {
        "reference": demo.reference.report,
        "smallest": demo.smallest.report,
        "windows": demo.playback.windows,
        "pictures": [str(path) for path in demo.pictures],
    }
    text = "\n\n".join(
        [
            parts_table(demo.reference.report, demo.reference.folder),
            parts_table(demo.smallest.report, demo.smallest.folder),
            f"{demo.playback.windows:,} windows of a landscape ran through the smallest circuit; see "
            + ", ".join(str(path) for path in demo.pictures),
        ]
    )
    emit(data, text, as_json=as_json)
    for build in (demo.reference, demo.smallest):
        if build.failure is not None:
            raise CheckError("the circuit is not the model", value=build.failure, mend=f"see {build.folder}")
