"""The manifest of an output folder: what was written, with hashes, so that a later change is noticed."""

import hashlib
from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from typing import Any

from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.files import read_json, write_json

MANIFEST_NAME = "manifest.json"
FORMAT = "wnn2hdl-manifest"
VERSION = 1


def manifest(
    contents: Mapping[str, bytes], *, versions: Mapping[str, str], options: Mapping[str, Any]
) -> dict[str, Any]:
    """The manifest of files, as a JSON object.

    Args:
        contents: bytes of each file by its path in the folder, with ``/`` between folders.
        versions: version of each tool that took part.
        options: the options of the run.
    """
    return {
        "format": FORMAT,
        "version": VERSION,
        "options": dict(options),
        "versions": dict(sorted(versions.items())),
        "files": {name: hashlib.sha256(content).hexdigest() for name, content in sorted(contents.items())},
    }


def write_manifest(
    folder: Path, names: Sequence[str], *, versions: Mapping[str, str], options: Mapping[str, Any]
) -> None:
    """Write the manifest of files that lie in ``folder``.

    Raises:
        InputError: a file cannot be read, or the folder cannot be written.
    """
    contents = {name: _read(folder / name) for name in names}
    write_json(folder / MANIFEST_NAME, manifest(contents, versions=versions, options=options))


def renew_manifest(folder: Path, names: Sequence[str]) -> None:
    """Note in a folder's manifest that files which it names were written again.

    Raises:
        ModelFileError: the manifest is missing or damaged.
        InputError: a file cannot be read, or the folder cannot be written.
    """
    data = _load(folder)
    data["files"] |= {name: hashlib.sha256(_read(folder / name)).hexdigest() for name in names}
    write_json(folder / MANIFEST_NAME, data)


def check(folder: Path, *, besides: Container[str] = ()) -> list[str]:
    """Differences between a folder and its manifest, one line each; none if all is as it was written.

    Files that the manifest does not name are no difference.

    Args:
        folder: the folder.
        besides: files that may differ.

    Raises:
        ModelFileError: the manifest is missing or damaged.
        InputError: a file cannot be read.
    """
    differences = []
    for name, digest in _load(folder)["files"].items():
        if name in besides:
            continue
        if not (folder / name).is_file():
            differences.append(f"{name} is missing")
        elif hashlib.sha256(_read(folder / name)).hexdigest() != digest:
            differences.append(f"{name} was changed")
    return differences


def _load(folder: Path) -> dict[str, Any]:
    data = read_json(folder / MANIFEST_NAME, "a manifest")
    files = data.get("files")
    if data.get("format") != FORMAT or not isinstance(files, dict) or not files:
        raise ModelFileError("not a manifest", value=folder / MANIFEST_NAME, hint="compile the model again")
    return data


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError("cannot read", value=f"{path} ({error.strerror})") from error
