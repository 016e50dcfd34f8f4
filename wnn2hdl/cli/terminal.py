"""Text for terminals of any encoding: what cannot be printed is written in ASCII instead."""

import codecs
import io
import os
import sys

_HANDLER = "wnn2hdl.ascii"

_ASCII = {
    "✓": "[ok]",
    "✗": "[x]",
    "…": "...",
    "×": "x",  # noqa: RUF001  # the sign is meant
    "·": "*",
    "µ": "u",
    "±": "+/-",
    "≥": ">=",
    "≤": "<=",
    "²": "^2",
    "°": " deg",
}
"""Signs in our own output; any other character becomes Python's escape sequence for it."""


def accept_any_text() -> None:
    """Make standard output and standard error print every text, whatever their encoding is."""
    codecs.register_error(_HANDLER, _substitute)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)


def say(text: str, *, error: bool = False) -> None:
    """Print a text and a line end on standard output, or on standard error.

    Where the reader has gone away, as `| head` does, nothing is printed from then on: what a command still
    has to do, and its exit status, do not depend on it.
    """
    # Not by click, which would reopen an ASCII stream as UTF-8.
    stream = sys.stderr if error else sys.stdout
    try:
        stream.write(f"{text}\n")
        stream.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _substitute(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    wrong = error.object[error.start : error.end]
    return "".join(_ASCII.get(sign) or ascii(sign)[1:-1] for sign in wrong), error.end
