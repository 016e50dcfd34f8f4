"""A training on disk, so that a killed one goes on where it was saved last."""

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.files import write_bytes

_IDENTITY = "identity"


class Checkpoint:
    """A file that holds the newest state of a training.

    A journal that keeps every state would grow by tens of megabytes each time.

    Args:
        path: the file.
        identity: a JSON object of everything that decides the training.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self._path = path
        self._identity = json.dumps(identity, sort_keys=True)

    def read(self) -> dict[str, NDArray[Any]] | None:
        """The state; None if there is none, it is damaged, or it is that of another training."""
        try:
            with self._path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
                arrays = {name: archive[name] for name in archive.files}
        except (OSError, ValueError, EOFError, zipfile.BadZipFile):
            return None
        return arrays if str(arrays.pop(_IDENTITY, "")) == self._identity else None

    def write(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Replace the state; raises InputError if the file cannot be written."""
        stream = io.BytesIO()
        every: dict[str, Any] = {_IDENTITY: np.array(self._identity), **arrays}
        np.savez(stream, **every)
        write_bytes(self._path, stream.getvalue())

    def remove(self) -> None:
        """The training is finished: the file goes, if there is one."""
        self._path.unlink(missing_ok=True)
