"""Progress where somebody watches: one line that is written over, in a terminal or a notebook."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from wnn2hdl.progress import Progress

_WIDTH = 60


def silent(step: str, done: int, total: int) -> None:
    """Report nothing."""


@contextmanager
def watched(progress: Progress | None) -> Iterator[Progress]:
    """What a function reports to.

    Args:
        progress: given by the caller. None writes a line in a terminal or a notebook, and nothing where
            output goes to a file.
    """
    notebook = "ipykernel" in sys.modules
    if progress is not None or not (notebook or sys.stderr.isatty()):
        yield progress or silent
        return
    # A notebook shows stderr as if something had failed.
    stream = sys.stdout if notebook else sys.stderr

    def line(step: str, done: int, total: int) -> None:
        stream.write(f"\r{f'{step}: {done} of {total}'[:_WIDTH]:<{_WIDTH}}")
        stream.flush()

    try:
        yield line
    finally:
        stream.write(f"\r{'':<{_WIDTH}}\r")
        stream.flush()
