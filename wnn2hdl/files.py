"""Reading and writing the project's JSON: files are written whole or not at all."""

import errno
import hashlib
import json
import math
import os
import secrets
import stat
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from filelock import FileLock, Timeout

from wnn2hdl.errors import InputError, ModelFileError

LOCK_FILE = ".lock"
"""In a folder that a process writes into; see `output_folder`."""

PARTIAL = ".part"
"""The end of the hidden names that files have until they are whole."""

_NAME = 50
"""Letters of a file's name that its hidden name has."""

_LONGEST_NAME = 200
"""Bytes of a name to which something can be added; a file system's names end at 255."""

_LONGEST_REASON = 200
"""Characters of the reason why a file is not taken."""


def write_text(path: Path, text: str) -> None:
    """Write a file under a temporary name, then rename it, so that nothing half-written is ever seen.

    Raises:
        InputError: the folder does not exist or cannot be written, it has no room, or a folder has the
            file's name; or the text cannot be encoded: what came from a name that is not UTF-8 cannot be
            written.
    """
    write_bytes(path, _encoded(text, path))


def write_bytes(path: Path, content: bytes) -> None:
    """As `write_text`, for bytes."""
    try:
        with _replacing(path) as stream:
            stream.write(content)
    except OSError as error:
        raise _unwritable(path, error) from error


def write_lines(path: Path, lines: Iterable[str]) -> None:
    """As `write_text`, for lines with their ends that are better not held all at once."""
    try:
        with _replacing(path) as stream:
            stream.writelines(_encoded(line, path) for line in lines)
    except OSError as error:
        raise _unwritable(path, error) from error


def _encoded(text: str, path: Path) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        wrong = ascii(error.object[error.start : error.end])
        raise InputError(
            "cannot write this as UTF-8",
            value=f"{wrong} in {path}",
            hint="rename the file or folder with this name",
        ) from error


@contextmanager
def _replacing(path: Path) -> Iterator[BinaryIO]:
    """A new file that takes the place of another when all went well.

    What a link leads to is replaced, and the link stays. A device or a pipe cannot be replaced: as root it
    could, and would be gone for everybody.
    """
    path = Path(os.path.realpath(path))
    with suppress(FileNotFoundError):
        if not stat.S_ISREG(path.stat().st_mode) and not path.is_dir():
            raise OSError(errno.EINVAL, "it is a device or a pipe")
    # Not by `tempfile`, whose files are for their owner's eyes only, whatever the umask says. A file system's
    # names end at 255 bytes, and a name that fits is to fit with what is added, too.
    temporary = path.with_name(f".{path.name[:_NAME]}.{secrets.token_hex(4)}{PARTIAL}")
    try:
        with temporary.open("xb") as stream:
            yield stream
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _unwritable(path: Path, error: OSError) -> InputError:
    return InputError(
        "cannot write",
        value=f"{path} ({error.strerror})",
        hint="choose a folder you may write to, with room in it",
    )


def require_file(path: Path, what: str) -> None:
    """Refuse what is not a regular file before it is opened: opening a pipe or a device may never return.

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
def output_folder(path: Path, what: str) -> Iterator[None]:
    """A folder that no other process writes into meanwhile; it is made if it is missing.

    The system releases the lock of a process that ends, however it ends, so that no lock outlives its
    process; what a killed one left under a hidden name, here or one folder below, is removed. A folder that
    is new goes again if the block fails and leaves nothing in it.

    Args:
        path: the folder.
        what: what writes into it, for the error: "scan".

    Raises:
        InputError: the folder cannot be made or written, or another process has it.
    """
    new = not path.exists()
    make_folder(path)
    try:
        with _locked(path / LOCK_FILE, path, f"into the folder of this {what}"):
            for left in (*path.glob(f".*{PARTIAL}"), *path.glob(f"*/.*{PARTIAL}")):
                if left.parent == path or not (left.parent / LOCK_FILE).exists():
                    left.unlink(missing_ok=True)
            yield
    except BaseException:
        if new:
            with suppress(OSError):
                path.rmdir()
        raise


@contextmanager
def held(path: Path, what: str) -> Iterator[None]:
    """As `output_folder`, for one file or folder that is made among others; its own folder has to exist.

    Args:
        path: what is made; it need not exist.
        what: what it is, for the error: "build".

    Raises:
        InputError: another process makes it, or its folder cannot be written.
    """
    with _locked(beside(path, LOCK_FILE), path, f"this {what}"):
        yield


@contextmanager
def _locked(place: Path, path: Path, what: str) -> Iterator[None]:
    """A lock, held at ``place``, for whoever writes ``path``; ``what`` it is for the error."""
    try:
        # A place that cannot be written would look like one that another process holds.
        place.touch()
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        with FileLock(place, timeout=0):
            try:
                yield
            finally:
                # Before the lock is given back, or another process might hold the file that goes.
                with suppress(OSError):
                    place.unlink()
    except Timeout as error:
        raise InputError(
            f"another process is writing {what}",
            value=path,
            hint="wait until it ends, or choose another place",
        ) from error


def beside(path: Path, suffix: str) -> Path:
    """A hidden name in the same folder, always the same for a path."""
    name = path.name
    if len(os.fsencode(name)) > _LONGEST_NAME:
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return path.with_name(f".{name}{suffix}")


def read_text(path: Path, what: str) -> str:
    """Read a file as UTF-8.

    Args:
        path: the file.
        what: what it should hold, for the error: "a model".

    Raises:
        InputError: the file is missing, or no text.
    """
    require_file(path, what)
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot read {what}", value=f"{path} ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(
            f"not {what}, or a damaged one",
            value=f"{path} ({error})",
            hint="give the file as it was saved",
        ) from error


def read_json_value(path: Path, what: str) -> Any:
    """Read what a JSON file holds.

    Args:
        path: the file.
        what: what it should hold, for the error: "a model".

    Raises:
        ModelFileError: the file is missing, no text or no JSON; or it holds what no JSON file can be written
            with: a number that is none or infinite, half a surrogate pair, a key twice.
    """
    try:
        text = read_text(path, what)
        data = json.loads(text, parse_constant=_finite, parse_float=_finite, object_pairs_hook=_unique)
        if "\\ud" in text.lower():
            json.dumps(data, ensure_ascii=False).encode()
    except InputError as error:
        raise ModelFileError(error.fault, value=error.value, hint=error.hint) from error
    except (ValueError, RecursionError) as error:
        raise ModelFileError(
            f"not {what}, or a damaged one",
            value=f"{path} ({str(error)[:_LONGEST_REASON]})",
            hint="give the JSON file as it was saved",
        ) from error
    return data


def read_json(path: Path, what: str) -> dict[str, Any]:
    """As `read_json_value`, and what the file holds is an object."""
    data = read_json_value(path, what)
    if not isinstance(data, dict):
        raise ModelFileError(f"not {what}", value=f"{path} (holds a JSON {type(data).__name__})")
    return data


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Write a JSON object, indented, in the order given; the same data give the same bytes."""
    write_text(path, json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    # Python keeps the last of several values; whoever wrote the others meant something by them.
    data = dict(pairs)
    if len(data) < len(pairs):
        twice = next(key for key, count in Counter(key for key, _ in pairs).items() if count > 1)
        raise ValueError(f"the key {twice[:50]!r} stands in one object twice")
    return data


def _finite(text: str) -> float:
    # Python reads NaN and Infinity, which JSON does not know, and takes 1e999 for infinity.
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is not a finite number")
    return number
