"""`demo`: everything on the embedded default."""

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from wnn2hdl.build.compile import require_equal
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import output_option, seed_option
from wnn2hdl.cli.output import emit, json_option, parts_table, progress
from wnn2hdl.files import output_folder


@app.command("demo")
@output_option("Write everything into this folder.", default=Path("build/demo"), show_default=True)
@seed_option
@json_option
def demo_command(output: Path, seed: int, as_json: bool) -> None:
    """Run every stage on generated data: a sweep, two circuits, a map, a flight and a page of it all.

    \b
    Examples:
      wnn2hdl demo
      wnn2hdl demo --seed 1 -o build/another
    """
    # Every application; other commands need not wait for them.
    from wnn2hdl.apps.demo import REFERENCE, SMALLEST, run_demo
    from wnn2hdl.apps.navigation.summary import summary

    with output_folder(output, "demo"), progress() as report:
        demo = run_demo(output, seed, report)
    flight = summary(demo.flight) if demo.flight else None
    data = {
        "page": str(demo.page),
        "sweep": demo.outcome.to_json(),
        "reference": demo.reference.report,
        "smallest": demo.smallest.report,
        "windows": demo.windows,
        "scan": demo.scan,
        "flight": flight,
        "missing": demo.missing,
    }
    lines = [
        f"From generated landscapes, two circuits.\nreference: {REFERENCE}\nsmallest: {SMALLEST}",
        parts_table(demo.reference.report, demo.reference.folder),
        parts_table(demo.smallest.report, demo.smallest.folder),
        f"{len(demo.outcome.plan)} circuits trained and costed in a sweep; {demo.windows:,} windows of a "
        "landscape ran through the smallest circuit, all bits right",
    ]
    if demo.scan:
        lines.append(f"a landscape mapped: {demo.scan['deforested']['share']:.1%} deforested")
    if flight:
        lines.append(_flight_table(flight))
    if demo.missing:
        lines.append(f"map and flight were left out: {demo.missing}")
    lines.append(f"Open {demo.page.resolve().as_uri()}")
    emit(data, "\n\n".join(lines), as_json=as_json)
    for build in (demo.reference, demo.smallest):
        require_equal(build)


def _flight_table(flight: dict[str, Any]) -> str:
    table = Table(title=f"flight: mean error of {flight['frames']} frames, m", title_justify="left")
    table.add_column("method")
    for kind in flight["searches"]:
        table.add_column(kind, justify="right")
    for method in flight["methods"]:
        means = (search["methods"][method]["mean_m"] for search in flight["searches"].values())
        table.add_row(method, *("n/a" if mean is None else f"{mean:.1f}" for mean in means))
    console = Console(width=100)
    with console.capture() as captured:
        console.print(table)
    return captured.get().rstrip()
