"""What every command prints: progress on stderr, and one JSON object or a text on stdout."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

Command = Callable[..., Any]

json_option = click.option(
    "--json", "as_json", is_flag=True, help="Print one JSON object on stdout and nothing else there."
)


def emit(data: dict[str, Any], text: str, *, as_json: bool) -> None:
    """Print a result: the JSON object, or the text made for people."""
    click.echo(json.dumps(data, indent=1, allow_nan=False) if as_json else text)


@contextmanager
def progress() -> Iterator[Callable[[str, int, int], None]]:
    """A live display on stderr of what is being done.

    Yields:
        ``report(step, done, total)``: a step's name and how far it is; each step keeps its own line.
    """
    columns = (TextColumn("{task.description:<28}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True)) as bars:
        tasks: dict[str, Any] = {}

        def report(step: str, done: int, total: int) -> None:
            if step not in tasks:
                tasks[step] = bars.add_task(step, total=total)
            bars.update(tasks[step], completed=done, total=total)

        yield report


def parts_table(report: dict[str, Any], folder: Path) -> str:
    """What a build costs and whether it is proved, for a terminal."""
    table = Table(title=f"{report['name']}: {report['target']}, {report['mode']} mode", title_justify="left")
    table.add_column("part")
    columns = {"luts": "LUTs", "muxf7": "MUXF7", "muxf8": "MUXF8", "carry4": "CARRY4", "delay_ps": "delay ps"}
    for heading in columns.values():
        table.add_column(heading, justify="right")
    for part, figures in report["parts"].items():
        if figures["luts"] is not None:
            table.add_row(part, *("n/a" if figures[key] is None else str(figures[key]) for key in columns))
    console = Console(width=100)
    with console.capture() as captured:
        console.print(table)
    proof = report["proof"]
    lines = [
        captured.get().rstrip(),
        f"proof: {proof['status']} in {proof['seconds']:.1f} s, {proof['method']}",
    ]
    for name in ("model", "circuit"):
        accuracy = report["accuracy" if name == "circuit" else "model_accuracy"]
        if accuracy is not None:
            lines.append(f"accuracy of the {name}: {accuracy:.2%}")
    return "\n".join([*lines, f"written to {folder}"])
