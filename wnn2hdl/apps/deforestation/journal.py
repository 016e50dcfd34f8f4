"""Finished windows in a file that only grows, so that an interrupted scan goes on where it stopped."""

import json
import os
import struct
import zlib
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from wnn2hdl.apps.deforestation.classify import WindowResult
from wnn2hdl.errors import InputError
from wnn2hdl.files import open_alone

_HEAD = struct.Struct("<IIQQI")
"""Of each window: its number, bytes of its classes, valid pixels, covered ones, CRC-32 of those classes."""


class Journal:
    """The results of a scan's windows.

    Results may come in any order; held in memory is where they are. What a killed process left half-written
    is cut off when the file is opened, and those windows are missing again. A file that belongs to another
    scan is emptied. One process may have it open at a time. One that ends without a window is removed.

    Args:
        path: the file; made if it does not exist.
        identity: what decides the results, a JSON object: files, model, options.

    Raises:
        InputError: the file cannot be opened, or another process has it open.
    """

    def __init__(self, path: Path, identity: dict[str, Any]) -> None:
        self._path = path
        self._places: dict[int, tuple[int, int]] = {}
        self.valid = 0
        """Pixels that were classified in all windows so far."""
        self.covered = 0
        """Those among them whose colours the classifier knows."""
        self._file = open_alone(path, "scan")
        first = json.dumps(identity, sort_keys=True).encode() + b"\n"
        if os.pread(self._file, len(first), 0) != first:
            os.ftruncate(self._file, 0)
            os.pwrite(self._file, first, 0)
        self._end = self._scan(len(first))
        os.ftruncate(self._file, self._end)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self:
            self._path.unlink()
        os.close(self._file)

    def __len__(self) -> int:
        """How many windows are there."""
        return len(self._places)

    def __contains__(self, index: int) -> bool:
        """Whether a window is there."""
        return index in self._places

    def append(self, result: WindowResult) -> None:
        """Add a window that is not there.

        Raises:
            InputError: the disk is full.
        """
        check = zlib.crc32(result.packed)
        head = _HEAD.pack(result.index, len(result.packed), result.valid, result.covered, check)
        block, place = head + result.packed, self._end
        try:
            while block:
                written = os.pwrite(self._file, block, place)
                block, place = block[written:], place + written
        except OSError as error:
            raise InputError("cannot write the scan", value=f"{self._path} ({error.strerror})") from error
        self._add(result.index, len(result.packed), result.valid, result.covered)

    def packed(self, index: int) -> bytes:
        """The compressed classes of a window that is there."""
        place, length = self._places[index]
        return os.pread(self._file, length, place)

    def _add(self, index: int, length: int, valid: int, covered: int) -> None:
        self._places[index] = (self._end + _HEAD.size, length)
        self._end += _HEAD.size + length
        self.valid += valid
        self.covered += covered

    def _scan(self, start: int) -> int:
        """Find the windows; returns where the sound part of the file ends."""
        self._end = start
        while len(head := os.pread(self._file, _HEAD.size, self._end)) == _HEAD.size:
            index, length, valid, covered, check = _HEAD.unpack(head)
            packed = os.pread(self._file, length, self._end + _HEAD.size)
            if len(packed) != length or zlib.crc32(packed) != check:
                break
            self._add(index, length, valid, covered)
        return self._end
