"""Results on disk, found by what they were made from; a lost or damaged one is only made again."""

import contextlib
import hashlib
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import platformdirs

from wnn2hdl.errors import InputError
from wnn2hdl.files import make_folder, write_text

FOLDER = "WNN2HDL_CACHE"
"""The environment variable that names the cache's folder; by default it is where this system keeps caches."""


def entry(kind: str, ingredients: Sequence[str]) -> Path:
    """The file for a result.

    Args:
        kind: the name of a folder in the cache.
        ingredients: everything that the result depends on.
    """
    folder = Path(os.environ.get(FOLDER) or platformdirs.user_cache_dir("wnn2hdl", appauthor=False))
    return folder / kind / f"{_digest(json.dumps(list(ingredients)))}.json"


def load(path: Path) -> dict[str, Any] | None:
    """What `store` put there; None when there is nothing, or not what was stored."""
    try:
        digest, _, text = path.read_text(encoding="utf-8").partition("\n")
    except (OSError, UnicodeDecodeError):
        return None
    if digest != _digest(text):
        return None
    data: dict[str, Any] = json.loads(text)
    return data


def store(path: Path, data: dict[str, Any]) -> None:
    """Keep a JSON object, its SHA-256 in the first line; a cache that cannot be written keeps nothing."""
    text = json.dumps(data)
    with contextlib.suppress(InputError):
        make_folder(path.parent)
        write_text(path, f"{_digest(text)}\n{text}")


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
