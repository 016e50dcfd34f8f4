"""`report`: pages about builds, and the gate for a build server."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal, get_args

import click

from wnn2hdl.build.folder import REPORT_HTML, is_build
from wnn2hdl.build.reporting import open_entries
from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import file, output_option
from wnn2hdl.cli.output import emit, json_option
from wnn2hdl.cli.terminal import say
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.files import make_folder, write_text
from wnn2hdl.report import (
    Check,
    Entry,
    Limits,
    gate_json,
    gate_junit,
    gate_markdown,
    index_page,
    is_index,
    read_baseline,
    run_gate,
    write_baseline,
)

Format = Literal["html", "markdown", "json", "junit"]

INDEX = Path("index.html")

_existing = click.Path(exists=True, path_type=Path)


SECTIONS = {
    "Gate": ("--baseline", "--write-baseline", "--max-luts", "--min-accuracy", "--max-regress"),
}


@app.command("report", sections=SECTIONS)
@click.argument("builds", nargs=-1, required=True, metavar="BUILD...", type=_existing)
@click.option(
    "--format",
    "form",
    type=click.Choice(get_args(Format)),
    default="html",
    show_default=True,
    help="Write an index page of the builds, or what the gate found.",
)
@output_option(
    "Write to this file.  [default: index.html beside the first of several BUILDs, else stdout]", is_file=True
)
@click.option(
    "--compare",
    nargs=2,
    type=_existing,
    metavar="A B",
    help="Compare these two of the BUILDs.  [default: two alone]",
)
@click.option("--baseline", type=file, help="Compare with this file of --write-baseline.")
@click.option(
    "--write-baseline", "record", type=file, help="Record the builds as they are, without checking them."
)
@click.option(
    "--max-luts",
    type=click.IntRange(min=0),
    metavar="N",
    help="Fail if the whole target of a build takes more LUTs.",
)
@click.option(
    "--min-accuracy",
    type=FiniteRange(0, 1),
    metavar="SHARE",
    help="Fail if a build is less accurate, as in 0.93.",
)
@click.option(
    "--max-regress",
    type=click.IntRange(min=0),
    metavar="N",
    help="Let parts take this many LUTs more than the baseline.  [default: 0]",
)
@json_option
def report_command(
    builds: tuple[Path, ...],
    form: Format,
    output: Path | None,
    compare: tuple[Path, Path] | None,
    baseline: Path | None,
    record: Path | None,
    max_luts: int | None,
    min_accuracy: float | None,
    max_regress: int | None,
    as_json: bool,
) -> None:
    """Show BUILDs on pages, compare two, and fail where one got worse.

    Each build has its own page, report.html, which is written if it is missing. Among the BUILDs, whatever is
    not a build is skipped, so build/* can be given.

    The gate runs if a limit, a baseline or one of its formats is given. It exits with status 1 if a build is
    not proved, was changed after the proof or breaks a limit; with a baseline, also if a part takes more
    LUTs, the accuracy is lower, or a build or part is missing on one side.

    \b
    Examples:
      wnn2hdl report build/before build/after -o comparison.html
      wnn2hdl report build/* --baseline baseline.json --max-luts 21 --format markdown
    """
    limited = baseline is not None or max_luts is not None or min_accuracy is not None
    if record is not None and (limited or form != "html"):
        raise InputError(
            "--write-baseline takes builds as they are", hint="run the gate in a separate command"
        )
    if max_regress is not None and baseline is None:
        raise InputError("--max-regress is measured from a baseline", hint="give --baseline too")
    if as_json and form != "html" and output is None:
        raise InputError(
            "two outputs cannot both go to stdout",
            value=f"--json and --format {form}",
            hint="name a file with -o",
        )
    folders = _folders(builds)
    if form == "html" and output is None and record is None and len(folders) > 1:
        output = folders[0].parent / INDEX
        _require_own(output)
    entries = open_entries(folders, output or INDEX)
    pair = _pair(folders, entries, compare)
    reports = {entry.name: entry.report for entry in entries}
    changes = {entry.name: entry.changes for entry in entries}
    if record is not None:
        make_folder(record.parent)
        write_baseline(record, reports, changes)
    known = read_baseline(baseline) if baseline is not None else None
    checks: tuple[Check, ...] = ()
    if limited or form != "html":
        checks = run_gate(reports, changes, Limits(max_luts, min_accuracy, max_regress or 0), known)
    data = gate_json(reports, checks)
    pages: dict[Format, Callable[[], str]] = {
        "html": lambda: index_page(entries, pair, checks),
        "markdown": lambda: gate_markdown(reports, checks, known),
        "json": lambda: json.dumps(data, indent=1, allow_nan=False) + "\n",
        "junit": lambda: gate_junit(checks),
    }
    written = [folder / REPORT_HTML for folder in folders]
    if output is not None:
        make_folder(output.parent)
        write_text(output, pages[form]())
        written.append(output)
    if record is not None:
        written.append(record)
    text = pages[form]().rstrip() if form != "html" and output is None else _summary(written, checks)
    emit(data | {"written": [str(path) for path in written]}, text, as_json=as_json)
    if failed := [check for check in checks if not check.passed]:
        first = f"{failed[0].build}, {failed[0].name}: {failed[0].text}"
        raise CheckError(f"{len(failed)} of {len(checks)} checks failed", value=first)


def _folders(paths: Sequence[Path]) -> list[Path]:
    """The builds among what was given; what is skipped is reported."""
    folders = [path for path in paths if is_build(path)]
    others = " ".join(str(path) for path in paths if path not in folders)
    if not folders:
        raise InputError("none of these is a build", value=others, hint="see `wnn2hdl compile`")
    if others:
        say(f"wnn2hdl: skipped, since it is not a build: {others}", error=True)
    return folders


def _require_own(index: Path) -> None:
    """Keep a page that another command or a person put where an index would go."""
    if index.is_file() and not is_index(index.read_text(encoding="utf-8", errors="replace")):
        raise InputError(
            "a page that `wnn2hdl report` did not write is in the way",
            value=index,
            hint="name another file, or this one, with -o",
        )


def _pair(
    folders: Sequence[Path], entries: Sequence[Entry], compare: tuple[Path, Path] | None
) -> tuple[Entry, Entry] | None:
    """The builds to compare, if any."""
    if compare is None:
        return (entries[0], entries[1]) if len(entries) == 2 else None
    by_place = {folder.resolve(): entry for folder, entry in zip(folders, entries, strict=True)}
    for folder in compare:
        if folder.resolve() not in by_place:
            raise InputError("--compare names a build that is not among the BUILDs", value=folder)
    first, second = (by_place[folder.resolve()] for folder in compare)
    return first, second


def _summary(written: Sequence[Path], checks: Sequence[Check]) -> str:
    lines = [str(path) for path in written]
    lines += [f"✗ {check.build}, {check.name}: {check.text}" for check in checks if not check.passed]
    if checks:
        lines.append(f"{sum(check.passed for check in checks)} of {len(checks)} checks passed")
    return "\n".join(lines)
