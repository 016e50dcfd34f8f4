"""The windows of a scan that are classified, so that an interrupted one continues where it stopped."""

import struct
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from wnn2hdl.apps.deforestation.classify import WindowResult
from wnn2hdl.journal import Journal

_HEAD = struct.Struct("<IQQ")
"""Before a window's classes: its number, valid pixels, covered ones."""


class FinishedWindows:
    """The results of a scan's windows in a journal; they may come in any order.

    Only their places are held in memory.

    Args:
        path: the journal's file.
        identity: what decides the results, a JSON object: files, model, options.

    Attributes:
        valid: pixels that were classified in all windows so far.
        covered: those among them whose colours the classifier knows.

    Raises:
        InputError: the file cannot be read.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self._journal = Journal(path, identity)
        self._places: dict[int, int] = {}
        self.valid = 0
        self.covered = 0
        for place, content in self._journal:
            self._add(place, *_HEAD.unpack_from(content))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._journal.__exit__(kind, error, trace)

    def __len__(self) -> int:
        """How many windows are finished."""
        return len(self._places)

    def __contains__(self, index: int) -> bool:
        """Whether a window is finished."""
        return index in self._places

    def append(self, result: WindowResult) -> None:
        """Add a window that is not there.

        Raises:
            InputError: the disk is full.
        """
        head = _HEAD.pack(result.index, result.valid, result.covered)
        self._add(self._journal.append(head + result.packed), result.index, result.valid, result.covered)

    def packed(self, index: int) -> bytes:
        """The compressed classes of a window that is there."""
        return self._journal.read(self._places[index])[_HEAD.size :]

    def _add(self, place: int, index: int, valid: int, covered: int) -> None:
        self._places[index] = place
        self.valid += valid
        self.covered += covered
