"""The folder that a scan writes into: its files, what is unfinished, and what must not be in its way."""

import shutil
from collections.abc import Container, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from wnn2hdl.errors import InputError
from wnn2hdl.files import make_folder

SUMMARY_FILE = "summary.json"
SUMMARY_PAGE = "summary.md"
SUMMARY_HTML = "summary.html"
CLASSES_FILE = "classes.tif"
OVERLAY_FILE = "overlay.png"
CHANGE_FILE = "change.tif"

BEFORE = "before"
"""The folder, inside the output's, of the scan of the earlier date."""

WORK = ".scan"
"""The folder, inside the output's, of what is not finished."""

WINDOWS = "windows"
"""The journal of finished windows, inside `WORK`."""

_RESULTS = (
    SUMMARY_FILE,
    SUMMARY_PAGE,
    SUMMARY_HTML,
    CLASSES_FILE,
    OVERLAY_FILE,
    CHANGE_FILE,
    *(f"{name}.{kind}" for name in ("polygons", "change") for kind in ("geojson", "gpkg")),
)


def require_apart(inputs: Iterable[Path], output: Path) -> None:
    """Refuse to write over what is read.

    Raises:
        InputError: an input has the name of a result.
    """
    results = {(folder / name).resolve() for folder in (output, output / BEFORE) for name in _RESULTS}
    for path in inputs:
        if path.resolve() in results:
            raise InputError("the scan would write over what it reads", value=path, hint="choose another -o")


@contextmanager
def unfinished(output: Path) -> Iterator[Path]:
    """A new folder for results that are not finished; it and all that is in it is removed in the end.

    `WORK` around it stays if anything else is in it.
    """
    folder = output / WORK / "results"
    shutil.rmtree(folder, ignore_errors=True)
    make_folder(folder)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        with suppress(OSError):
            folder.parent.rmdir()


def deliver(results: Path, output: Path) -> None:
    """Move finished files to their place; an earlier scan's files of other kinds would contradict them."""
    discard(output, but={file.name for file in results.iterdir()})
    for file in sorted(results.iterdir()):
        file.replace(output / file.name)


def discard(output: Path, but: Container[str] = ()) -> None:
    """Remove the results of an earlier scan, all or all but some."""
    for name in _RESULTS:
        if name not in but:
            (output / name).unlink(missing_ok=True)
