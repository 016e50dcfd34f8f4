"""What every command prints: progress on stderr, and one JSON object or a text on stdout."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, Task, TextColumn, TimeElapsedColumn
from rich.table import Table

from wnn2hdl.cli.terminal import say
from wnn2hdl.report.baseline import shown_parts
from wnn2hdl.report.page import as_taken

json_option = click.option(
    "--json", "as_json", is_flag=True, help="Print one JSON object on stdout and nothing else."
)


def emit(data: dict[str, Any], text: str, *, as_json: bool) -> None:
    """Print a result: the JSON object, or the text made for people."""
    say(json.dumps(data, indent=1, allow_nan=False) if as_json else text)


@contextmanager
def progress() -> Iterator[Callable[[str, int, int], None]]:
    """A live display on stderr of what is being done; nothing is shown if nothing is reported.

    Yields:
        ``report(step, done, total)``: a step's name and how far it is. Each step has its own line; a step
        that falls back has started again and gets a new line.
    """
    columns = (TextColumn("{task.description:<28}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    console = Console(stderr=True)
    bars = Progress(*columns, TimeElapsedColumn(), console=console)
    running: dict[str, Task] = {}

    def report(step: str, done: int, total: int) -> None:
        if not running:
            # Not before: rich ends a display with an empty line, even one that has shown nothing.
            bars.start()
        if step not in running or done < running[step].completed:
            _make_room(bars, console)
            added = bars.add_task(step, total=total)
            running[step] = next(task for task in bars.tasks if task.id == added)
        bars.update(running[step].id, completed=done, total=total)

    try:
        yield report
    finally:
        if running:
            # Before the lines are shown again, since the display may be drawn between them.
            bars.live.vertical_overflow = "visible"
            for task in bars.tasks:
                bars.update(task.id, visible=True)
            bars.stop()


def _make_room(bars: Progress, console: Console) -> None:
    """Hide the first finished line until the end where a terminal would cut off the last, which runs."""
    shown = [task for task in bars.tasks if task.visible]
    finished = next((task for task in shown if task.finished), None)
    if console.is_terminal and len(shown) >= console.height - 1 and finished:
        bars.update(finished.id, visible=False)


def printed(table: Table) -> str:
    """A table as a terminal shows it, of at most 100 columns and without colours."""
    console = Console(width=100, markup=False, emoji=False)
    with console.capture() as captured:
        console.print(table)
    return captured.get().rstrip()


def parts_table(report: dict[str, Any], folder: Path) -> str:
    """What a build costs and whether it is proved, for a terminal."""
    table = Table(title=f"{report['name']}: {report['target']}, {report['mode']} mode", title_justify="left")
    table.add_column("part")
    columns = {"luts": "LUTs", "muxf7": "MUXF7", "muxf8": "MUXF8", "carry4": "CARRY4"}
    if report["latency"]:
        columns["ffs"] = "FFs"
    columns["delay_ps"] = "delay ps"
    for heading in columns.values():
        table.add_column(heading, justify="right")
    for part, figures in shown_parts(report["parts"]).items():
        table.add_row(part, *("n/a" if figures[key] is None else str(figures[key]) for key in columns))
    proof = report["proof"]
    earlier = f" (before: {', '.join(proof['before'])})" if proof.get("before") else ""
    lines = [printed(table)]
    if report["latency"]:
        stage = f"a stage takes {report['stage_ps']} ps with wires, by the delay model"
        cycles = "1 cycle" if report["latency"] == 1 else f"{report['latency']} cycles"
        lines.append(f"latency: {cycles}; {stage}")
    lines += [
        f"proof: {proof['status']} in {proof['seconds']:.1f} s, {proof['method']}{earlier}",
    ]
    pruned = report["options"].get("pruned")
    if pruned:
        text = f"pruned: {pruned['tables']} of {pruned['of']} tables; the proof is about the pruned model"
        if pruned["rows"] is not None:
            text += f"; {pruned['changed']} of {pruned['rows']} answers change on --prune-table"
        lines.append(text)
    rows, light = report["rows"], report["light"]
    place = as_taken(report)
    over_images = None if place is None else light["curves"]["exposure"][place]["interval"]
    for name, key, span in (
        ("model", "model_accuracy", rows["model_interval"]),
        ("circuit", "accuracy", rows["interval"] or over_images),
    ):
        if report[key] is not None:
            interval = "" if span is None else f" ({span[0]:.2%} to {span[1]:.2%})"
            lines.append(f"accuracy of the {name}: {report[key]:.2%}{interval}")
    if rows["changed"]:
        lines.append(f"{rows['changed']} of {rows['count']} rows are answered differently")
    if light["warning"]:
        lines.append(light["warning"])
    return "\n".join([*lines, f"written to {folder}"])
