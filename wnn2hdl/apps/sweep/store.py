"""Results on disk: one record per trial, appended as they come, so that a killed sweep loses nothing."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from wnn2hdl.apps.sweep.trial import COLUMNS, Record
from wnn2hdl.files import write_lines
from wnn2hdl.journal import Journal
from wnn2hdl.spreadsheet import csv_lines


class Results:
    """The results of planned trials in a journal.

    They may come in any order, since trials end in any order; reading gives them in the plan's. Eight
    bytes per planned trial are held in memory, not the results.

    Args:
        path: the journal's file.
        identity: the settings of the sweep; results of another are not seen.
        size: how many trials are planned.
        position: the place of a trial's name among them, from 0 to ``size - 1``; None if it is not planned.

    Raises:
        InputError: the file cannot be read.
    """

    def __init__(
        self, path: Path, identity: Mapping[str, Any], size: int, position: Callable[[str], int | None]
    ) -> None:
        self._position = position
        self._places = np.full(size, -1, dtype=np.int64)
        self._journal = Journal(path, identity)
        for place, content in self._journal:
            if (planned := self._open(_record(content).name)) is not None:
                self._places[planned] = place

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._journal.__exit__(kind, error, trace)

    def __len__(self) -> int:
        """How many planned trials have a result."""
        return int((self._places >= 0).sum())

    @property
    def size(self) -> int:
        """How many trials are planned."""
        return len(self._places)

    def has(self, name: str) -> bool:
        """Whether a planned trial has a result."""
        position = self._position(name)
        return position is not None and bool(self._places[position] >= 0)

    def get(self, name: str) -> Record:
        """The result of a trial that has one."""
        position = self._position(name)
        assert position is not None
        return self._read(int(self._places[position]))

    def missing(self) -> Iterator[int]:
        """Positions of the planned trials without a result, ascending."""
        return (int(position) for position in np.flatnonzero(self._places < 0))

    def append(self, records: Iterable[Record]) -> None:
        """Add results; a trial that has one keeps its first.

        Raises:
            InputError: the disk is full.
        """
        for record in records:
            position = self._open(record.name)
            if position is not None:
                self._places[position] = self._journal.append(json.dumps(record.to_json()).encode())

    def __iter__(self) -> Iterator[Record]:
        """All results, in the order of the plan."""
        return (self._read(int(place)) for place in self._places[self._places >= 0])

    def _read(self, place: int) -> Record:
        return _record(self._journal.read(place))

    def _open(self, name: str) -> int | None:
        """The position of a planned trial without a result."""
        position = self._position(name)
        return position if position is not None and self._places[position] < 0 else None


def write_table(records: Iterable[Record], path: Path) -> None:
    """Write results as CSV in the order given; equal results give equal bytes.

    Raises:
        InputError: the file cannot be written.
    """
    write_lines(path, csv_lines(COLUMNS, ([*record.to_json().values()] for record in records)))


def _record(content: bytes) -> Record:
    return Record.from_json(json.loads(content))
