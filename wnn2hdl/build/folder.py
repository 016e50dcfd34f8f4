"""Build folders: written beside their place, then renamed into it, so that a reader sees all or nothing."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.errors import InputError
from wnn2hdl.files import beside, held, make_folder

REPORT_FILE = "report.json"
REPORT_PAGE = "report.md"
REPORT_HTML = "report.html"

SAMPLE_FILE = "sample.png"
"""The picture that `REPORT_HTML` shows through the circuit."""

FAILED = "FAILED"
"""The file that marks a build whose circuit is not the model; it says why."""


@contextmanager
def staged(target: Path) -> Iterator[Path]:
    """A new folder that takes the place of ``target`` when the block ends without an error.

    Args:
        target: the folder to make; an earlier build there is replaced.

    Yields:
        the folder to write into, beside ``target``; it is removed if the block fails or is interrupted. The
            next build at the same place removes what a killed one left.

    Raises:
        InputError: ``target`` is something other than a build or an empty folder, cannot be written, or
            another process makes it.
    """
    # The folder that a link leads to is replaced, and the link stays.
    target = resolved(target)
    require_replaceable(target)
    make_folder(target.parent)
    with held(target, "build"):
        staging, earlier = beside(target, ".new"), beside(target, ".earlier")
        _tidy(target, staging, earlier)
        make_folder(staging)
        try:
            yield staging
            require_replaceable(target)
            if target.exists():
                target.rename(earlier)
            staging.rename(target)
        finally:
            _tidy(target, staging, earlier)


def _tidy(target: Path, staging: Path, earlier: Path) -> None:
    """Remove what is not needed any more, also what a killed process left; an earlier build is put back."""
    if earlier.exists() and not target.exists():
        earlier.rename(target)
    for folder in (staging, earlier):
        shutil.rmtree(folder, ignore_errors=True)


def resolved(target: Path) -> Path:
    """The folder that a path leads to, there or not; raises InputError if a link leads to itself."""
    try:
        return target.resolve()
    except (OSError, RuntimeError) as error:
        raise InputError(
            "the output is a link that leads nowhere", value=target, hint="choose another folder"
        ) from error


def require_replaceable(target: Path) -> None:
    """Raise InputError if something other than a build or an empty folder is where a build is to go."""
    if target.exists() and not (target.is_dir() and (is_build(target) or not any(target.iterdir()))):
        raise InputError(
            "the output exists and is not an earlier build", value=target, hint="choose another folder"
        )


def is_build(folder: Path) -> bool:
    """Whether a folder was written by `compile`: its manifest distinguishes it."""
    return (folder / MANIFEST_NAME).is_file()


def failure(folder: Path) -> str | None:
    """Why a build is marked as failed, on one line; None if it is not."""
    path = folder / FAILED
    if not path.exists():
        return None
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        text = f"{FAILED} cannot be read ({error.strerror})"
    return " ".join(text.split()) or f"{FAILED} gives no reason"


def require_build(folder: Path) -> None:
    """Raise InputError unless a folder is a build."""
    if not is_build(folder):
        raise InputError("not a build folder", value=folder, hint="give one that `wnn2hdl compile` wrote")
