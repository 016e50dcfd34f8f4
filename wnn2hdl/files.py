"""Reading and writing the project's JSON: whole files or nothing."""

import json
import math
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from wnn2hdl.errors import InputError, ModelFileError


def write_text(path: Path, text: str) -> None:
    """Write a file under a temporary name, then rename it, so that nothing half-written is ever seen.

    Raises:
        InputError: the folder does not exist or cannot be written, it has no room, or a folder has the
            file's name; or the text is none: what came from a name that is no UTF-8 cannot be written.
    """
    try:
        content = text.encode()
    except UnicodeEncodeError as error:
        wrong = ascii(error.object[error.start : error.end])
        raise InputError(
            "cannot write this as UTF-8", value=f"{wrong} in {path}", hint="rename what has it in its name"
        ) from error
    write_bytes(path, content)


def write_bytes(path: Path, content: bytes) -> None:
    """As `write_text`, for bytes."""
    try:
        _write(path, content)
    except OSError as error:
        raise InputError(
            "cannot write",
            value=f"{path} ({error.strerror})",
            hint="choose a folder you may write to, with room in it",
        ) from error


def _write(path: Path, content: bytes) -> None:
    # Not by `tempfile`, whose files are for their owner's eyes only, whatever the umask says.
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    try:
        with temporary.open("xb") as stream:
            stream.write(content)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def open_alone(path: Path, what: str, flags: int = 0) -> int:
    """Open a file to read and write that no other process may have open like this; made if it is missing.

    Args:
        path: the file.
        what: whose it is, for the errors: "scan".
        flags: as of `os.open`, besides those for reading and writing.

    Returns:
        the file's number; closing it lets others in.

    Raises:
        InputError: the file cannot be opened, another process has it open, or the system has no such locks.
    """
    try:
        import fcntl  # not there on Windows, where all else here works
    except ImportError as error:
        raise InputError(
            f"this system cannot keep a {what} to one process", hint="run it on Linux or macOS, or in WSL"
        ) from error
    try:
        file = os.open(path, os.O_RDWR | os.O_CREAT | flags, 0o666)
    except OSError as error:
        raise InputError(f"cannot write the {what}", value=f"{path} ({error.strerror})") from error
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(file)
        raise InputError(
            f"another {what} is writing to the same folder", value=path.parent, hint="choose another one"
        ) from error
    return file


def require_file(path: Path, what: str) -> None:
    """Refuse what is no regular file before it is opened: opening a pipe or a device may never return.

    Args:
        path: to be read.
        what: what it should be, for the error: "the picture".

    Raises:
        InputError: there is no such file, its folder cannot be searched, or it is a folder, a pipe, a socket
            or a device.
    """
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:
        reason = (error.strerror or "") if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot read {what}", value=f"{path} ({reason})") from error
    if not stat.S_ISREG(mode):
        kind = next((name for test, name in _KINDS if test(mode)), "a device")
        raise InputError(f"cannot read {what}", value=f"{path} (it is {kind})", hint="give a regular file")


_KINDS = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))


def make_folder(path: Path) -> None:
    """Make a folder and its parents.

    Raises:
        InputError: it cannot be made, or something else has its name.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            "cannot make the folder", value=f"{path} ({error.strerror})", hint="choose another one"
        ) from error
    if not os.access(path, os.W_OK):
        raise InputError("cannot write into the folder", value=path, hint="choose another one")


@contextmanager
def made_folder(path: Path) -> Iterator[None]:
    """As `make_folder`; a folder that is new goes again if the block fails and leaves nothing in it."""
    new = not path.exists()
    make_folder(path)
    try:
        yield
    except BaseException:
        if new:
            with suppress(OSError):
                path.rmdir()
        raise


def read_json(path: Path, what: str) -> dict[str, Any]:
    """Read a JSON object.

    Args:
        path: the file.
        what: what it should hold, for the error: "a model".

    Raises:
        ModelFileError: the file is missing, no text, no JSON, or no object; or it holds what no JSON file
            can be written with: a number that is none or infinite, half a surrogate pair.
    """
    try:
        text = path.read_text(encoding="utf-8")
        data = json.loads(text, parse_constant=_finite, parse_float=_finite)
        if "\\ud" in text.lower():
            json.dumps(data, ensure_ascii=False).encode()
    except OSError as error:
        raise ModelFileError(f"cannot read {what}", value=f"{path} ({error.strerror})") from error
    except (ValueError, RecursionError) as error:
        raise ModelFileError(
            f"not {what}, or a damaged one",
            value=f"{path} ({error})",
            hint="give the JSON file as it was saved",
        ) from error
    if not isinstance(data, dict):
        raise ModelFileError(f"not {what}", value=f"{path} (holds a JSON {type(data).__name__})")
    return data


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Write a JSON object, indented, in the order given; the same data give the same bytes."""
    write_text(path, json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def _finite(text: str) -> float:
    # Python reads NaN and Infinity, which JSON does not know, and takes 1e999 for infinity.
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is no finite number")
    return number
