"""Results on disk, found by what they were made from; a lost, damaged or misplaced one is only made again."""

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import platformdirs

from wnn2hdl.errors import InputError
from wnn2hdl.files import make_folder, write_text

FOLDER = "WNN2HDL_CACHE"
"""The environment variable that names the cache's folder; by default it is where this system keeps caches."""


def digest(text: str) -> str:
    """The SHA-256 of a text in hexadecimal digits, short enough to stand in a key for the text itself."""
    return hashlib.sha256(text.encode()).hexdigest()


def location(kind: str, key: Mapping[str, str]) -> Path:
    """The file for a result.

    Args:
        kind: the name of a folder in the cache.
        key: everything that the result depends on, by name.
    """
    folder = Path(os.environ.get(FOLDER) or platformdirs.user_cache_dir("wnn2hdl", appauthor=False))
    return folder / kind / f"{digest(json.dumps(dict(key), sort_keys=True))}.json"


def load(kind: str, key: Mapping[str, str]) -> dict[str, Any] | None:
    """What `store` kept under this key.

    Returns:
        The result; None where there is nothing, or a file that is damaged or was made from something else.
    """
    path = location(kind, key)
    if not path.is_file():  # reading a pipe in its place could wait forever
        return None
    try:
        checksum, _, text = path.read_text(encoding="utf-8").partition("\n")
        if checksum != digest(text):
            return None
        entry = json.loads(text)
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(entry, dict) or entry.get("key") != dict(key):
        return None
    result = entry.get("result")
    return result if isinstance(result, dict) else None


def store(kind: str, key: Mapping[str, str], result: Mapping[str, Any]) -> None:
    """Keep a JSON object, with its key beside it and the SHA-256 of both in the first line.

    The file appears whole or not at all, so several processes can keep the same result at once. A cache that
    cannot be written, or whose disk is full, keeps nothing.
    """
    path = location(kind, key)
    text = json.dumps({"key": dict(key), "result": dict(result)})
    with contextlib.suppress(InputError):
        make_folder(path.parent)
        write_text(path, f"{digest(text)}\n{text}")
