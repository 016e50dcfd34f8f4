"""`doctor`: which tools are here, which are missing, and how to get them."""

from dataclasses import asdict
from shutil import get_terminal_size

from rich.console import Console
from rich.table import Table

from wnn2hdl.cli.main import app
from wnn2hdl.cli.output import emit, json_option
from wnn2hdl.errors import CheckError
from wnn2hdl.tools.inventory import Part, inventory


@app.command("doctor")
@json_option
def doctor_command(as_json: bool) -> None:
    """Show which tools are found, which are missing, and how to install them.

    The exit status is 1 if a tool is missing that `compile` needs; the others are optional.

    \b
    Examples:
      wnn2hdl doctor
      wnn2hdl doctor --json | jq '.parts[] | select(.found == null) | .hint'
    """
    parts = tuple(inventory())
    lacking = [part for part in parts if part.needed and part.found is None]
    data = {"healthy": not lacking, "parts": [asdict(part) for part in parts]}
    emit(data, _table(parts), as_json=as_json)
    if lacking:
        raise CheckError(
            "a tool is missing that compiling needs", value=lacking[0].name, hint=lacking[0].hint or ""
        )


def _table(parts: tuple[Part, ...]) -> str:
    table = Table("", "tool", "what for", box=None, header_style="bold")
    table.add_column("found, or how to get it", overflow="fold")
    for part in parts:
        mark = "ok" if part.found else "MISSING" if part.needed else "-"
        table.add_row(mark, part.name, part.purpose, part.found or f"{part.fault}; {part.hint}")
    console = Console(width=get_terminal_size((140, 24)).columns, markup=False)
    with console.capture() as captured:
        console.print(table)
    return "\n".join(line.rstrip() for line in captured.get().splitlines())
