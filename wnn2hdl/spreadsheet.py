"""Tables as CSV that a spreadsheet shows as they are."""

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

_FORMULA = ("=", "+", "-", "@")


def csv_lines(headers: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    """The lines of a table, each with its end; equal tables give equal lines.

    A spreadsheet runs a text that begins like a formula, and such a text may come from a file's name: an
    apostrophe is put before it, which spreadsheets take for "this is text". Line breaks within a text become
    spaces, so that a row is a line. Numbers stay as they are.

    Args:
        headers: of the columns.
        rows: cells; None leaves one empty.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    for cells in chain([headers], rows):
        writer.writerow([_inert(cell) for cell in cells])
        yield stream.getvalue()
        stream.seek(0)
        stream.truncate()


def _inert(cell: object) -> object:
    if not isinstance(cell, str):
        return cell
    text = " ".join(cell.splitlines())
    return f"'{text}" if text.lstrip().startswith(_FORMULA) else text
