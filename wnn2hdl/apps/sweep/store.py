"""Results on disk: one JSON line a trial, appended as they come, so that a killed sweep loses nothing."""

import csv
import json
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from wnn2hdl.apps.sweep.trial import COLUMNS, Record
from wnn2hdl.files import open_alone


class Results:
    """The results of planned trials in a file that only grows.

    Lines may stand in any order, since trials end in any order; reading gives them in the plan's. Held in
    memory are eight bytes a planned trial, not the results. What a killed process left half-written is cut
    off when the file is opened, and that trial is missing again. One process may have it open at a time.

    Args:
        path: the file; made if it does not exist.
        size: how many trials are planned.
        position: the place of a trial's name among them, from 0 to ``size - 1``; None if it is not planned.

    Raises:
        InputError: the file cannot be opened, or another process has it open.
    """

    def __init__(self, path: Path, size: int, position: Callable[[str], int | None]) -> None:
        self._path = path
        self._position = position
        self._offsets = np.full(size, -1, dtype=np.int64)
        self._file = open_alone(path, "sweep", os.O_APPEND)
        self._reader = path.open("rb")
        self._end = self._scan()
        os.ftruncate(self._file, self._end)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._reader.close()
        os.close(self._file)

    def __len__(self) -> int:
        """How many planned trials have a result."""
        return int((self._offsets >= 0).sum())

    @property
    def size(self) -> int:
        """How many trials are planned."""
        return len(self._offsets)

    def has(self, name: str) -> bool:
        """Whether a planned trial has a result."""
        position = self._position(name)
        return position is not None and bool(self._offsets[position] >= 0)

    def get(self, name: str) -> Record:
        """The result of a trial that has one."""
        position = self._position(name)
        assert position is not None
        return self._read(int(self._offsets[position]))

    def missing(self) -> Iterator[int]:
        """Positions of the planned trials without a result, ascending."""
        return (int(position) for position in np.flatnonzero(self._offsets < 0))

    def append(self, records: Iterable[Record]) -> None:
        """Add results; a trial that has one keeps its first."""
        lines = []
        for record in records:
            position = self._position(record.name)
            if position is None or self._offsets[position] >= 0:
                continue
            line = json.dumps(record.to_json()).encode() + b"\n"
            self._offsets[position] = self._end
            self._end += len(line)
            lines.append(line)
        block = b"".join(lines)
        while block:
            block = block[os.write(self._file, block) :]

    def __iter__(self) -> Iterator[Record]:
        """All results, in the order of the plan."""
        return (self._read(int(offset)) for offset in self._offsets[self._offsets >= 0])

    def _read(self, offset: int) -> Record:
        self._reader.seek(offset)
        return Record.from_json(json.loads(self._reader.readline()))

    def _scan(self) -> int:
        """Find the results; returns where the sound part of the file ends."""
        end = 0
        for line in self._reader:
            try:
                name = Record.from_json(json.loads(line)).name
            except (ValueError, KeyError, TypeError, AttributeError):
                break
            if not line.endswith(b"\n"):
                break
            position = self._position(name)
            if position is not None and self._offsets[position] < 0:
                self._offsets[position] = end
            end += len(line)
        return end


def write_table(records: Iterable[Record], path: Path) -> None:
    """Write results as CSV in the order given; equal results give equal bytes."""
    part = path.with_name(f".{path.name}.part")
    # Streamed, since a table of a million rows is better not held; renamed, so that no half of it is seen.
    with part.open("w", encoding="utf-8", newline="") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(COLUMNS)
        for record in records:
            rows.writerow(record.to_json().values())
    part.replace(path)
