"""What every importer takes and gives."""

import hashlib
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.files import read_json
from wnn2hdl.ir.models import ClassifierModel, LogicModel

ImportedModel = ClassifierModel | LogicModel

MAX_FILE_BYTES = 1 << 30
"""The largest file that is read."""


@dataclass(frozen=True)
class ImportOptions:
    """What a file may leave open. Each importer names those that it takes.

    Attributes:
        bleach: a fixed threshold in place of a dynamic one, which makes another classifier.
        config: a second file that belongs to the first.
        classes: how many classes the outputs are grouped into.
    """

    bleach: int | None = None
    config: Path | None = None
    classes: int | None = None

    @property
    def given(self) -> set[str]:
        """Names of the options that are not left open."""
        return {field.name for field in fields(self) if getattr(self, field.name) is not None}


@dataclass(frozen=True)
class Source:
    """A file to import; its content is read once, when it is first asked for."""

    path: Path

    @cached_property
    def content(self) -> bytes:
        """All bytes of the file.

        Raises:
            InputError: it cannot be read or is larger than `MAX_FILE_BYTES`.
        """
        try:
            size = self.path.stat().st_size
            if size > MAX_FILE_BYTES:
                raise InputError("the file is too large", value=f"{self.path} ({size} bytes)")
            return self.path.read_bytes()
        except OSError as error:
            raise InputError("cannot read a model", value=f"{self.path} ({error.strerror})") from error

    @cached_property
    def object(self) -> dict[str, Any] | None:
        """The JSON object that the file holds; None if it does not hold one."""
        if self.content[:4096].lstrip()[:1] != b"{":
            return None
        try:
            data = json.loads(self.content)
        except (ValueError, RecursionError):
            return None
        return data if isinstance(data, dict) else None

    def json(self) -> dict[str, Any]:
        """The JSON object that the file holds, of finite numbers; raises ModelFileError if there is none."""
        return read_json(self.path, "a model")

    def origin(self, tool: str, **notes: Any) -> dict[str, Any]:
        """What a model records about where it comes from."""
        digest = hashlib.sha256(self.content).hexdigest()
        return {"tool": tool, "file": self.path.name, "sha256": digest, **notes}


@dataclass(frozen=True)
class Importer:
    """How one format is read; plug-ins give one by an entry point of the group ``wnn2hdl.importers``.

    Attributes:
        name: what ``--format`` calls it.
        description: of the files, in a few words.
        recognises: whether a file is of this format, by its content; it never raises for a readable file.
        read: the model in a file of this format; raises InputError.
        options: names of the fields of `ImportOptions` that it takes.
    """

    name: str
    description: str
    recognises: Callable[[Source], bool]
    read: Callable[[Source, ImportOptions], ImportedModel]
    options: frozenset[str] = frozenset()


@contextmanager
def damage_reported(source: Source, what: str) -> Iterator[None]:
    """Turn what goes wrong in a damaged file into one line.

    Raises:
        InputError: something inside raised an error that shows contradictory content.
    """
    try:
        yield
    except (ValueError, TypeError, KeyError, IndexError, OverflowError, AttributeError) as error:
        reason = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise InputError(
            f"not {what}, or a damaged one", value=f"{source.path} ({reason[:200]})", hint="export it again"
        ) from error


def whole_numbers(values: object, what: str) -> NDArray[np.int64]:
    """A list of whole numbers, not empty, as int64 ``[numbers]``; raises ValueError for anything else."""
    if not isinstance(values, list) or not values or not all(type(value) is int for value in values):
        raise ValueError(f"{what} is not a list of whole numbers")
    return np.array(values, dtype=np.int64)
